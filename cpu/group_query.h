/// The query of one ray to the hierarchy of groups, which decides hits after the traversal.
#pragma once

#include "cpu/group_filter.h"
#include "cpu/kernels.h"
#include "cpu/query_source.h"
#include "tandem/kernel/traversal/candidates.h"

namespace tandem {

/// In the exact tiers the filters of a group run on all of its primitives at once, the intervals of hits
/// (hit_interval.h) of the few that remain give the limit of the traversal, and hits that overlap the nearest one are
/// decided after the traversal. In the tier fast a decision costs no more than an interval, so it is made at once.
///
/// The QueryContext of Embree must come first: Embree passes its address to the callbacks.
template <class Real, class Isa>
struct GroupQuery {
    using Lane = Lanes<float, GroupIsa<Isa>>;

    embree::QueryContext head;
    const Ray<Real>* ray;
    const QuerySource<Real>* source;
    Proposal<Real> proposal;
    Closest<Real> best;
    FilterRay<Lane> filter;  ///< the ray in every lane
    QueryRay interval_ray;
    float limit;   ///< the largest query parameter of interest
    float enough;  ///< a certain hit before it ends a search for any hit
    Candidates<4> candidates;

    /// Tests group `number`. True if a search for any hit has found one.
    template <Search search>
    TANDEM_HD_INLINE bool test(const CpuSceneView& view, std::uint32_t number) {
        bool found = false;
        visit_group(
            *view.groups, number, [&](const auto& group) __attribute__((always_inline)) {
                for (unsigned rest = filter_group(filter, group); rest != 0 && !found; rest &= rest - 1) {
                    found = keep<search>(view, group, lowest_bit(rest));
                }
            });
        return found;
    }

    /// After the traversal.
    TANDEM_HD_INLINE void decide_candidates(const SceneView& scene) {
        candidates.for_each(limit, [&](std::uint32_t id) { decide(scene, id); });
    }

  private:
    TANDEM_HD_INLINE void decide(const SceneView& scene, std::uint32_t id) {
        visit_primitive(scene, id,
                        [&](const auto& primitive) { test_primitive(primitive, id, *ray, *source, true, best); });
    }

    // Where the ray may hit primitive `id`, at `place` of the group, from numbers that are in the cache already.
    TANDEM_HD_INLINE HitInterval interval_of(const CpuSceneView& view, const BodyGroup& group, int place,
                                             std::uint32_t id) const {
        constexpr std::uint32_t others = PrimitiveKinds::bodies & ~PrimitiveKinds::sphere;
        const SceneView& scene = view.scene;
        if (id < scene.sphere_count) {
            __builtin_prefetch(scene.spheres + id);  // for the decision
            const Sphere sphere = {{group.x[place], group.y[place], group.z[place]}, group.radius[place]};
            return query_interval<Real, Sphere>(*source, id, interval_ray, sphere);
        }
        HitInterval interval = certain_miss;
        const auto set = [&]<class Body>(const Body& body) __attribute__((always_inline)) {
            interval = query_interval<Real, Body>(*source, id, interval_ray, body);
        };
        visit_primitive<others>(scene, id - scene.sphere_count, set);
        return interval;
    }
    TANDEM_HD_INLINE HitInterval interval_of(const CpuSceneView& view, const TriangleGroup& group, int place,
                                             std::uint32_t id) const {
        Triangle triangle = {corner(group, 0, place), corner(group, 1, place), corner(group, 2, place)};
        const Triangle* original = view.scene.triangles + (id - view.first_id[embree_triangles]);
        if ((view.scene.cutout_kinds & PrimitiveKinds::triangle) != 0) triangle.attributes = original->attributes;
        __builtin_prefetch(original);
        return query_interval<Real, Triangle>(*source, id, interval_ray, triangle);
    }
    TANDEM_HD_INLINE HitInterval interval_of(const CpuSceneView& view, const QuadGroup& group, int place,
                                             std::uint32_t id) const {
        Quad quad = {corner(group, 0, place), corner(group, 1, place), corner(group, 2, place),
                     corner(group, 3, place)};
        const Quad* original = view.scene.quads + (id - view.first_id[embree_quads]);
        if ((view.scene.cutout_kinds & PrimitiveKinds::quad) != 0) quad.attributes = original->attributes;
        __builtin_prefetch(original);
        return query_interval<Real, Quad>(*source, id, interval_ray, quad);
    }
    template <int corners>
    TANDEM_HD_INLINE static Vec3f corner(const FaceGroup<corners>& group, int number, int place) {
        return {group.x[number][place], group.y[number][place], group.z[number][place]};
    }

    template <Search search, class Group>
    TANDEM_HD_INLINE bool keep(const CpuSceneView& view, const Group& group, int place) {
        const std::uint32_t id = group.id[place];
        if constexpr (is_fast<Real>) {
            return decide_at_once<search>(view.scene, id);
        } else {
            const HitInterval interval = interval_of(view, group, place, id);
            if (!(interval.lo <= limit)) return false;
            if (search == Search::any && interval.hi < enough) return true;
            if constexpr (search == Search::nearest) limit = lesser(limit, interval.hi);
            candidates.add(interval.lo, id, limit);
            if (candidates.overflow == 0) [[likely]]
                return false;
            return make_place<search>(*this, view.scene, id);
        }
    }

    template <Search search>
    TANDEM_HD_INLINE bool decide_at_once(const SceneView& scene, std::uint32_t id) {
        const Double<Real> before = best.t;
        decide(scene, id);
        if (!(best.t < before)) return false;
        // not below 0, where intervals start
        limit = lesser(limit, greater(to_plain(proposal.limit(best.t)), 0.0F));
        return search == Search::any;
    }

    /// For the few rays with too many candidates: decides about all of them.
    template <Search search>
    TANDEM_HD_CALL bool make_place(GroupQuery& query, const SceneView& scene, std::uint32_t id) {
        const Candidates<4> full = query.candidates;
        query.candidates = {};
        bool found = query.template decide_at_once<search>(scene, id);
        for (const std::uint32_t other : full.id) found = query.template decide_at_once<search>(scene, other) || found;
        return found;
    }
};

}  // namespace tandem
