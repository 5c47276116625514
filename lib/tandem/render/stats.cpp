#include "tandem/render/stats.h"

#include <fmt/format.h>

#include <algorithm>

namespace tandem {

namespace {

/// Appends the text unless it is there already.
void add_once(std::string& list, const std::string& text) {
    if (text.empty() || list.find(text) != std::string::npos) return;
    list += (list.empty() ? "" : "; ") + text;
}

}  // namespace

std::vector<std::string> in_words(const RenderCounters& counters) {
    std::vector<std::string> clauses;
#define TANDEM_COUNTER(name, words) \
    if (counters.name > 0) clauses.push_back(fmt::format("{} {}", counters.name, words));
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER
    return clauses;
}

void add(PhaseTimes& total, const PhaseTimes& part) {
    total.build += part.build;
    total.compile += part.compile;
    total.upload += part.upload;
    total.render += part.render;
    total.download += part.download;
}

void add(RenderStats& total, const RenderStats& part) {
    add(total.seconds, part.seconds);
    // these are facts about the scene, so they are not added up over the parts
    const std::uint64_t primitives = std::max(total.counters.dropped_primitives, part.counters.dropped_primitives);
    const std::uint64_t lights = std::max(total.counters.dropped_lights, part.counters.dropped_lights);
    total.counters += part.counters;
    total.counters.dropped_primitives = primitives;
    total.counters.dropped_lights = lights;
    total.rays += part.rays;
    total.device_bytes = std::max(total.device_bytes, part.device_bytes);
    total.registers = std::max(total.registers, part.registers);
    total.occupancy = total.occupancy > 0 ? std::min(total.occupancy, part.occupancy) : part.occupancy;
    add_once(total.variant, part.variant);
    add_once(total.warning, part.warning);
    total.effects |= part.effects;
    total.carried |= part.carried;
}

}  // namespace tandem
