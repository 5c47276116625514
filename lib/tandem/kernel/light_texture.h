/// The emissive texture of an area light at a sampled point.
#pragma once

#include "tandem/kernel/corner_values.h"
#include "tandem/kernel/lights/light_sample.h"

namespace tandem {

template <class Real>
struct TexturePoint {
    Double<Real> u, v;
};

namespace light_texture_detail {

/// Texture coordinates at the projection of `point` onto the plane of (v0, v1, v2), whose corners have the coordinates
/// `a`, `b` and `c`. From the point, not from a ray, since a light is sampled by points. The error of the weights is
/// the rounding of `point` over the triangle's height.
template <class Real>
TANDEM_HD TexturePoint<Real> on_triangle(const Vec3f& v0, const Vec3f& v1, const Vec3f& v2, const Vec2f& a,
                                         const Vec2f& b, const Vec2f& c, const Vec3<Double<Real>>& point) {
    using D = Double<Real>;
    const Vec3<D> origin = broadcast<D>(v0);
    const Vec3<D> edge1 = broadcast<D>(v1) - origin;
    const Vec3<D> edge2 = broadcast<D>(v2) - origin;
    const Vec3<D> to_point = point - origin;
    const Vec3<D> normal = cross(edge1, edge2);
    const D area2 = dot(normal, normal);
    const D at1 = dot(cross(to_point, edge2), normal) / area2;
    const D at2 = dot(cross(edge1, to_point), normal) / area2;
    const D rest = (D(1.0) - at1) - at2;
    return {(D(a.x) * rest + D(b.x) * at1) + D(c.x) * at2, (D(a.y) * rest + D(b.y) * at1) + D(c.y) * at2};
}

}  // namespace light_texture_detail

// `texcoords`: the values of the slot, as for parametrisation(). The point is on the surface, up to rounding.
template <class Real>
TANDEM_HD TexturePoint<Real> texture_point(const Sphere& sphere, const Vec2f*, const LightSample<Real>& drawn) {
    const auto at = parametrisation_detail::on_globe<Real>(drawn.point - broadcast<Double<Real>>(sphere.centre));
    return {at.u, at.v};
}
template <class Real>
TANDEM_HD TexturePoint<Real> texture_point(const Triangle& face, const Vec2f* texcoords,
                                           const LightSample<Real>& drawn) {
    const auto corner = parametrisation_detail::corners_of(face, texcoords);
    return light_texture_detail::on_triangle<Real>(face.v0, face.v1, face.v2, corner.uv[0], corner.uv[1], corner.uv[2],
                                                   drawn.point);
}
template <class Real>
TANDEM_HD TexturePoint<Real> texture_point(const Quad& face, const Vec2f* texcoords, const LightSample<Real>& drawn) {
    const auto corner = parametrisation_detail::corners_of(face, texcoords);
    const auto a = light_texture_detail::on_triangle<Real>(face.v0, face.v1, face.v2, corner.uv[0], corner.uv[1],
                                                           corner.uv[2], drawn.point);
    const auto b = light_texture_detail::on_triangle<Real>(face.v0, face.v2, face.v3, corner.uv[0], corner.uv[2],
                                                           corner.uv[3], drawn.point);
    return {select(drawn.in_second_half, b.u, a.u), select(drawn.in_second_half, b.v, a.v)};
}

/// The texture's factor for the emission of `body`, a sphere or a face, at the sampled point.
template <class Real, class Body>
TANDEM_HD Vec3<Real> light_texture_factor(const SceneView& scene, const MaterialTextures& textures, const Body& body,
                                          const LightSample<Real>& drawn) {
    const TextureUse& use = textures.emission;
    const TexturePoint<Real> at = texture_point<Real>(body, scene.texcoords + use.slot * corner_count<Body>, drawn);
    const Rgba<Real> texel = sample<Real>(scene.textures, use, at.u, at.v);
    return {texel.r, texel.g, texel.b};
}

}  // namespace tandem
