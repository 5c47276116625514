/// All lobes, checked against their interface.
#pragma once

#include "tandem/kernel/bsdf/coated_diffuse.h"
#include "tandem/kernel/bsdf/dielectric.h"
#include "tandem/kernel/bsdf/ggx_reflection.h"
#include "tandem/kernel/bsdf/lambert.h"
#include "tandem/kernel/bsdf/mirror.h"
#include "tandem/kernel/bsdf/phong_lobe.h"

namespace tandem {

#define TANDEM_LOBE(type, ...)                 \
    static_assert(Lobe<type<float>, float>);   \
    static_assert(Lobe<type<double>, double>); \
    static_assert(Lobe<type<FastFloat>, FastFloat>);
#include "tandem/kernel/bsdf/lobes.def"
#undef TANDEM_LOBE

}  // namespace tandem
