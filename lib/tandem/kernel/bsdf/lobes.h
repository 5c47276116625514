/// All lobes, checked against their interface.
#pragma once

#define TANDEM_LOBE_HEADERS
#include "tandem/kernel/bsdf/lobes.def"

namespace tandem {

#define TANDEM_LOBE(type, ...)                 \
    static_assert(Lobe<type<float>, float>);   \
    static_assert(Lobe<type<double>, double>); \
    static_assert(Lobe<type<FastFloat>, FastFloat>);
#include "tandem/kernel/bsdf/lobes.def"

}  // namespace tandem
