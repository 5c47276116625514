#include "tandem/render/stats.h"

#include <fmt/format.h>

namespace tandem {

std::vector<std::string> in_words(const RenderCounters& counters) {
    std::vector<std::string> clauses;
#define TANDEM_COUNTER(name, words) \
    if (counters.name > 0) clauses.push_back(fmt::format("{} {}", counters.name, words));
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER
    return clauses;
}

}  // namespace tandem
