/// The corpus as files for other renderers, and their answers. docs/hard-corpus.md describes the format.
#pragma once

#include <string>
#include <vector>

#include "hard/corpus/hard_case.h"

namespace tandem::hard {

/// Writes the ray cases among `cases` to `folder`, which is made if it is not there: scenes, rays, right answers, and
/// manifest.json last. Throws InputError where it cannot write.
void export_cases(const std::vector<const HardCase*>& cases, std::size_t rays, const std::string& folder);

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
