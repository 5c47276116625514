/// Triangles in the query of a packet to Embree: their hits are decided after the traversal, for all lanes at once.
/// Tested by tests/cpu/triangle_query_test.cpp.
#pragma once

#include "cpu/kernels.h"
#include "cpu/query_source.h"
#include "tandem/kernel/shapes/triangle_lanes.h"
#include "tandem/kernel/traversal/hit_interval.h"
#include "tandem/math/lanes.h"

namespace tandem {

/// As Candidates (kernel/traversal/candidates.h), for each lane. It keeps two: the caller decides at once about others.
template <class Real>
class LaneCandidates {
  public:
    using F = Float<Real>;

    /// Keeps a primitive that may be hit at `from` <= limit, in the lanes of `here`. Returns those that have no place.
    TANDEM_HD_INLINE Mask<Real> add(const F& from, std::uint32_t primitive, const F& limit, Mask<Real> here) {
        for (int k = 0; k < most; ++k) {
            const Mask<Real> place = here && !(lo_[k] <= limit);
            lo_[k] = select(place, from, lo_[k]);
            id_[k] = select(place, UInt<Real>(primitive), id_[k]);
            here = here && !place;
        }
        return here;
    }

    /// Calls decide(id, here) for those that may be hit at or before the limit, in the lanes of `active`.
    template <class Decide>
    TANDEM_HD_INLINE void for_each(const F& limit, const Mask<Real>& active, const Decide& decide) const {
        for (int k = 0; k < most; ++k) {
            const Mask<Real> here = active && lo_[k] <= limit;
            if (any(here)) decide(id_[k], here);
        }
    }

  private:
    static constexpr int most = 2;

    F lo_[most] = {F(interval_detail::infinity), F(interval_detail::infinity)};
    UInt<Real> id_[most] = {UInt<Real>(0U), UInt<Real>(0U)};
};

/// During the traversal, the interval of a hit (hit_interval.h) gives the limit of the traversal. So a packet whose
/// lanes hit different triangles decides once, not once for each triangle.
template <class Real>
class TriangleQuery {
  public:
    using F = Float<Real>;

    /// `farthest`: the end of a search for any hit. Hits of rays that passed a masked one are decided at once, and so
    /// is everything in the tier fast.
    template <Search search>
    TANDEM_HD_INLINE void start(const CpuSceneView& view, const Proposal<Real>& proposal,
                                const QuerySource<Real>& source, const Double<Real>& farthest) {
        if constexpr (!is_fast<Real>) {
            if (view.scene.triangle_count == 0 || any(source.last_masked.t > Double<Real>(0.0))) return;
            count_ = view.scene.triangle_count;
            ray_ = make_query_ray(proposal, view.frame, NoSource{});
            if constexpr (search == Search::any) enough_ = proposal.start(farthest);
        }
    }

    /// Whether primitive `id` is a triangle whose hits are deferred.
    [[nodiscard]] TANDEM_HD_INLINE bool defers(const CpuSceneView& view, std::uint32_t id) const {
        if constexpr (is_fast<Real>) return false;
        return id - view.first_id[embree_triangles] < count_;
    }

    /// Tests a triangle that defers(). Sets `limit`, a query parameter, to where the traversal may stop, and returns
    /// the lanes that must decide at once. For any hit, `limit` is `found` in the lanes that certainly hit.
    template <Search search>
    TANDEM_HD_INLINE Mask<Real> test(const CpuSceneView& view, std::uint32_t id, const QuerySource<Real>& source,
                                     const Mask<Real>& active, float found, F& limit) {
        const UInt<Real> number(id);
        Mask<Real> here = active && source.primitive != number && source.light != number;
        const Triangle& triangle = view.scene.triangles[id - view.first_id[embree_triangles]];
        const bool culls = source.culls && triangle.attributes.sides == FaceSides::culled;
        const auto interval = hit_interval(ray_, edges_of(triangle.v0, triangle.v1, triangle.v2), culls);
        here = here && interval.lo <= limit;
        if (!any(here)) return here;
        Mask<Real> unsure(false);
        if (culls) {  // a certain hit is one of the front; of others, decide() does not ask for the side
            unsure = here && !(interval.hi < F(interval_detail::infinity));
            here = here && !unsure;
        }
        if constexpr (search == Search::nearest) {
            limit = select(here, lesser(limit, interval.hi), limit);
        } else {
            const Mask<Real> is_certain = here && interval.hi < enough_;
            limit = select(is_certain, F(found), limit);
            here = here && !is_certain;
        }
        return unsure || candidates_.add(interval.lo, id, limit, here);
    }

    /// After the traversal, which ended at `limit`.
    TANDEM_HD_INLINE void decide(const CpuSceneView& view, const Ray<Real>& ray, const F& limit,
                                 const Mask<Real>& active, Closest<Real>& best) const {
        if (count_ == 0) return;
        candidates_.for_each(limit, active, [&](const UInt<Real>& id, const Mask<Real>& here) {
            const std::uint32_t first = view.first_id[embree_triangles];
            const std::uint32_t one = lane(id, lowest_bit(here.bits()));
            const UInt<Real> same(one);
            Double<Real> t(0.0);
            Mask<Real> hit;
            if (!any(here && id != same)) {
                hit = first_hit(view.scene.triangles[one - first], ray, t, here, best.t);
            } else {
                const UInt<Real> index = select(here, id, same) - UInt<Real>(first);
                const auto corners = load_corners<Real>(view.scene.triangles, count_, index);
                hit = first_hit(corners.v0, corners.v1, corners.v2, ray, t, here, best.t);
            }
            keep_nearest<Real>(hit, t, id, best);
        });
    }

  private:
    std::uint32_t count_ = 0;  ///< of triangles; 0 if none is deferred
    QueryRayOf<F> ray_;
    F enough_;
    LaneCandidates<Real> candidates_;
};

/// One ray defers hits through groups (group_query.h).
template <class Real>
requires(RealTraits<Real>::lanes == 1) class TriangleQuery<Real> {
};

}  // namespace tandem
