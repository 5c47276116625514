/// The names of samplers (kernel/sampler/samplers.def).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tandem/kernel/sampler/sampler_kind.h"

namespace tandem {

struct SamplerInfo {
    Sampler sampler;
    const char* name;
    const char* help;
};

/// All samplers, random first.
[[nodiscard]] const std::vector<SamplerInfo>& sampler_infos();

[[nodiscard]] std::string to_string(Sampler sampler);

/// Throws InputError that lists the samplers there are.
[[nodiscard]] Sampler parse_sampler(std::string_view name);

}  // namespace tandem
