/// The optical properties of a surface besides Phong's model.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// The properties of a material that need effects. All zero for a material that needs none.
struct Optics {
    Vec3f mirror{0, 0, 0};       ///< reflectance of a perfect mirror, RGB, each in [0, 1]
    float transmission = 0;      ///< fraction of the light for a dielectric, not for Phong's ambient and diffuse terms
    float ior = 1.5F;            ///< refractive index of the dielectric
    Vec3f absorption{0, 0, 0};   ///< of the dielectric, RGB, per metre: Beer's law
    Vec3f emission{0, 0, 0};     ///< radiance from the outside of the surface, RGB
    std::uint32_t priority = 0;  ///< of the dielectric where solids overlap (medium_stack.h)
    /// 1: `emission` times the base colour is visible from both sides and lights nothing. Not used in materials of
    /// a Scene, which have Material::unlit instead.
    std::uint32_t unlit = 0;
};

}  // namespace tandem
