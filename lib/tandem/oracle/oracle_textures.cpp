#include "tandem/oracle/oracle_textures.h"

#include <algorithm>
#include <cmath>

namespace tandem::oracle {

namespace {

/// `p`: from the centre of a globe.
TexturePoint on_globe(const Vector& p) {
    const Real around = std::hypot(p.x, p.z);
    const Real longitude = around > 0 ? std::atan2(p.x, p.z) : 0;
    TexturePoint at{};
    at.u = Real(0.5) + longitude / (2 * pi);
    at.v = std::atan2(around, p.y) / pi;
    at.along_u = {std::cos(longitude), 0, -std::sin(longitude)};
    const Real latitude = std::atan2(p.y, around);
    at.along_v = {std::sin(longitude) * std::sin(latitude), -std::cos(latitude),
                  std::cos(longitude) * std::sin(latitude)};
    return at;
}

/// `p`: in the cube [-1, 1]^3; `face`: the outward normal of its face.
TexturePoint on_cube(const Vector& p, const Vector& face) {
    const auto share = [](Real x) { return std::clamp<Real>((x + 1) / 2, 0, 1); };
    TexturePoint at{};
    if (std::abs(face.x) > Real(0.5)) {
        at.along_u = {0, 0, face.x > 0 ? Real(-1) : Real(1)};
        at.along_v = {0, -1, 0};
    } else if (std::abs(face.y) > Real(0.5)) {
        at.along_u = {1, 0, 0};
        at.along_v = {0, 0, face.y > 0 ? Real(1) : Real(-1)};
    } else {
        at.along_u = {face.z > 0 ? Real(1) : Real(-1), 0, 0};
        at.along_v = {0, -1, 0};
    }
    at.u = share(inner(p, at.along_u));
    at.v = share(inner(p, at.along_v));
    return at;
}

Vector in_object(const Placement& body, const Vector& v) {
    const Matrix3& m = body.object_from_world;
    return {inner(to_vector(m.row[0]), v), inner(to_vector(m.row[1]), v), inner(to_vector(m.row[2]), v)};
}

/// The inverse of the matrix, by cofactors, without the division by the determinant: maps object-space directions to
/// world space.
void to_world(const Placement& body, TexturePoint& at) {
    const Vector r0 = to_vector(body.object_from_world.row[0]), r1 = to_vector(body.object_from_world.row[1]),
                 r2 = to_vector(body.object_from_world.row[2]);
    const Vector c0 = cross(r1, r2), c1 = cross(r2, r0), c2 = cross(r0, r1);
    const Real sign = inner(r0, c0) < 0 ? -1 : 1;
    const auto turn = [&](const Vector& v) { return unit((c0 * v.x + c1 * v.y + c2 * v.z) * sign); };
    at.along_u = turn(at.along_u);
    at.along_v = turn(at.along_v);
}

/// The coordinates of a face's corners, or those of the unit square.
TexturePoint on_face(const SceneView& scene, const FaceAttributes& attributes, const Vec3f* position, bool is_quad,
                     const SurfaceHit& hit, std::uint32_t slot) {
    static constexpr Vec2f square[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    static constexpr Vec2f half[] = {{0, 0}, {1, 0}, {0, 1}};
    const Vec2f* uv = attributes.texcoords != no_attributes
                          ? scene.texcoords + attributes.texcoords + slot * (is_quad ? 4U : 3U)
                      : is_quad ? square
                                : half;
    const Vec2f a = uv[hit.corner[0]], b = uv[hit.corner[1]], c = uv[hit.corner[2]];
    TexturePoint at{};
    at.u = Real{a.x} * hit.weight.x + Real{b.x} * hit.weight.y + Real{c.x} * hit.weight.z;
    at.v = Real{a.y} * hit.weight.x + Real{b.y} * hit.weight.y + Real{c.y} * hit.weight.z;
    const Vector origin = to_vector(position[hit.corner[0]]);
    const Vector e1 = to_vector(position[hit.corner[1]]) - origin, e2 = to_vector(position[hit.corner[2]]) - origin;
    const Real du1 = Real{b.x} - a.x, dv1 = Real{b.y} - a.y, du2 = Real{c.x} - a.x, dv2 = Real{c.y} - a.y;
    const Real sign = du1 * dv2 - du2 * dv1 < 0 ? -1 : 1;
    at.along_u = (e1 * dv2 - e2 * dv1) * sign;
    at.along_v = (e2 * du1 - e1 * du2) * sign;
    return at;
}

/// A whole number wrapped into [0, size).
std::int64_t wrapped(std::int64_t i, std::int64_t size, Wrap wrap) {
    const auto modulo = [](std::int64_t a, std::int64_t n) { return (a % n + n) % n; };
    if (wrap == Wrap::clamp_to_edge) return std::clamp<std::int64_t>(i, 0, size - 1);
    if (wrap == Wrap::repeat) return modulo(i, size);
    const std::int64_t j = modulo(i, 2 * size);
    return j < size ? j : 2 * size - 1 - j;
}

}  // namespace

TexturePoint texture_point(const SceneView& scene, std::uint32_t id, const Vector& point, const SurfaceHit& hit,
                           std::uint32_t slot) {
    TexturePoint at{};
    visit_primitive(scene, id, [&](const auto& body) {
        using Body = std::decay_t<decltype(body)>;
        if constexpr (std::is_same_v<Body, Sphere>) {
            at = on_globe(point - to_vector(body.centre));
        } else if constexpr (std::is_same_v<Body, Ellipsoid>) {
            at = on_globe(in_object(body, point - to_vector(body.centre)));
            to_world(body, at);
        } else if constexpr (std::is_same_v<Body, Box>) {
            const Vector lower = to_vector(body.lower), size = to_vector(body.upper) - lower;
            const auto cube = [](Real x, Real from, Real length) {
                return length > 0 ? (x - from) / length * 2 - 1 : 0;
            };
            at = on_cube(
                {cube(point.x, lower.x, size.x), cube(point.y, lower.y, size.y), cube(point.z, lower.z, size.z)},
                hit.facet);
        } else if constexpr (std::is_same_v<Body, Parallelepiped>) {
            const Vector p = in_object(body, point - to_vector(body.centre));
            const Real most = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
            const auto side = [&](Real x) { return std::abs(x) == most ? (x < 0 ? Real(-1) : Real(1)) : Real(0); };
            at = on_cube(p, {side(p.x), side(p.y), side(p.z)});
            to_world(body, at);
        } else if constexpr (std::is_same_v<Body, Triangle>) {
            const Vec3f corners[] = {body.v0, body.v1, body.v2};
            at = on_face(scene, body.attributes, corners, false, hit, slot);
        } else {
            const Vec3f corners[] = {body.v0, body.v1, body.v2, body.v3};
            at = on_face(scene, body.attributes, corners, true, hit, slot);
        }
    });
    return at;
}

Texel sample_texture(const SceneView& scene, const TextureUse& use, const TexturePoint& at) {
    if (use.texture == no_texture) return {1, 1, 1, 1};
    const TextureDescriptor& d = scene.textures.textures[use.texture];
    const Real u = Real{use.u_row[0]} * at.u + Real{use.u_row[1]} * at.v + Real{use.u_row[2]};
    const Real v = Real{use.v_row[0]} * at.u + Real{use.v_row[1]} * at.v + Real{use.v_row[2]};
    const auto level = [&](std::uint32_t byte, bool is_colour) {
        const Real share = Real(byte) / 255;
        if (!is_colour || d.space == ColourSpace::linear) return share;
        return share <= Real(0.04045) ? share / Real(12.92) : std::pow((share + Real(0.055)) / Real(1.055), Real(2.4));
    };
    const auto texel = [&](std::int64_t x, std::int64_t y) {
        const auto column = wrapped(x, d.width, d.wrap_s), row = wrapped(y, d.height, d.wrap_t);
        const std::uint32_t bits =
            scene.textures.texels[d.first_texel + static_cast<std::uint32_t>(row * d.width + column)];
        return Texel{level(bits & 255, true), level(bits >> 8 & 255, true), level(bits >> 16 & 255, true),
                     level(bits >> 24, false)};
    };
    const Real x = u * d.width, y = v * d.height;
    if (d.filter == Filter::nearest) {
        return texel(static_cast<std::int64_t>(std::floor(x)), static_cast<std::int64_t>(std::floor(y)));
    }
    const auto left = static_cast<std::int64_t>(std::floor(x - Real(0.5)));
    const auto top = static_cast<std::int64_t>(std::floor(y - Real(0.5)));
    Texel sum{0, 0, 0, 0};
    for (int i = 0; i < 4; ++i) {
        const std::int64_t column = left + i % 2, row = top + i / 2;
        const Real weight = (1 - std::abs(x - Real(0.5) - Real(column))) * (1 - std::abs(y - Real(0.5) - Real(row)));
        const Texel t = texel(column, row);
        sum = {sum.r + weight * t.r, sum.g + weight * t.g, sum.b + weight * t.b, sum.a + weight * t.a};
    }
    return sum;
}

Real product_of_alphas(Real a, Real b) { return static_cast<float>(a) * static_cast<float>(b); }

Texel base_colour_at(const SceneView& scene, std::uint32_t id, const Vector& point, const SurfaceHit& hit) {
    const MaterialTextures& textures = scene.textures.materials[scene.material_of[id]];
    Texel colour = sample_texture(scene, textures.diffuse, texture_point(scene, id, point, hit, textures.diffuse.slot));
    bool on_face = false;
    visit_primitive(scene, id, [&](const auto& body) {
        on_face = requires { body.attributes; };
    });
    if (!on_face || textures.colour_slot == no_slot) return colour;
    const TexturePoint rg = texture_point(scene, id, point, hit, textures.colour_slot);
    const TexturePoint ba = texture_point(scene, id, point, hit, textures.colour_slot + 1);
    return {colour.r * rg.u, colour.g * rg.v, colour.b * ba.u, product_of_alphas(colour.a, ba.v)};
}

}  // namespace tandem::oracle
