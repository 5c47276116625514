#include "tandem/render/sampler_names.h"

#include "tandem/base/find_name.h"

namespace tandem {

const std::vector<SamplerInfo>& sampler_infos() {
    static const std::vector<SamplerInfo> infos = {
#define TANDEM_SAMPLER(name, help) {Sampler::name, #name, help},
#include "tandem/kernel/sampler/samplers.def"
#undef TANDEM_SAMPLER
    };
    return infos;
}

std::string to_string(Sampler sampler) { return sampler_infos()[static_cast<std::size_t>(sampler)].name; }

Sampler parse_sampler(std::string_view name) { return find_name(sampler_infos(), name, "sampler").sampler; }

}  // namespace tandem
