/// The material of Phong's reflection model. Its terms are the lobes lambert.h and phong_lobe.h.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// Reflectances per RGB channel, linear, each in [0, 1]; shininess >= 0.
struct PhongMaterial {
    Vec3f ambient{0.08F, 0.08F, 0.08F};  ///< ka
    Vec3f diffuse{0.8F, 0.8F, 0.8F};     ///< kd
    Vec3f specular{1.0F, 1.0F, 1.0F};    ///< ks
    float shininess = 32.0F;             ///< alpha
};

}  // namespace tandem
