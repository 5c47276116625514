/// The inputs that parts of materials are evaluated with.
#pragma once

#include "tandem/kernel/bsdf/optics.h"
#include "tandem/kernel/texture/texture_view.h"
#include "tandem/math/inverse_square_root.h"

namespace tandem {

/// The values of a material's textures at a point; 1 where it has none.
template <class Real>
struct MaterialTexels {
    Rgba<Real> base_colour = {Real(1.0F), Real(1.0F), Real(1.0F), Real(1.0F)};
    Rgba<Real> metallic_roughness = {Real(1.0F), Real(1.0F), Real(1.0F), Real(1.0F)};
    Vec3<Real> emission = {Real(1.0F), Real(1.0F), Real(1.0F)};
    Real anisotropy = Real(1.0F);
#define TANDEM_PART_TEXTURE(part, needs, name, names, space, is) \
    Rgba<Real> name = {Real(1.0F), Real(1.0F), Real(1.0F), Real(1.0F)};
#include "tandem/kernel/bsdf/lobes.def"
};

/// A point of a surface.
template <class Real>
struct MaterialPoint {
    const Optics& optics;
    const MaterialTexels<Real>& texels;
    const Vec3<Double<Real>>& normal;  ///< for shading, of any length
    const Vec3<Real>& direction;       ///< of the ray that hits the surface, of any length

    /// The cosine of the angle between the normal and the direction to the viewer, on either side of the surface.
    [[nodiscard]] TANDEM_HD Double<Real> view_cosine() const {
        using D = Double<Real>;
        const Vec3<D> way = widen(direction);
        const D height = dot(way, normal);
        const D side = select(height < D(0.0F), -height, height);
        return side * inverse_square_root(dot(way, way) * dot(normal, normal));
    }
};

}  // namespace tandem
