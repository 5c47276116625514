#include "tandem/compile/render_origin.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tandem/math/lengths.h"
#include "tandem/math/ray.h"

namespace tandem {

namespace {

/// The surface point of the box that is nearest to p, which may be inside.
Vec3d nearest_of_box(const Vec3d& lower, const Vec3d& upper, const Vec3d& p) {
    Vec3d nearest = p;
    double least = __builtin_huge_val();
    int axis = -1;
    double face = 0;
    for (int i = 0; i < 3; ++i) {
        nearest[i] = std::clamp(p[i], lower[i], upper[i]);
        for (const double f : {lower[i], upper[i]}) {
            if (std::abs(p[i] - f) >= least) continue;
            least = std::abs(p[i] - f);
            axis = i;
            face = f;
        }
    }
    if (nearest == p && axis >= 0) nearest[axis] = face;
    return nearest;
}

/// The point of the segment from a to b that is nearest to p.
Vec3d nearest_of_segment(const Vec3d& a, const Vec3d& b, const Vec3d& p) {
    const Vec3d along = b - a;
    const double length2 = dot(along, along);
    const double s = length2 > 0 ? std::clamp(dot(p - a, along) / length2, 0.0, 1.0) : 0;
    return a + along * s;
}

/// The point of a triangle that is nearest to p: its projection, or a point of an edge.
Vec3d nearest_of_triangle(const Vec3d& v0, const Vec3d& v1, const Vec3d& v2, const Vec3d& p) {
    const Vec3d normal = cross(v1 - v0, v2 - v0);
    const double area2 = dot(normal, normal);
    const auto inside = [&](const Vec3d& a, const Vec3d& b) { return dot(cross(b - a, p - a), normal) >= 0; };
    if (area2 > 0 && inside(v0, v1) && inside(v1, v2) && inside(v2, v0)) {
        return p - normal * (dot(p - v0, normal) / area2);
    }
    Vec3d nearest = v0;
    double least = __builtin_huge_val();
    for (const auto& [a, b] : {std::pair{v0, v1}, std::pair{v1, v2}, std::pair{v2, v0}}) {
        const Vec3d candidate = nearest_of_segment(a, b, p);
        const double distance = length(candidate - p);
        if (distance < least) {
            nearest = candidate;
            least = distance;
        }
    }
    return nearest;
}

/// Rounds to a multiple of `step`, a power of two; numbers whose ulp is not below the step stay as they are.
double snap(double x, double step) { return std::abs(x) < step * 0x1p52 ? std::rint(x / step) * step : x; }

}  // namespace

void RenderOrigin::add_sphere(const Vec3d& centre, double radius) {
    add_extent(centre - Vec3d(radius), centre + Vec3d(radius));
    const Vec3d to_camera = camera_ - centre;
    const double distance = length(to_camera);
    const double gap = std::abs(distance - radius);
    if (gap >= distance_) return;
    add_candidate(distance > 0 ? centre + to_camera * (radius / distance) : centre + Vec3d{radius, 0, 0}, gap);
}

void RenderOrigin::add_box(const Vec3d& lower, const Vec3d& upper) {
    add_extent(lower, upper);
    const Vec3d nearest = nearest_of_box(lower, upper, camera_);
    add_candidate(nearest, length(nearest - camera_));
}

void RenderOrigin::add_placed(const Transform& world_from_unit, const Matrix3& unit_from_world, bool is_box) {
    Vec3d half;
    for (int i = 0; i < 3; ++i) half[i] = norm1(world_from_unit.linear.row[i]);
    add_extent(world_from_unit.translation - half, world_from_unit.translation + half);
    const Vec3d camera = unit_from_world * (camera_ - world_from_unit.translation);
    const double distance = length(camera);
    const Vec3d unit_point = is_box         ? nearest_of_box({-1, -1, -1}, {1, 1, 1}, camera)
                             : distance > 0 ? camera * (1 / distance)
                                            : Vec3d{1, 0, 0};
    const Vec3d nearest = transform_point(world_from_unit, unit_point);
    add_candidate(nearest, length(nearest - camera_));
}

void RenderOrigin::add_mesh(const Mesh& mesh, const Transform& world_from_object) {
    const auto world = [&](std::uint32_t index) {
        return transform_point(world_from_object, widen(mesh.positions[index]));
    };
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
        const std::uint32_t* corner = &mesh.triangles[i];
        add_triangle(world(corner[0]), world(corner[1]), world(corner[2]));
    }
    for (std::size_t i = 0; i < mesh.quads.size(); i += 4) {
        const std::uint32_t* corner = &mesh.quads[i];
        const Vec3d diagonal[2] = {world(corner[0]), world(corner[2])};
        add_triangle(diagonal[0], world(corner[1]), diagonal[1]);
        add_triangle(diagonal[0], diagonal[1], world(corner[3]));
    }
}

void RenderOrigin::add_triangle(const Vec3d& v0, const Vec3d& v1, const Vec3d& v2) {
    for (const Vec3d& v : {v0, v1, v2}) add_extent(v, v);
    const Vec3d nearest = nearest_of_triangle(v0, v1, v2, camera_);
    add_candidate(nearest, length(nearest - camera_));
}

void RenderOrigin::add_point(const Vec3d& point) { reach_ = std::max(reach_, max_norm(point)); }

void RenderOrigin::add(const RenderOrigin& other) {
    add_extent(other.lower_, other.upper_);
    add_candidate(other.nearest_, other.distance_);
    reach_ = std::max(reach_, other.reach_);
}

Vec3d RenderOrigin::get() const {
    const double extent = max_norm(upper_ - lower_);
    if (!(distance_ < __builtin_huge_val())) return {0, 0, 0};
    Vec3d origin = nearest_;
    const double length = 16 * (extent > 0 ? std::min(distance_, extent) : distance_);
    if (length > 0) {
        const double step = std::ldexp(1.0, std::ilogb(length));
        origin = {snap(origin.x, step), snap(origin.y, step), snap(origin.z, step)};
    }
    // the difference of two coordinates within the limit may exceed it
    const double farthest =
        std::max({reach_, max_norm(lower_), max_norm(upper_), max_norm(camera_)}) + max_norm(origin);
    return farthest <= double{coordinate_limit} ? origin : Vec3d{0, 0, 0};
}

void RenderOrigin::add_candidate(const Vec3d& point, double distance) {
    if (distance >= distance_) return;
    nearest_ = point;
    distance_ = distance;
}

void RenderOrigin::add_extent(const Vec3d& lower, const Vec3d& upper) {
    for (int i = 0; i < 3; ++i) {
        lower_[i] = std::min(lower_[i], lower[i]);
        upper_[i] = std::max(upper_[i], upper[i]);
    }
}

}  // namespace tandem
