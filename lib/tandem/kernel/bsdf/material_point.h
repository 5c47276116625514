/// What parts of materials are evaluated with.
#pragma once

#include "tandem/kernel/bsdf/optics.h"
#include "tandem/kernel/texture/texture_view.h"

namespace tandem {

/// What the textures of a material say at a point; 1 where it has none.
template <class Real>
struct MaterialTexels {
    Rgba<Real> base_colour = {Real(1.0F), Real(1.0F), Real(1.0F), Real(1.0F)};
    Rgba<Real> metallic_roughness = {Real(1.0F), Real(1.0F), Real(1.0F), Real(1.0F)};
    Vec3<Real> emission = {Real(1.0F), Real(1.0F), Real(1.0F)};
    Real anisotropy = Real(1.0F);
};

/// A point of a surface.
template <class Real>
struct MaterialPoint {
    const Optics& optics;
    const MaterialTexels<Real>& texels;
};

}  // namespace tandem
