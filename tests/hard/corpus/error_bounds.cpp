#include "hard/corpus/error_bounds.h"

#include <cmath>

namespace tandem {

namespace {

constexpr ErrorBound table[] = {
#define TANDEM_EXACT_BOUND(id, ulps) {#id, Tier::strict, 0, ulps, 0}, {#id, Tier::precise, 0, ulps, 0},
#define TANDEM_STRICT_BOUND(id, ulps) {#id, Tier::strict, 0, ulps, 0},
#define TANDEM_FAST_BOUND(id, wrong, ulps, leaks) {#id, Tier::fast, wrong, ulps, leaks},
#include "hard/corpus/error_bounds.def"
#undef TANDEM_EXACT_BOUND
#undef TANDEM_STRICT_BOUND
#undef TANDEM_FAST_BOUND
};

}  // namespace

std::span<const ErrorBound> error_bounds() { return table; }

const ErrorBound* find_error_bound(std::string_view case_id, Tier tier) {
    for (const ErrorBound& bound : table) {
        if (bound.case_id == case_id && bound.tier == tier) return &bound;
    }
    return nullptr;
}

}  // namespace tandem
