/// The oracle of the geometry tests: intersections from the definitions, in arithmetic of 400 decimal digits, which is
/// exact for the sums and products of floats that occur. Shares no formula with lib/tandem/kernel/shapes.
#pragma once

#include <boost/multiprecision/mpfr.hpp>
#include <cmath>
#include <optional>
#include <string>

#include "tandem/math/ray.h"
#include "tandem/math/transform.h"

namespace tandem::test {

using Big =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<400>, boost::multiprecision::et_off>;
struct BigVector {
    Big x, y, z;
    const Big& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};

template <class Real>
BigVector big(const Vec3<Real>& v) {
    return {Big(v.x), Big(v.y), Big(v.z)};
}
inline BigVector operator-(const BigVector& a, const BigVector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Big dot(const BigVector& a, const BigVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline BigVector operator*(const Matrix3& m, const BigVector& v) {
    return {dot(big(m.row[0]), v), dot(big(m.row[1]), v), dot(big(m.row[2]), v)};
}
inline BigVector along(const BigVector& origin, const BigVector& direction, const Big& t) {
    return {origin.x + t * direction.x, origin.y + t * direction.y, origin.z + t * direction.z};
}

/// t of the first crossing with t > 0 of a ray and a closed ball around 0; empty for a miss.
inline std::optional<Big> hit_ball(const BigVector& origin, const BigVector& direction, const Big& radius) {
    const Big a = dot(direction, direction);
    const Big b = -dot(origin, direction);
    const Big c = dot(origin, origin) - radius * radius;
    const Big discriminant = b * b - a * c;
    if (discriminant < 0) return std::nullopt;
    const Big root = sqrt(discriminant);
    if (c > 0) return b > 0 ? std::optional<Big>(c / (b + root)) : std::nullopt;
    if (c == 0) return b > 0 ? std::optional<Big>(2 * b / a) : std::nullopt;
    // inside: the exit, in the form that does not cancel
    return b > 0 ? (b + root) / a : -c / (root - b);
}

struct BoxHit {
    Big t;
    int axis;       ///< of the face; at edges and corners the lowest
    bool entering;  ///< false: the origin is inside, and t is the exit
};

/// The same for a closed box.
inline std::optional<BoxHit> hit_box(const BigVector& origin, const BigVector& direction, const BigVector& lower,
                                     const BigVector& upper) {
    std::optional<Big> near, far;
    int near_axis = 0, far_axis = 0;
    for (int i = 0; i < 3; ++i) {
        if (direction[i] == 0) {
            if (origin[i] < lower[i] || origin[i] > upper[i]) return std::nullopt;
            continue;
        }
        const Big first = ((direction[i] > 0 ? lower[i] : upper[i]) - origin[i]) / direction[i];
        const Big second = ((direction[i] > 0 ? upper[i] : lower[i]) - origin[i]) / direction[i];
        if (!near || first > *near) near = first, near_axis = i;
        if (!far || second < *far) far = second, far_axis = i;
    }
    if (!near || *near > *far || *far <= 0) return std::nullopt;
    if (*near > 0) return BoxHit{*near, near_axis, true};
    return BoxHit{*far, far_axis, false};
}

/// Whether the ray crosses the plane of another face within 2^-50 of the hit, so that the axes tie after rounding.
inline bool nearly_tied(const BigVector& origin, const BigVector& direction, const BigVector& lower,
                        const BigVector& upper, const BoxHit& hit) {
    for (int i = 0; i < 3; ++i) {
        if (i == hit.axis || direction[i] == 0) continue;
        const Big& face = (direction[i] > 0) == hit.entering ? lower[i] : upper[i];
        if (abs((face - origin[i]) / direction[i] - hit.t) <= abs(hit.t) * Big(0x1p-50)) return true;
    }
    return false;
}

inline BigVector cross(const BigVector& a, const BigVector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline BigVector operator*(const Big& s, const BigVector& v) { return {s * v.x, s * v.y, s * v.z}; }

struct TriangleHit {
    Big t;
    Big u, v;  ///< barycentric coordinates of the second and the third corner
};

/// The same for a closed triangle. A line in its plane misses. The point of the line in the plane is
/// origin + (height / speed) direction; everything is multiplied by speed, so that nothing is divided before the end.
inline std::optional<TriangleHit> hit_triangle(const BigVector& origin, const BigVector& direction, const BigVector& v0,
                                               const BigVector& v1, const BigVector& v2) {
    const BigVector normal = cross(v1 - v0, v2 - v0);
    const Big speed = dot(direction, normal);
    const Big height = dot(v0 - origin, normal);
    if (speed == 0) return std::nullopt;
    const BigVector point = along(speed * origin, direction, height);
    // twice the area of (point, edge), as far as it lies on the inner side
    const auto area = [&](const BigVector& from, const BigVector& to) {
        return Big(dot(cross(to - from, point - speed * from), normal) / speed);
    };
    const Big opposite_v1 = area(v2, v0), opposite_v2 = area(v0, v1);
    if (opposite_v1 < 0 || opposite_v2 < 0 || area(v1, v2) < 0) return std::nullopt;
    const Big whole = dot(normal, normal);
    const TriangleHit hit = {height / speed, opposite_v1 / whole, opposite_v2 / whole};
    return hit.t > 0 ? std::optional<TriangleHit>(hit) : std::nullopt;
}

/// Distance of a float from the exact value, in ulps.
inline double error_in_ulps(float value, const Big& exact) {
    const float nearest = mpfr_get_flt(exact.backend().data(), MPFR_RNDN);
    if (std::isinf(nearest) || std::isinf(value)) return nearest == value ? 0 : HUGE_VAL;
    const float ulp = std::nextafter(std::abs(nearest), HUGE_VALF) - std::abs(nearest);
    if (std::isinf(ulp)) return 0;
    return static_cast<double>(Big(abs(Big(value) - exact) / Big(ulp)));
}

/// A ray as a C++ literal, to reproduce a failure.
inline std::string reproducer(const Ray<float>& ray) {
    char text[200];
    std::snprintf(text, sizeof text, "Ray<float>{{%aF, %aF, %aF}, {%aF, %aF, %aF}}", static_cast<double>(ray.origin.x),
                  static_cast<double>(ray.origin.y), static_cast<double>(ray.origin.z),
                  static_cast<double>(ray.direction.x), static_cast<double>(ray.direction.y),
                  static_cast<double>(ray.direction.z));
    return text;
}

}  // namespace tandem::test
