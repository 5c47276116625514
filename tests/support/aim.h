/// Rays aimed at solids: shared by the generators of hard cases.
#pragma once

#include <algorithm>
#include <cmath>

#include "support/random.h"
#include "tandem/kernel/shapes/sphere.h"
#include "tandem/math/ray.h"
#include "tandem/math/transform.h"

namespace tandem::test {

/// A point in the cube from -1 to 1.
inline Vec3f any_point(Random& random) {
    return {random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)};
}

inline Vec3d any_unit(Random& random) {
    for (;;) {
        const Vec3d v = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
        const double length2 = tandem::dot(v, v);
        if (length2 > 1e-4 && length2 <= 1.0) return normalize(v);
    }
}

/// A unit vector perpendicular to `axis`.
inline Vec3d any_across(Random& random, const Vec3d& axis) {
    for (;;) {
        const Vec3d v = tandem::cross(axis, any_unit(random));
        if (tandem::dot(v, v) > 1e-4) return normalize(v);
    }
}

/// A rotation about any axis, as a unit quaternion.
inline Quaternion any_turn(Random& random) {
    const Vec3d axis = any_unit(random) * 0.8;
    return {axis.x, axis.y, axis.z, 0.6};
}

struct SphereCase {
    Sphere sphere;
    Ray<float> ray;
};

/// A ray from `distance` centres away that passes the centre at `impact` radii.
inline SphereCase aim(Random& random, const Vec3d& centre, double radius, double distance, double impact,
                      double length = 1) {
    const Vec3d towards = any_unit(random);
    const Vec3d origin = centre - towards * distance;
    const Vec3d target = centre + any_across(random, towards) * (impact * radius);
    // the target lies in the plane of the centre; a grazing line is tilted, so measure its distance from the centre
    const double tilt = std::sqrt(std::max(0.0, 1 - impact * impact * radius * radius / (distance * distance)));
    const Vec3d direction = (target - centre) * (1 / std::max(tilt, 1e-3)) + (centre - origin);
    return {{narrow(centre), static_cast<float>(radius)}, {narrow(origin), narrow(normalize(direction) * length)}};
}

}  // namespace tandem::test
