/// Closed forms for polygons seen from a point, in 400 digits, from the definitions. They share nothing with
/// lib/tandem/kernel/lights.
#pragma once

#include <boost/math/constants/constants.hpp>
#include <vector>

#include "support/exact_geometry.h"

namespace tandem::test {

inline BigVector unit(const BigVector& a) { return Big(1 / sqrt(dot(a, a))) * a; }
inline Big angle_between(const BigVector& a, const BigVector& b) {
    const BigVector c = cross(a, b);
    return atan2(sqrt(dot(c, c)), dot(a, b));
}

/// The solid angle of a triangle by Girard's theorem: the sum of the angles minus pi.
inline double girard(const Vec3d& point, const Vec3d& v0, const Vec3d& v1, const Vec3d& v2) {
    const BigVector p = big(point);
    const BigVector corner[] = {big(v0) - p, big(v1) - p, big(v2) - p};
    Big sum = -boost::math::constants::pi<Big>();
    for (int i = 0; i < 3; ++i) {
        const BigVector& a = corner[i];
        sum += angle_between(cross(a, corner[(i + 1) % 3]), cross(a, corner[(i + 2) % 3]));
    }
    return static_cast<double>(sum);
}

/// Irradiance at a point with a unit normal under a polygon of radiance 1 above the horizon: J. H. Lambert,
/// "Photometria", 1760: half the sum over the edges of their angles times the cosine between the normal and that of the
/// edge's plane.
inline double lambert(const Vec3d& point, const Vec3d& normal, const std::vector<Vec3d>& corners) {
    const BigVector p = big(point);
    Big sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const BigVector a = big(corners[i]) - p;
        const BigVector b = big(corners[(i + 1) % corners.size()]) - p;
        sum += angle_between(a, b) * dot(unit(cross(a, b)), big(normal));
    }
    return static_cast<double>(Big(abs(sum) / 2));
}

}  // namespace tandem::test
