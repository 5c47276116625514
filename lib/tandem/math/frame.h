/// Orthonormal frames around a direction.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// Three unit vectors at right angles, right-handed: tangent x bitangent = normal.
template <class D>
struct Frame {
    Vec3<D> tangent;
    Vec3<D> bitangent;
    Vec3<D> normal;
};

/// A frame for any unit normal, continuous except at the plane z = 0. The vectors deviate from unit length and right
/// angles by no more than the normal's own error and 4 ulp. Source: T. Duff et al., "Building an Orthonormal Basis,
/// Revisited", JCGT 6(1), 2017, whose form has no singularity at -z. Tested by tests/math/frame_test.cpp.
template <class D>
TANDEM_HD_INLINE Frame<D> frame_around(const Vec3<D>& normal) {
    const D one(1.0);
    const D sign = select(normal.z < D(0.0), -one, one);
    const D a = -one / (sign + normal.z);
    const D b = normal.x * normal.y * a;
    return {{one + sign * normal.x * normal.x * a, sign * b, -sign * normal.x},
            {b, sign + normal.y * normal.y * a, -normal.y},
            normal};
}

/// The vector with coordinates (x, y, z) along tangent, bitangent and normal.
template <class D>
TANDEM_HD_INLINE Vec3<D> from_frame(const Frame<D>& frame, const D& x, const D& y, const D& z) {
    return frame.tangent * x + frame.bitangent * y + frame.normal * z;
}

/// The coordinates of a vector along tangent, bitangent and normal.
template <class D>
TANDEM_HD_INLINE Vec3<D> to_frame(const Frame<D>& frame, const Vec3<D>& v) {
    return {dot(frame.tangent, v), dot(frame.bitangent, v), dot(frame.normal, v)};
}

}  // namespace tandem
