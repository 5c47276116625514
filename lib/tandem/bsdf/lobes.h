/// All lobes; each keeps to the interface.
#pragma once

#include "tandem/bsdf/coated_diffuse.h"
#include "tandem/bsdf/dielectric.h"
#include "tandem/bsdf/ggx_reflection.h"
#include "tandem/bsdf/lambert.h"
#include "tandem/bsdf/mirror.h"
#include "tandem/bsdf/phong_lobe.h"

namespace tandem {

#define TANDEM_LOBE(type, is)                  \
    static_assert(Lobe<type<float>, float>);   \
    static_assert(Lobe<type<double>, double>); \
    static_assert(Lobe<type<FastFloat>, FastFloat>);
#include "tandem/bsdf/lobes.def"
#undef TANDEM_LOBE

}  // namespace tandem
