/// What a hit says of the surface: normal and material, by kind of primitive.
#pragma once

#include "tandem/effects/effects.h"
#include "tandem/geometry/hit.h"
#include "tandem/geometry/ray_source.h"
#include "tandem/geometry/shading_normal.h"
#include "tandem/scene/scene_view.h"

namespace tandem {

template <class Real>
struct Surface {
    Vec3<Double<Real>> normal;  ///< for shading: unit, outward, world space
    Vec3<Real> ambient, diffuse, specular;
    Real shininess;
    // only where the effects call for them
    UInt<Real> material;
    Vec3<Real> mirror;
    Real transmission;
};

// The normal of each kind at parameter t of a ray that hits the primitive there, in the lanes of `here`: of a sphere of
// any length, else unit. `exits`: where the ray leaves the very body that it left inward.
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Sphere& sphere, const Ray<Real>& ray,
                                       const Double<Real>& t, const Mask<Real>&, const Mask<Real>&) {
    return sphere_offset(sphere, ray, t);  // see surface_at()
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Box& box, const Ray<Real>& ray, const Double<Real>&,
                                       const Mask<Real>&, const Mask<Real>& exits) {
    return face_normal<Real>(cross_box(box, ray), widen(ray.direction), exits);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Ellipsoid& body, const Ray<Real>& ray,
                                       const Double<Real>& t, const Mask<Real>&, const Mask<Real>&) {
    return ellipsoid_normal(body, ray, t);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Parallelepiped& body, const Ray<Real>& ray,
                                       const Double<Real>&, const Mask<Real>&, const Mask<Real>& exits) {
    return parallelepiped_normal(body, ray, exits);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView& scene, const Triangle& triangle, const Ray<Real>& ray,
                                       const Double<Real>&, const Mask<Real>& here, const Mask<Real>&) {
    const Vec3f* normals = corner_normals(scene.normals, triangle.attributes);
    return shading_normal<Real>(triangle, normals, ray, here);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView& scene, const Quad& quad, const Ray<Real>& ray,
                                       const Double<Real>& t, const Mask<Real>& here, const Mask<Real>&) {
    const Vec3f* normals = corner_normals(scene.normals, quad.attributes);
    return shading_normal<Real>(quad, normals, ray, t, here);
}

/// The surface at `hit`, which `ray` from `source` found, in the lanes of `found`. The rays of a packet hit few
/// different primitives, so each of these is looked up and its normal formed once, for all its rays. `kinds`: the ones
/// that may have been hit; `Effects`: what their materials may call for.
template <class Effects, std::uint32_t kinds = PrimitiveKinds::all, class Real, class From>
TANDEM_HD Surface<Real> surface_at(const SceneView& scene, const Ray<Real>& ray, const From& source,
                                   const Closest<Real>& hit, const Mask<Real>& found) {
    using D = Double<Real>;
    Mask<Real> on_sphere(false);
    const Vec3<Real> black = {Real(0.0F), Real(0.0F), Real(0.0F)};
    Surface<Real> surface = {{D(0.0), D(0.0), D(1.0)}, black, black,     black, Real(1.0F),
                             UInt<Real>(0U),           black, Real(0.0F)};
    for_each_value(hit.primitive, found, [&](std::uint32_t primitive, const Mask<Real>& here) TANDEM_INLINE_LAMBDA {
        Vec3<D> normal = surface.normal;
        const Mask<Real> exits = leaves_inward<Real>(source, primitive);
        visit_primitive<kinds>(scene, primitive, [&](const auto& body) TANDEM_INLINE_LAMBDA {
            normal = normal_at<Real>(scene, body, ray, hit.t, here, exits);
            if constexpr (std::is_same_v<std::decay_t<decltype(body)>, Sphere>) on_sphere = on_sphere || here;
        });
        const std::uint32_t number = scene.material_of[primitive];
        const PhongMaterial& material = scene.materials[number];
        surface.normal = select(here, normal, surface.normal);
        surface.ambient = select(here, broadcast<Real>(material.ambient), surface.ambient);
        surface.diffuse = select(here, broadcast<Real>(material.diffuse), surface.diffuse);
        surface.specular = select(here, broadcast<Real>(material.specular), surface.specular);
        surface.shininess = select(here, Real(material.shininess), surface.shininess);
        if (has_bounces<Effects>()) {
            const Optics& optics = scene.optics[number];
            surface.material = select(here, UInt<Real>(number), surface.material);
            if (Effects::has(Effect::reflection)) {
                surface.mirror = select(here, broadcast<Real>(optics.mirror), surface.mirror);
            }
            if (Effects::has(Effect::refraction)) {
                surface.transmission = select(here, Real(optics.transmission), surface.transmission);
            }
        }
    });
    // once for all lanes: the rays of a packet hit up to as many spheres as it has lanes
    if (any(on_sphere)) surface.normal = select(on_sphere, normalize(surface.normal), surface.normal);
    return surface;
}

}  // namespace tandem
