#include "tandem/effects/names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "tandem/base/error.h"

namespace tandem {

namespace {

std::vector<std::string> names_in(EffectMask mask, const char* prefix) {
    std::vector<std::string> names;
    for (const EffectName& entry : effect_names()) {
        if (mask.has(entry.effect)) names.push_back(std::string(prefix) + entry.name);
    }
    return names;
}

EffectMask parse_name(std::string_view name) {
    if (name == "all") return all_effects;
    for (const EffectName& entry : effect_names()) {
        if (name == entry.name) return entry.effect;
    }
    throw InputError(fmt::format("there is no effect '{}'; the effects are {}, all or none", name,
                                 fmt::join(names_in(all_effects, ""), ", ")));
}

}  // namespace

const std::vector<EffectName>& effect_names() {
    static const std::vector<EffectName> names = {
#define TANDEM_EFFECT(name, adds) {Effect::name, #name, adds},
#include "tandem/effects/effects.def"
    };
    return names;
}

const char* to_string(Effect effect) { return effect_names()[static_cast<std::size_t>(effect)].name; }

std::string to_string(EffectMask mask) {
    return mask.empty() ? "none" : fmt::format("{}", fmt::join(names_in(mask, ""), ", "));
}

ForcedEffects parse_effects(std::string_view text) {
    ForcedEffects forced;
    const auto force = [&](EffectMask mask, bool on) {
        forced.on = on ? forced.on | mask : forced.on - mask;
        forced.off = on ? forced.off - mask : forced.off | mask;
    };
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(','), text.size());
        const std::string_view word = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (word == "all" || word == "none") {
            force(all_effects, word == "all");
        } else if (word.starts_with('+') || word.starts_with('-')) {
            force(parse_name(word.substr(1)), word.front() == '+');
        } else {
            throw InputError(
                fmt::format("effects are forced by '+name' or '-name', separated by commas, or by 'all' or 'none'; "
                            "'{}' is neither",
                            word));
        }
    }
    return forced;
}

std::string to_string(const ForcedEffects& forced) {
    std::vector<std::string> words = names_in(forced.on, "+");
    for (std::string& word : names_in(forced.off, "-")) words.push_back(std::move(word));
    return fmt::format("{}", fmt::join(words, ","));
}

}  // namespace tandem
