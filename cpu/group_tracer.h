/// Traces single rays through the hierarchy of groups.
#pragma once

#include "cpu/embree_tracer.h"
#include "cpu/group_query.h"
#include "tandem/kernel/traversal/quick_proposal.h"

namespace tandem {

template <class Real, class Isa>
void intersect_group_callback(const RTCIntersectFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto& view = *static_cast<const CpuSceneView*>(args->geometryUserPtr);
    auto& query = *reinterpret_cast<GroupQuery<Real, Isa>*>(args->context);
    (void)query.template test<Search::nearest>(view, args->primID);
    reinterpret_cast<RTCRayHit*>(args->rayhit)->ray.tfar = query.limit;
}

template <class Real, class Isa>
void occluded_group_callback(const RTCOccludedFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto& view = *static_cast<const CpuSceneView*>(args->geometryUserPtr);
    auto& query = *reinterpret_cast<GroupQuery<Real, Isa>*>(args->context);
    if (query.template test<Search::any>(view, args->primID)) {
        reinterpret_cast<RTCRay*>(args->ray)->tfar = -__builtin_huge_valf();  // "occluded"
    }
}

/// As EmbreeTracer, for one ray. `Isa`: the instruction set, which Real does not tell.
template <class Isa>
struct GroupTracer {
    const CpuSceneView& view;

    template <class Real>
    [[nodiscard]] TANDEM_HD_INLINE Closest<Real> closest(const Ray<Real>& ray, const QuerySource<Real>& source,
                                                         bool active) const {
        GroupQuery<Real, Isa> query;
        query.best = no_hit<Real>();
        if (!start(query, ray, source, active)) return query.best;
        query.limit = 3e38F;
        RTCRayHit rayhit;
        rayhit.ray = embree_detail::single_ray(query.proposal, to_plain(query.proposal.start_for(source)), query.limit);
        rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        embree::intersect1(view.groups->embree, query.head, rayhit);
        query.decide_candidates(view.scene);
        return query.best;
    }

    template <class Real>
    [[nodiscard]] TANDEM_HD_INLINE bool occluded(const Ray<Real>& ray, const Double<Real>& t_max,
                                                 const QuerySource<Real>& source, bool active) const {
        GroupQuery<Real, Isa> query;
        query.best = closest_starting_at<Real>(t_max);
        if (!start(query, ray, source, active)) return false;
        query.limit = to_plain(query.proposal.limit(t_max));
        if (!(query.limit >= 0)) return false;
        query.enough = to_plain(query.proposal.start(t_max));
        RTCRay embree_ray = embree_detail::single_ray(query.proposal, 0.0F, query.limit);
        embree::occluded1(view.groups->embree, query.head, embree_ray);
        if (embree_ray.tfar < 0) return true;
        query.decide_candidates(view.scene);
        return query.best.t < t_max;
    }

  private:
    /// Fills what all queries need; false if the ray cannot hit anything.
    template <class Real>
    TANDEM_HD_INLINE bool start(GroupQuery<Real, Isa>& query, const Ray<Real>& ray, const QuerySource<Real>& source,
                                bool active) const {
        if (!active) return false;
        if constexpr (std::is_same_v<Real, float>) {
            query.proposal = propose_quickly(ray, view.frame);
        } else {
            query.proposal = propose(ray, view.frame, true);
        }
        if (!query.proposal.active) return false;
        if constexpr (!is_fast<Real>) {
            const PathSource<Real>& path = source;
            query.interval_ray = make_query_ray(query.proposal, view.frame, path);
        }
        query.ray = &ray;
        query.source = &source;
        query.filter = in_all_lanes<typename GroupQuery<Real, Isa>::Lane>(make_filter_ray(ray));
        embree::init_context(query.head, false);
        return true;
    }
};

}  // namespace tandem
