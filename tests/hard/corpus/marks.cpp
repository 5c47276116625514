#include "hard/corpus/marks.h"

#include <cmath>

namespace tandem {

namespace {

constexpr Mark table[] = {
#define TANDEM_EXACT_MARK(id, ulps) {#id, Tier::strict, 0, ulps, 0}, {#id, Tier::precise, 0, ulps, 0},
#define TANDEM_STRICT_MARK(id, ulps) {#id, Tier::strict, 0, ulps, 0},
#define TANDEM_FAST_MARK(id, wrong, ulps, leaks) {#id, Tier::fast, wrong, ulps, leaks},
#include "hard/corpus/marks.def"
#undef TANDEM_EXACT_MARK
#undef TANDEM_STRICT_MARK
#undef TANDEM_FAST_MARK
};

}  // namespace

std::span<const Mark> marks() { return table; }

const Mark* find_mark(std::string_view case_id, Tier tier) {
    for (const Mark& mark : table) {
        if (mark.case_id == case_id && mark.tier == tier) return &mark;
    }
    return nullptr;
}

}  // namespace tandem
