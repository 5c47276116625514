/// The mirror direction.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// `direction` mirrored at the plane with normal `normal`: d - 2 (d . n) n, again a unit vector.
///
/// Needs: both unit vectors to within rounding, of either orientation.
/// Gives: length 1 within 4 ulp of double after any number of reflections: the result is normalised, so errors in the
///        lengths of the inputs do not accumulate.
/// Tested by tests/kernel/bsdf/reflect_test.cpp and group F of the corpus (tests/hard).
template <class D>
TANDEM_HD_INLINE Vec3<D> reflect(const Vec3<D>& direction, const Vec3<D>& normal) {
    const D along = dot(direction, normal);
    const D twice = along + along;
    return normalize(
        Vec3<D>{direction.x - twice * normal.x, direction.y - twice * normal.y, direction.z - twice * normal.z});
}

}  // namespace tandem
