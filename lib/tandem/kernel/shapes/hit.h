/// Hits, and the one order among them that decides which is nearest.
#pragma once

#include <cstdint>

#include "tandem/math/real.h"

namespace tandem {

/// Id of no primitive.
inline constexpr std::uint32_t no_primitive = 0xFFFFFFFFU;
/// Id that says "occluded": by which primitive, a shadow ray does not ask.
inline constexpr std::uint32_t some_primitive = 0xFFFFFFFEU;
/// From here on ids stand for no primitive of a scene.
inline constexpr std::uint32_t first_special_id = some_primitive;

/// The nearest hit found so far. t is double and positive: candidates are compared before the one rounding to
/// float that a caller sees, so that two surfaces less than a float apart still come in their true order.
template <class Real>
struct Closest {
    Double<Real> t;
    UInt<Real> primitive;
};

template <class Real>
TANDEM_HD Closest<Real> no_hit() {
    return {Double<Real>(__builtin_huge_val()), UInt<Real>(no_primitive)};
}

/// Is (t, primitive) nearer than `best`? Equal t: the lower id wins, whatever the order of discovery.
template <class Real>
TANDEM_HD Mask<Real> is_closer(const Double<Real>& t, const UInt<Real>& primitive, const Closest<Real>& best) {
    return t < best.t || (t == best.t && primitive < best.primitive);
}

/// What a shape finds out about a hit on it beside t, once, for all that is asked there: the point, the normals, the
/// parametrisation. record_hit() of each shape makes it.
template <class Real>
struct HitRecord {
    UInt<Real> part = UInt<Real>(0U);            ///< of a box the face (box.h), of a quad the triangle: 0 or 1
    Mask<Real> from_inside = Mask<Real>(false);  ///< of a body: the ray comes from within. Of a face it follows from
                                                 ///< its normal.
};

/// A hit as callers see it.
struct Hit {
    float t = 0;                             ///< in lengths of the ray's direction; 0 for a miss
    std::uint32_t primitive = no_primitive;  ///< id in the prepared scene, or no_primitive
};

/// `Real` of one lane.
template <class Real>
TANDEM_HD Hit to_hit(const Closest<Real>& closest) {
    if (closest.primitive == no_primitive) return {};
    return {to_plain(closest.t), closest.primitive};
}

}  // namespace tandem
