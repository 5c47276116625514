/// The corpus as files for other renderers, and their answers. docs/hard-corpus.md describes the format.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hard/corpus/hard_case.h"

namespace tandem::hard {

/// Writes the ray cases among `cases` whose scenes glTF can hold to `folder`, which is made if it is not there: scenes,
/// rays, right answers, and manifest.json last. Returns how many. Throws InputError where it cannot write.
std::size_t export_cases(const std::vector<const HardCase*>& cases, std::size_t rays, const std::string& folder);

/// Ids in files of answers that are no primitives: a miss, and a ray that was not answered.
inline constexpr std::int32_t miss_id = -1;
inline constexpr std::int32_t refused_id = -2;

/// The rays of one lot of an exported folder. Throws InputError.
[[nodiscard]] std::vector<Ray<float>> read_rays(const std::string& folder, const std::string& lot, std::size_t rays);

/// What another renderer answered to one case.
struct CheckedCase {
    std::string id;
    std::string title;
    std::string missing;  ///< the first file that is not there: the case was not answered. Empty if it was
    Score score;
};

/// Scores the answers in `answers`, a folder within an exported one. Throws InputError, "FILE: what", for a file that
/// is not as it should be, and if no case at all is answered.
[[nodiscard]] std::vector<CheckedCase> check_answers(const std::string& answers);

}  // namespace tandem::hard
