/// Traces rays through the binary BVH, and decides in its leaves or behind the walk.
#pragma once

#include "tandem/kernel/traversal/bvh_walk.h"
#include "tandem/kernel/traversal/candidates.h"
#include "tandem/kernel/traversal/ray_tracer.h"

namespace tandem {

namespace bvh_detail {

/// Tests every primitive, for a ray whose stack overflowed: slow but correct. That cannot happen with a BVH from
/// build_bvh(). A separate function, so that other rays need no registers for it. Kernels that are linked for a scene
/// do not contain it, because their BVHs always come from build_bvh(); an overflow is still counted.
template <std::uint32_t kinds, class Real, class From>
TANDEM_HD_CALL Closest<Real> try_all(SceneView scene, Ray<Real> ray, From source, Closest<Real> best) {
    const FilterRay<Real> filter = make_filter_ray(ray);
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) {
        intersect_primitive<Real, kinds>(scene, id, filter, source, true, best);
    }
    return best;
}

}  // namespace bvh_detail

/// Where a BvhStructure decides. The bits are the same.
enum class Decisions {
    in_leaves,    ///< at once
    behind_walk,  ///< the walk keeps candidates by their intervals (hit_interval.h), and all threads decide together
};

/// `kind_set`: as for LoopTracerFor. Rays of the tier fast are decided in leaves in any case.
template <std::uint32_t kind_set, Decisions decisions = Decisions::in_leaves>
struct BvhStructure {
    static constexpr std::uint32_t kinds = kind_set;
    static constexpr bool has_hierarchy = true;
    /// At the edges of a mesh more faces than two are unsure.
    static constexpr int most_candidates = (kinds & PrimitiveKinds::faces) != 0 ? 4 : 2;

    template <class Real>
    static constexpr bool decides_behind = decisions == Decisions::behind_walk && !is_fast<Real>;

    SceneView scene;
    BvhView bvh;

    template <Search search, class Real, class From>
    TANDEM_HD_INLINE void find(const Ray<Real>& ray, const From& source, Closest<Real>& best) const {
        const Proposal<Real> proposal = propose(ray, bvh.frame, true);
        if (!proposal.active) return;
        bvh_detail::WalkEnd end{};
        if constexpr (decides_behind<Real>) {
            end = find_behind_walk<search>(ray, source, proposal, best);
        } else {
            end = find_in_leaves<search>(ray, source, proposal, best);
        }
        if (end.stack_was_full && !end.stopped) [[unlikely]] {
            bvh_detail::count(bvh.stack_overflows);
            if constexpr (!is_linked) best = bvh_detail::try_all<kinds>(scene, ray, source, best);
        }
    }

    /// Keeps the primitives that a ray may hit at or before `limit`: at first the largest query parameter of interest,
    /// then that of the nearest certain hit. A search for any hit stops at a certain one before `enough`.
    template <Search search, class Real, class From>
    TANDEM_HD_INLINE bvh_detail::WalkEnd collect(const From& source, const QueryRay& query, float enough, float& limit,
                                                 Candidates<most_candidates>& candidates) const {
        return walk_intervals<Real>(source, query, limit, [&](const HitInterval& interval, std::uint32_t id) {
            if (search == Search::any && interval.hi < enough) return true;
            if constexpr (search == Search::nearest) limit = lesser(limit, interval.hi);
            candidates.add(interval.lo, id, limit);
            return false;
        });
    }

  private:
    template <Search search, class Real, class From>
    TANDEM_HD_INLINE bvh_detail::WalkEnd find_in_leaves(const Ray<Real>& ray, const From& source,
                                                        const Proposal<Real>& proposal, Closest<Real>& best) const {
        const FilterRay<Real> filter = make_filter_ray(ray);
        const SlabRay slab = make_slab_ray(to_plain(proposal.ray.origin), to_plain(proposal.ray.direction));
        const Double<Real> t_max = best.t;
        // a constant for other rays: with start_for() nvcc spills more, and nearest hits take 6 % longer
        constexpr bool may_start_late = std::is_same_v<From, PathSource<Real>>;
        const float start = may_start_late ? to_plain(proposal.start_for(source)) : 0.0F;
        float limit = search == Search::any ? to_plain(proposal.limit(t_max)) : 3e38F;
        return bvh_detail::walk(bvh.nodes, slab, start, limit, [&](std::int32_t leaf) {
            try_leaf(leaf, filter, source, proposal, best, limit);
            return search == Search::any && best.t < t_max;
        });
    }

    template <class Real, class From>
    TANDEM_HD_INLINE void try_leaf(std::int32_t leaf, const FilterRay<Real>& filter, const From& source,
                                   const Proposal<Real>& proposal, Closest<Real>& best, float& limit) const {
        const std::uint32_t first = leaf_first(leaf);
        const std::uint32_t end = first + leaf_count(leaf);
        for (std::uint32_t i = first; i < end; ++i) {
            const Sphere around = bvh_detail::load_entry_sphere(bvh, i);
            if constexpr (!is_fast<Real>) {  // in the tier fast the test costs hardly more than the filter
                if (!may_touch_sphere(filter, around.centre, around.radius)) continue;
            }
            const std::uint32_t id = bvh.entry_ids[i];
            const Double<Real> t_before = best.t;
            // not in a function of its own: nvcc would compile the code for spheres twice
            if (may_have(PrimitiveKinds::sphere) &&
                (!may_have(kinds & ~PrimitiveKinds::sphere) || id < scene.sphere_count)) {
                test_primitive(around, id, filter.ray, source, true, best);
            } else {
                intersect_primitive<Real, kinds>(scene, id, filter, source, true, best);
            }
            if (best.t < t_before) limit = to_plain(proposal.limit(best.t));
        }
    }

    template <Search search, class Real, class From>
    TANDEM_HD_INLINE bvh_detail::WalkEnd find_behind_walk(const Ray<Real>& ray, const From& source,
                                                          const Proposal<Real>& proposal, Closest<Real>& best) const {
        float limit = search == Search::any ? to_plain(proposal.limit(best.t)) : 3e38F;
        const float enough = search == Search::any ? to_plain(proposal.start(best.t)) : 0.0F;
        Candidates<most_candidates> candidates;
        const QueryRay query = make_query_ray(proposal, bvh.frame, source);
        const bvh_detail::WalkEnd end = collect<search, Real>(source, query, enough, limit, candidates);
        if (search == Search::any && end.stopped) {
            best = {0.0, some_primitive};
        } else if (candidates.overflow) [[unlikely]] {
            best = decide_crowd<search>(*this, ray, source, best, limit);
        } else {
            candidates.for_each(limit, [&](std::uint32_t id) { decide(ray, source, id, best); });
        }
        return end;
    }

    /// Calls take(interval, id) for the primitives that the ray may hit at or before `limit`, until one returns true.
    template <class Real, class From, class Take>
    TANDEM_HD_INLINE bvh_detail::WalkEnd walk_intervals(const From& source, const QueryRay& query, const float& limit,
                                                        const Take& take) const {
        const SlabRay slab = make_slab_ray(query.origin, query.direction);
        return bvh_detail::walk(bvh.nodes, slab, query.start, limit, [&](std::int32_t leaf) {
            const std::uint32_t first = leaf_first(leaf);
            const std::uint32_t end = first + leaf_count(leaf);
            for (std::uint32_t i = first; i < end; ++i) {
                const SphereLine line(query, bvh_detail::load_entry_sphere(bvh, i));
                if (line.misses()) continue;
                const std::uint32_t id = bvh.entry_ids[i];
                HitInterval interval;
                if (may_have(PrimitiveKinds::sphere) &&
                    (!may_have(kinds & ~PrimitiveKinds::sphere) || id < scene.sphere_count)) {
                    interval = hit_interval_from<Real, Sphere>(source, id, query, line);
                } else {
                    visit_primitive<kinds>(scene, id, [&]<class Primitive>(const Primitive& primitive) {
                        interval = hit_interval_from<Real, Primitive>(source, id, query, primitive);
                    });
                }
                if (interval.lo <= limit && take(interval, id)) return true;
            }
            return false;
        });
    }

    template <class Real, class From>
    TANDEM_HD_INLINE void decide(const Ray<Real>& ray, const From& source, std::uint32_t id,
                                 Closest<Real>& best) const {
        visit_primitive<kinds>(scene, id,
                               [&](const auto& primitive) { test_primitive(primitive, id, ray, source, true, best); });
    }

    /// For the few rays with too many candidates: walks once more, with what is known of the limit. Unsure hits are
    /// decided at once, and certain ones if there is no place for them. Out of line, so that other rays need no
    /// registers for it.
    template <Search search, class Real, class From>
    TANDEM_HD_CALL Closest<Real> decide_crowd(const BvhStructure& self, Ray<Real> ray, From source, Closest<Real> best,
                                              float limit) {
        const Proposal<Real> proposal = propose(ray, self.bvh.frame, true);
        const QueryRay query = make_query_ray(proposal, self.bvh.frame, source);
        const Double<Real> t_max = best.t;
        Candidates<2> certain;
        const auto keep_or_decide = [&](const HitInterval& interval, std::uint32_t id) {
            if (search == Search::nearest && interval.hi < interval_detail::infinity) {
                limit = lesser(limit, interval.hi);
                certain.add(interval.lo, id, limit);
                if (!certain.overflow) return false;
                certain.overflow = false;
            }
            const Double<Real> t_before = best.t;
            self.decide(ray, source, id, best);
            // no interval starts before 0
            if (best.t < t_before) limit = lesser(limit, greater(to_plain(proposal.limit(best.t)), 0.0F));
            return search == Search::any && best.t < t_max;
        };
        (void)self.template walk_intervals<Real>(source, query, limit, keep_or_decide);
        certain.for_each(limit, [&](std::uint32_t id) { self.decide(ray, source, id, best); });
        return best;
    }
};

template <std::uint32_t kind_set, Decisions decisions = Decisions::in_leaves>
using BvhTracerFor = RayTracer<BvhStructure<kind_set, decisions>>;
using BvhTracer = BvhTracerFor<PrimitiveKinds::all>;

}  // namespace tandem
