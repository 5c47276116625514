/// Hits, and the order that decides which is nearest.
#pragma once

#include <cstdint>

#include "tandem/math/real.h"

namespace tandem {

/// The id that means no primitive.
inline constexpr std::uint32_t no_primitive = 0xFFFFFFFFU;
/// The id that means "occluded" by some primitive: shadow rays do not find out which.
inline constexpr std::uint32_t some_primitive = 0xFFFFFFFEU;
/// Ids from here on are not primitives of a scene.
inline constexpr std::uint32_t first_special_id = some_primitive;

/// The nearest hit found so far. t is double and positive. Hits are compared before callers get t rounded to float, so
/// that surfaces less than one ulp of float apart keep their order.
template <class Real>
struct Closest {
    Double<Real> t;
    UInt<Real> primitive;
};

template <class Real>
TANDEM_HD_INLINE Closest<Real> no_hit() {
    return {Double<Real>(__builtin_huge_val()), UInt<Real>(no_primitive)};
}

/// Whether (t, primitive) is nearer than `best`. On equal t the lower id wins, in any order of discovery.
template <class Real>
TANDEM_HD_INLINE Mask<Real> is_closer(const Double<Real>& t, const UInt<Real>& primitive, const Closest<Real>& best) {
    return t < best.t || (t == best.t && primitive < best.primitive);
}

/// The data, besides t, that determine the surface point, the normals and the parametrisation of a hit. record_hit() of
/// each shape computes it once.
template <class Real>
struct HitRecord {
    UInt<Real> part = UInt<Real>(0U);            ///< box: the face (box.h); quad: the triangle, 0 or 1
    Mask<Real> from_inside = Mask<Real>(false);  ///< the ray comes from inside a solid; false for faces
};

/// A hit for callers of the library.
struct Hit {
    float t = 0;                             ///< in lengths of the ray's direction; 0 for a miss
    std::uint32_t primitive = no_primitive;  ///< id in the prepared scene, or no_primitive
};

/// `Real` of one lane.
template <class Real>
TANDEM_HD_INLINE Hit to_hit(const Closest<Real>& closest) {
    if (closest.primitive == no_primitive) return {};
    return {to_plain(closest.t), closest.primitive};
}

}  // namespace tandem
