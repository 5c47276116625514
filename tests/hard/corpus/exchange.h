/// The corpus as files for other renderers, and their answers. docs/hard-corpus.md describes the format.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hard/corpus/hard_case.h"

namespace tandem::hard {

/// Writes the ray cases among `cases` whose scenes glTF can hold to `folder`, creating it if necessary: scenes, rays,
/// correct answers, and manifest.json last. Returns their number. Throws InputError if it cannot write.
std::size_t export_cases(const std::vector<const HardCase*>& cases, std::size_t rays, const std::string& folder);

/// Ids in answer files that name no primitive: a miss, and a ray that the renderer refused.
inline constexpr std::int32_t miss_id = -1;
inline constexpr std::int32_t refused_id = -2;

/// The rays of one batch of an exported folder. Throws InputError.
[[nodiscard]] std::vector<Ray<float>> read_rays(const std::string& folder, const std::string& batch, std::size_t rays);

/// Another renderer's answers to one case.
struct CheckedCase {
    std::string id;
    std::string title;
    std::string missing;  ///< the first missing file, if the case was not answered; else empty
    Score score;
};

/// Scores the answers in `answers`, a folder within an exported one. Throws InputError, "FILE: what", for a malformed
/// file, and if no case is answered.
[[nodiscard]] std::vector<CheckedCase> check_answers(const std::string& answers);

}  // namespace tandem::hard
