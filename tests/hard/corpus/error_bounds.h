/// The error bounds of each tier in the corpus of hard cases. docs/hard-corpus.md lists the cases, docs/accuracy.md the
/// bounds.
#pragma once

#include <span>
#include <string_view>

#include "tandem/render/tier.h"

namespace tandem {

/// The largest errors that a tier may have in a case. NaN are never allowed. A case without a bound for a tier is not
/// run in it: the tier does not promise what the case tests, or the case does not depend on the tier.
struct ErrorBound {
    std::string_view case_id;
    Tier tier;
    double wrong;  ///< share of wrong decisions
    double ulps;   ///< worst error of t, or of the function, in float ulps
    double leaks;  ///< share of rays that leak through a closed surface
};

/// All error bounds, in the order of the table.
[[nodiscard]] std::span<const ErrorBound> error_bounds();

/// The bound of a case in a tier, or null.
[[nodiscard]] const ErrorBound* find_error_bound(std::string_view case_id, Tier tier);

}  // namespace tandem
