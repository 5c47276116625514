/// The source and end of a ray in the CPU's tracers: one type for all rays, so that each decision is compiled once.
/// Tested by tests/cpu/query_source_test.cpp.
#pragma once

#include "tandem/kernel/traversal/hit_interval.h"
#include "tandem/kernel/traversal/intersect.h"

namespace tandem {

/// A PathSource that is also a ShadowSource: hits on `light` do not count. `culls`: culled faces are not hit from
/// behind.
template <class Real>
struct QuerySource : PathSource<Real> {
    UInt<Real> light = UInt<Real>(no_primitive);
    bool culls = false;

    TANDEM_HD_INLINE QuerySource() = default;
    TANDEM_HD_INLINE explicit QuerySource(const NoSource&) {}
    TANDEM_HD_INLINE explicit QuerySource(const Source<Real>& source) : PathSource<Real>{source} {}
    TANDEM_HD_INLINE explicit QuerySource(const PathSource<Real>& source) : PathSource<Real>(source), culls(true) {}
    TANDEM_HD_INLINE explicit QuerySource(const ShadowSource<Real>& source)
        : PathSource<Real>{source}, light(source.light) {}
    TANDEM_HD_INLINE explicit QuerySource(const CulledShadowSource<Real>& source)
        : PathSource<Real>{source}, light(source.light), culls(true) {}
    TANDEM_HD_INLINE explicit QuerySource(const MaskedShadowSource<Real>& source)
        : PathSource<Real>{source}, light(source.light), culls(true) {}
};

namespace query_detail {

/// hit_interval_from() of the front of a culled face. A call: with the side in the interval of every face, rays among
/// faces that are not culled took 1 % longer.
template <class Real, class Face>
TANDEM_HD_CALL HitInterval front_interval(const PathSource<Real>& source, std::uint32_t id, const QueryRay& ray,
                                          const Face& face) {
    return hit_interval_from<Real, Face>(source, id, ray, face, true);
}

/// first_hit_from() for rays that start on the primitive itself, that have passed a masked hit, or that hit a culled
/// face.
template <class Real, class Primitive>
TANDEM_HD_CALL Mask<Real> first_hit_from_surface(const Primitive& primitive, std::uint32_t id, const Ray<Real>& ray,
                                                 const PathSource<Real>& source, const Mask<Real>& active,
                                                 const Double<Real>& farthest, Double<Real>& t, bool culls) {
    return first_hit_from(source, primitive, id, ray, active, farthest, t, culls);
}

}  // namespace query_detail

/// hit_interval_from() of the same source.
template <class Real, class Primitive>
TANDEM_HD_INLINE HitInterval query_interval(const QuerySource<Real>& source, std::uint32_t id, const QueryRay& ray,
                                            const Primitive& primitive) {
    if (source.light == id) return certain_miss;
    const PathSource<Real>& path = source;
    const HitInterval both = hit_interval_from<Real, Primitive>(path, id, ray, primitive, false);
    if constexpr (is_face<Primitive>) {
        const bool culls = source.culls && primitive.attributes.sides == FaceSides::culled;
        if (culls && both.lo < interval_detail::infinity) [[unlikely]] {
            return query_detail::front_interval<Real>(path, id, ray, primitive);
        }
    }
    return both;
}

/// test_primitive() as a call: inlining it into its many callers would take the compiler minutes.
template <class Real, class Primitive>
TANDEM_HD_CALL void test_primitive(const Primitive& primitive, std::uint32_t id, const Ray<Real>& ray,
                                   const QuerySource<Real>& source, const Mask<Real>& candidate, Closest<Real>& best) {
    const UInt<Real> number(id);
    const Mask<Real> active =
        candidate && source.light != number && can_meet<Real, Primitive>(source, id, Mask<Real>(false));
    if (!any(active)) return;
    const Mask<Real> starts_here = source.primitive == number;
    bool culls = false;
    if constexpr (is_face<Primitive>) culls = source.culls && primitive.attributes.sides == FaceSides::culled;
    Double<Real> t(0.0);
    Mask<Real> hit;
    if (culls || any(active && (starts_here || source.last_masked.t > Double<Real>(0.0)))) {
        hit = query_detail::first_hit_from_surface<Real>(primitive, id, ray, source, active, best.t, t, culls);
    } else {
        hit = first_hit_from(NoSource{}, primitive, id, ray, active, best.t, t);
    }
    keep_nearest<Real>(hit, t, number, best);
}

}  // namespace tandem
