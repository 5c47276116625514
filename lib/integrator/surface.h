/// What a hit says of the surface: normal and material, by kind of primitive.
#pragma once

#include "tandem/geometry/hit.h"
#include "tandem/geometry/shading_normal.h"
#include "tandem/scene/scene_view.h"

namespace tandem {

template <class Real>
struct Surface {
    Vec3<Double<Real>> normal;  ///< for shading: unit, outward, world space
    Vec3<Real> ambient, diffuse, specular;
    Real shininess;
};

// The normal of each kind at parameter t of a ray that hits the primitive there, in the lanes of `here`: of a sphere of
// any length, else unit.
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Sphere& sphere, const Ray<Real>& ray,
                                       const Double<Real>& t, const Mask<Real>&) {
    return sphere_offset(sphere, ray, t);  // see surface_at()
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Box& box, const Ray<Real>& ray, const Double<Real>&,
                                       const Mask<Real>&) {
    return face_normal<Real>(cross_box(box, ray), widen(ray.direction));
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Ellipsoid& body, const Ray<Real>& ray,
                                       const Double<Real>& t, const Mask<Real>&) {
    return ellipsoid_normal(body, ray, t);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView&, const Parallelepiped& body, const Ray<Real>& ray,
                                       const Double<Real>&, const Mask<Real>&) {
    return parallelepiped_normal(body, ray);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView& scene, const Triangle& triangle, const Ray<Real>& ray,
                                       const Double<Real>&, const Mask<Real>& here) {
    const Vec3f* normals = corner_normals(scene.normals, triangle.attributes);
    return shading_normal<Real>(triangle, normals, ray, here);
}
template <class Real>
TANDEM_HD Vec3<Double<Real>> normal_at(const SceneView& scene, const Quad& quad, const Ray<Real>& ray,
                                       const Double<Real>& t, const Mask<Real>& here) {
    const Vec3f* normals = corner_normals(scene.normals, quad.attributes);
    return shading_normal<Real>(quad, normals, ray, t, here);
}

/// The surface at `hit`, in the lanes of `found`. The rays of a packet hit few different primitives, so each of
/// these is looked up and its normal formed once, for all its rays. `kinds`: the ones that may have been hit.
template <std::uint32_t kinds = PrimitiveKinds::all, class Real>
TANDEM_HD Surface<Real> surface_at(const SceneView& scene, const Ray<Real>& ray, const Closest<Real>& hit,
                                   const Mask<Real>& found) {
    using D = Double<Real>;
    Mask<Real> on_sphere(false);
    const Vec3<Real> black = {Real(0.0F), Real(0.0F), Real(0.0F)};
    Surface<Real> surface = {{D(0.0), D(0.0), D(1.0)}, black, black, black, Real(1.0F)};
    for_each_value(hit.primitive, found, [&](std::uint32_t primitive, const Mask<Real>& here) TANDEM_INLINE_LAMBDA {
        Vec3<D> normal = surface.normal;
        visit_primitive<kinds>(scene, primitive, [&](const auto& body) TANDEM_INLINE_LAMBDA {
            normal = normal_at<Real>(scene, body, ray, hit.t, here);
            if constexpr (std::is_same_v<std::decay_t<decltype(body)>, Sphere>) on_sphere = on_sphere || here;
        });
        const PhongMaterial& material = scene.materials[scene.material_of[primitive]];
        surface.normal = select(here, normal, surface.normal);
        surface.ambient = select(here, broadcast<Real>(material.ambient), surface.ambient);
        surface.diffuse = select(here, broadcast<Real>(material.diffuse), surface.diffuse);
        surface.specular = select(here, broadcast<Real>(material.specular), surface.specular);
        surface.shininess = select(here, Real(material.shininess), surface.shininess);
    });
    // once for all lanes: the rays of a packet hit up to as many spheres as it has lanes
    if (any(on_sphere)) surface.normal = select(on_sphere, normalize(surface.normal), surface.normal);
    return surface;
}

}  // namespace tandem
