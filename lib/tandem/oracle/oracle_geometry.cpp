#include "tandem/oracle/oracle_geometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tandem::oracle {

namespace {

/// t of the far side for a ray whose source says that it is inside: positive, whatever rounding did to the origin.
Real ahead(Real t) { return std::max<Real>(t, 0x1p-1022L); }

std::optional<SurfaceHit> hit_shape(const SceneView&, const Sphere& sphere, const Line& line, Start start) {
    return hit_sphere(to_vector(sphere.centre), sphere.radius, line, start);
}
std::optional<SurfaceHit> hit_shape(const SceneView&, const Box& box, const Line& line, Start start) {
    return hit_box(to_vector(box.lower), to_vector(box.upper), line, start);
}
std::optional<SurfaceHit> hit_shape(const SceneView&, const Ellipsoid& body, const Line& line, Start start) {
    return hit_placed(body, false, line, start);
}
std::optional<SurfaceHit> hit_shape(const SceneView&, const Parallelepiped& body, const Line& line, Start start) {
    return hit_placed(body, true, line, start);
}
std::optional<SurfaceHit> hit_shape(const SceneView& scene, const Triangle& triangle, const Line& line, Start start) {
    if (start != Start::anywhere) return std::nullopt;
    return hit_face({{triangle.v0, triangle.v1, triangle.v2}, {0, 1, 2}}, triangle.attributes, scene.normals, line);
}
std::optional<SurfaceHit> hit_shape(const SceneView& scene, const Quad& quad, const Line& line, Start start) {
    if (start != Start::anywhere && start != Start::before_first) return std::nullopt;
    const auto first = hit_face({{quad.v0, quad.v1, quad.v2}, {0, 1, 2}}, quad.attributes, scene.normals, line);
    const auto second = hit_face({{quad.v0, quad.v2, quad.v3}, {0, 2, 3}}, quad.attributes, scene.normals, line);
    if (start == Start::before_first) {
        if (!first || !second) return std::nullopt;
        return first->t < second->t ? second : first;
    }
    return !first || (second && second->t < first->t) ? second : first;
}

}  // namespace

Vector unit(const Vector& a) { return a * (1 / std::sqrt(inner(a, a))); }

std::optional<SurfaceHit> hit_sphere(const Vector& centre, Real radius, const Line& line, Start start) {
    if (start == Start::leaving_outward) return std::nullopt;
    // to the foot of the perpendicular from the centre, then half a chord back or forth
    const Real speed = std::sqrt(inner(line.direction, line.direction));
    const Vector along = line.direction * (1 / speed);
    const Vector from_centre = line.origin - centre;
    const Real to_foot = -inner(from_centre, along);
    const Vector foot = from_centre + along * to_foot;
    const Real height2 = radius * radius - inner(foot, foot);
    if (!(height2 >= 0)) {
        if (start != Start::leaving_inward) return std::nullopt;
        return SurfaceHit{ahead(to_foot / speed), unit(foot)};  // misses by a rounding error
    }
    const Real half_chord = std::sqrt(height2);
    // the root without cancellation; the other one from the product of the roots
    const Real far_root = to_foot >= 0 ? to_foot + half_chord : to_foot - half_chord;
    const Real distance = std::sqrt(inner(from_centre, from_centre));
    const Real power = (distance - radius) * (distance + radius);
    const Real other = far_root == 0 ? 0 : power / far_root;
    const Real entry = std::min(far_root, other);
    const Real exit = std::max(far_root, other);
    if (start == Start::leaving_inward) return SurfaceHit{ahead(exit / speed), unit(from_centre + along * exit)};
    const Real s = entry > 0 && start == Start::anywhere ? entry : exit;
    if (!(s > 0)) return std::nullopt;
    return SurfaceHit{s / speed, unit(from_centre + along * s)};
}

std::optional<SurfaceHit> hit_box(const Vector& lower, const Vector& upper, const Line& line, Start start) {
    if (start == Start::leaving_outward) return std::nullopt;
    Real entry = -HUGE_VALL;
    Real exit = HUGE_VALL;
    Vector entry_normal{0, 0, 0};
    Vector exit_normal{0, 0, 0};
    const auto clip = [&](Real lo, Real hi, Real o, Real d, const Vector& axis) {
        if (d == 0) return lo <= o && o <= hi;
        Real first = (lo - o) / d;
        Real last = (hi - o) / d;
        if (d < 0) std::swap(first, last);
        const Vector forward = axis * (d < 0 ? -1 : 1);
        if (first > entry) {
            entry = first;
            entry_normal = forward * -1;
        }
        if (last < exit) {
            exit = last;
            exit_normal = forward;
        }
        return true;
    };
    const bool in_x = clip(lower.x, upper.x, line.origin.x, line.direction.x, {1, 0, 0});
    const bool in_y = clip(lower.y, upper.y, line.origin.y, line.direction.y, {0, 1, 0});
    const bool in_z = clip(lower.z, upper.z, line.origin.z, line.direction.z, {0, 0, 1});
    if (start == Start::leaving_inward) return SurfaceHit{ahead(exit), exit_normal};
    const bool crosses = in_x && in_y && in_z && entry <= exit;
    if (!crosses) return std::nullopt;
    if (entry > 0 && start == Start::anywhere) return SurfaceHit{entry, entry_normal};
    if (exit > 0) return SurfaceHit{exit, exit_normal};
    return std::nullopt;
}

std::optional<SurfaceHit> hit_placed(const Placement& placement, bool is_box, const Line& line, Start start) {
    const Vector rows[3] = {to_vector(placement.object_from_world.row[0]),
                            to_vector(placement.object_from_world.row[1]),
                            to_vector(placement.object_from_world.row[2])};
    const auto to_object = [&](const Vector& v) {
        return Vector{inner(rows[0], v), inner(rows[1], v), inner(rows[2], v)};
    };
    const Line local = {to_object(line.origin - to_vector(placement.centre)), to_object(line.direction)};
    std::optional<SurfaceHit> hit =
        is_box ? hit_box({-1, -1, -1}, {1, 1, 1}, local, start) : hit_sphere({0, 0, 0}, 1, local, start);
    if (hit) {
        const Vector n = hit->normal;
        hit->normal = unit(rows[0] * n.x + rows[1] * n.y + rows[2] * n.z);
    }
    return hit;
}

std::optional<SurfaceHit> hit_primitive(const SceneView& scene, std::uint32_t id, const Line& line, Start start) {
    std::optional<SurfaceHit> hit;
    visit_primitive(scene, id, [&](const auto& primitive) { hit = hit_shape(scene, primitive, line, start); });
    if (hit && inner(hit->facet, hit->facet) == 0) hit->facet = hit->normal;
    return hit;
}

}  // namespace tandem::oracle
