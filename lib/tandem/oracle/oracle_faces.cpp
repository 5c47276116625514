// Triangles for the oracle. Doubles decide lines that miss by more than their rounding error; the compiler's 113-bit
// floats decide all others.
#include <cmath>
#include <type_traits>

#include "tandem/oracle/oracle_geometry.h"

namespace tandem::oracle {

namespace {

__extension__ using Wide = __float128;

template <class Number>
struct Vector3 {
    Number x, y, z;
};
/// Doubles are rounded once, after the subtraction, so that the error is relative to the difference.
template <class Number>
Vector3<Number> difference(const Vector& a, const Vector& b) {
    using Operand = std::conditional_t<std::is_same_v<Number, double>, Real, Number>;
    return {static_cast<Number>(Operand(a.x) - Operand(b.x)), static_cast<Number>(Operand(a.y) - Operand(b.y)),
            static_cast<Number>(Operand(a.z) - Operand(b.z))};
}
/// Six times the volume of the tetrahedron of three edges.
template <class Number>
Number determinant(const Vector3<Number>& a, const Vector3<Number>& b, const Vector3<Number>& c) {
    return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}
template <class Number>
Number size(const Vector3<Number>& a) {
    const auto magnitude = [](Number x) { return x < 0 ? -x : x; };
    return magnitude(a.x) + magnitude(a.y) + magnitude(a.z);
}

/// The volumes between a line and the edges of a triangle, opposite to its corners: the line crosses the triangle if
/// they have equal signs.
template <class Number>
struct Crossing {
    Number volume[3];
    Number height;     ///< volume between the origin and the triangle
    Number magnitude;  ///< of the terms of the volumes

    Crossing(const Vector (&corner)[3], const Line& line) {
        const Vector3<Number> d = difference<Number>(line.direction, {0, 0, 0});
        const Vector3<Number> seen[3] = {difference<Number>(corner[0], line.origin),
                                         difference<Number>(corner[1], line.origin),
                                         difference<Number>(corner[2], line.origin)};
        for (int i = 0; i < 3; ++i) volume[i] = determinant(d, seen[(i + 1) % 3], seen[(i + 2) % 3]);
        height = determinant(seen[0], seen[1], seen[2]);
        const Number farthest = size(seen[0]) + size(seen[1]) + size(seen[2]);
        magnitude = size(d) * farthest * farthest;
    }

    /// Whether a volume is above `least` and another one below -`least`.
    [[nodiscard]] bool passes_by(Number least) const {
        bool above = false, below = false;
        for (const Number v : volume) {
            above = above || v > least;
            below = below || v < -least;
        }
        return above && below;
    }
};

/// Whether doubles show that a line misses. Each factor of a volume has an error of at most 2 units of 2^-53, and the
/// sums and products of a determinant add at most 6: 12 units of the magnitude together, a tenth of what is allowed
/// here (tests/agree/oracle_faces_test.cpp). Numbers so small that products could underflow, or so large that they
/// overflow, show nothing.
bool surely_misses(const Crossing<double>& rough) {
    return rough.magnitude > 1e-200 && rough.magnitude < 1e300 && rough.passes_by(rough.magnitude * 0x1p-46);
}

Vector interpolate(const FaceCorners& corners, const Vec3f* normals, const Vector& weight) {
    const auto at = [&](int i) { return to_vector(normals[corners.number[i]]); };
    return at(0) * weight.x + at(1) * weight.y + at(2) * weight.z;
}

}  // namespace

std::optional<SurfaceHit> hit_face(const FaceCorners& corners, const FaceAttributes& attributes, const Vec3f* normals,
                                   const Line& line) {
    const Vector corner[3] = {to_vector(corners.position[0]), to_vector(corners.position[1]),
                              to_vector(corners.position[2])};
    if (surely_misses(Crossing<double>(corner, line))) return std::nullopt;
    const Crossing<Wide> fine(corner, line);
    const Wide whole = fine.volume[0] + fine.volume[1] + fine.volume[2];
    if (whole == 0 || fine.passes_by(0)) return std::nullopt;
    const auto t = static_cast<Real>(fine.height / whole);
    if (!(t > 0)) return std::nullopt;

    const Vector to_second = corner[1] - corner[0], to_third = corner[2] - corner[0];
    const Vector own =
        unit({to_second.y * to_third.z - to_second.z * to_third.y, to_second.z * to_third.x - to_second.x * to_third.z,
              to_second.x * to_third.y - to_second.y * to_third.x});
    const auto share = [&](int i) { return static_cast<Real>(fine.volume[i] / whole); };
    const Vector weight = {share(0), share(1), share(2)};
    Vector normal = own;
    if (attributes.normals != no_attributes) {
        const Vector sum = interpolate(corners, normals + attributes.normals, weight);
        if (inner(sum, sum) > 0x1p-40L) normal = unit(sum);
    }
    if (is_double_sided(attributes) && inner(own, line.direction) > 0) normal = normal * -1;
    return SurfaceHit{t,      normal,          own, {corners.number[0], corners.number[1], corners.number[2]},
                      weight, attributes.sides};
}

}  // namespace tandem::oracle
