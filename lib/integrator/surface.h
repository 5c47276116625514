/// What a hit says of the surface: normal and material, by kind of primitive.
#pragma once

#include "tandem/geometry/spawn_ray.h"
#include "tandem/scene/scene_view.h"

namespace tandem {

template <class Real>
struct Surface {
    Vec3<Double<Real>> normal;  ///< unit, outward, world space
    Vec3<Real> ambient, diffuse, specular;
    Real shininess;
};

/// The surface at `hit`, in the lanes of `found`. The rays of a packet hit few different primitives, so each of
/// these is looked up and its normal formed once, for all its rays.
template <class Real>
TANDEM_HD Surface<Real> surface_at(const SceneView& scene, const Ray<Real>& ray, const Closest<Real>& hit,
                                   const Mask<Real>& found) {
    using D = Double<Real>;
    const Vec3<Real> black = {Real(0.0F), Real(0.0F), Real(0.0F)};
    Surface<Real> surface = {{D(0.0), D(0.0), D(1.0)}, black, black, black, Real(1.0F)};
    for_each_value(hit.primitive, found, [&](std::uint32_t primitive, const Mask<Real>& here) TANDEM_INLINE_LAMBDA {
        const Vec3<D> normal = surface_point_of(scene, primitive, ray, NoSource{}, hit.t).normal;
        const PhongMaterial& material = scene.materials[scene.material_of[primitive]];
        surface.normal = select(here, normal, surface.normal);
        surface.ambient = select(here, broadcast<Real>(material.ambient), surface.ambient);
        surface.diffuse = select(here, broadcast<Real>(material.diffuse), surface.diffuse);
        surface.specular = select(here, broadcast<Real>(material.specular), surface.specular);
        surface.shininess = select(here, Real(material.shininess), surface.shininess);
    });
    return surface;
}

}  // namespace tandem
