/// Traces rays through the hierarchy, and decides in its leaves or after the traversal.
#pragma once

#include "tandem/kernel/traversal/bvh_walk.h"
#include "tandem/kernel/traversal/candidates.h"
#include "tandem/kernel/traversal/quick_proposal.h"
#include "tandem/kernel/traversal/ray_tracer.h"
#include "tandem/math/parked.h"

namespace tandem {

namespace bvh_detail {

/// Whether a ray whose stack was full tests every primitive. It cannot be full with a BVH from a builder, whose depth
/// is limited (max_bvh_depth). The GPU traverses no other, so its code does without the test; an overflow is still
/// counted.
inline constexpr bool tries_all = !TANDEM_ON_DEVICE;

/// Tests every primitive: slow but correct. A separate function, so that other rays need no registers for it.
template <std::uint32_t kinds, class Real, class From>
TANDEM_HD_CALL Closest<Real> try_all(SceneView scene, Ray<Real> ray, From source, Closest<Real> best) {
    const FilterRay<Real> filter = make_filter_ray(ray);
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) {
        intersect_primitive<Real, kinds>(scene, id, filter, source, true, best);
    }
    return best;
}

}  // namespace bvh_detail

/// Where a BvhStructure decides. The choice changes no bit.
enum class Decisions {
    in_leaves,    ///< at once
    behind_walk,  ///< after the traversal, by all threads together, for candidates kept by interval (hit_interval.h)
};

/// `kind_set`: as for LoopTracerFor. Rays of the tier fast are decided in leaves in any case.
template <std::uint32_t kind_set, Decisions decisions = Decisions::in_leaves>
struct BvhStructure {
    static constexpr std::uint32_t kinds = kind_set;
    static constexpr bool has_hierarchy = true;
    /// At the edges of a mesh more than two faces are unsure.
    static constexpr int most_candidates = (kinds & PrimitiveKinds::faces) != 0 ? 4 : 2;

    template <class Real>
    static constexpr bool decides_behind = decisions == Decisions::behind_walk && !is_fast<Real>;

    SceneView scene;
    BvhView bvh;

    template <Search search, class Real, class From>
    TANDEM_HD_INLINE void find(const Ray<Real>& ray, const From& source, Closest<Real>& best) const {
        const Proposal<Real> proposal = propose(ray);
        if (!proposal.active) return;
        if constexpr (decides_behind<Real>) {
            find_behind_walk<search>(ray, source, proposal, best);
        } else {
            find_in_leaves<search>(ray, source, proposal, best);
        }
    }

    /// Whether the tracer has find_blocker().
    TANDEM_HD_INLINE static constexpr bool finds_blockers() { return true; }

    /// Whether something blocks a shadow ray at t < t_max, where primitives may let it pass. `hits` decides: MaskedHits
    /// (kernel/masked_hits.h).
    template <class Real, class Hits>
    TANDEM_HD_INLINE bool find_blocker(const Ray<Real>& ray, const Double<Real>& t_max,
                                       const MaskedShadowSource<Real>& source, bool active, Hits& hits) const {
        if (!active) return false;
        const Proposal<Real> proposal = propose(ray);
        if (!proposal.active) return false;
        const float limit = first_limit(proposal, t_max);
        bvh_detail::WalkEnd end{};
        if constexpr (decides_behind<Real>) {
            end = find_blocker_behind_walk(source, proposal, limit, to_plain(proposal.start(t_max)), hits);
        } else {
            const NodeRay node_ray = make_node_ray(to_plain(proposal.ray.origin), to_plain(proposal.ray.direction));
            end = bvh_detail::walk<false>(bvh, node_ray, 0.0F, limit,
                                          [&](std::uint32_t entry) { return hits.block(bvh.entry_ids[entry], true); });
        }
        if (end.stack_was_full) [[unlikely]] {
            bvh_detail::count(bvh.stack_overflows);
            if constexpr (bvh_detail::tries_all) {
                hits.begin_again();
                for (std::uint32_t id = 0; id < primitive_count(scene) && !end.stopped; ++id) {
                    end.stopped = hits.block(id, true);
                }
            }
        }
        return end.stopped;
    }

    template <class Real>
    TANDEM_HD_INLINE Proposal<Real> propose(const Ray<Real>& ray) const {
        if constexpr (decides_behind<Real> && std::is_same_v<Real, float>) {
            return propose_quickly(ray, bvh.frame);
        } else {
            return tandem::propose(ray, bvh.frame, true);
        }
    }

    /// Keeps the primitive of an entry if the ray may hit it at or before `limit`: at first the largest query parameter
    /// of interest, then that of the nearest certain hit. True where a search for any hit may stop: at a certain one
    /// before `enough`.
    template <Search search, class Real, class From>
    TANDEM_HD_INLINE bool keep(std::uint32_t entry, const From& source, const QueryRay& query, float enough,
                               float& limit, Candidates<most_candidates>& candidates) const {
        std::uint32_t id = no_primitive;
        const HitInterval interval = interval_at<Real>(entry, source, query, id);
        if (!(interval.lo <= limit)) return false;
        if (search == Search::any && interval.hi < enough) return true;
        if constexpr (search == Search::nearest) limit = rough_lesser(limit, interval.hi);
        candidates.add(interval.lo, keeps_entries<From> ? entry : id, limit);
        return false;
    }

    /// Whether a candidate is the number of its entry instead of its id. Then the traversal reads no ids.
    template <class From>
    static constexpr bool keeps_entries = std::is_same_v<From, NoSource> &&
                                          (kinds == PrimitiveKinds::sphere || kinds == PrimitiveKinds::parallelepiped);

    /// Calls keep() for all entries that the ray may hit.
    template <Search search, class Real, class From>
    TANDEM_HD_INLINE bvh_detail::WalkEnd collect(const From& source, const QueryRay& query, float enough, float& limit,
                                                 Candidates<most_candidates>& candidates) const {
        constexpr bool may_start_late = std::is_same_v<From, PathSource<Real>>;
        const NodeRay node_ray = make_node_ray(query.origin, query.direction);
        return bvh_detail::walk<may_start_late>(bvh, node_ray, query.start, limit, [&](std::uint32_t entry) {
            return keep<search, Real>(entry, source, query, enough, limit, candidates);
        });
    }

    /// Decides about a candidate that keep() kept.
    template <class Real, class From>
    TANDEM_HD_INLINE void decide_kept(const Ray<Real>& ray, const From& source, std::uint32_t kept,
                                      Closest<Real>& best) const {
        if constexpr (keeps_entries<From> && kinds == PrimitiveKinds::sphere) {
            test_primitive(bvh_detail::load_entry_sphere(bvh, kept), bvh.entry_ids[kept], ray, source, true, best);
        } else {
            decide(ray, source, keeps_entries<From> ? bvh.entry_ids[kept] : kept, best);
        }
    }

    template <class Real, class From>
    TANDEM_HD_INLINE void decide(const Ray<Real>& ray, const From& source, std::uint32_t id,
                                 Closest<Real>& best) const {
        visit_primitive<kinds>(scene, id,
                               [&](const auto& primitive) { test_primitive(primitive, id, ray, source, true, best); });
    }

    /// For the few rays with too many candidates or with a full stack: traverses the hierarchy once more, with the
    /// limit that is known by now. Unsure hits are decided at once, certain ones if there is no place for them; after
    /// another full stack, on the host, all primitives, as in try_all(). Out of line, so that other rays need no
    /// registers for it. The decision is in one place: with three, a kernel for all kinds has 1.4 times the code.
    /// Tests: Bvh.DecidesAboutCrowds.
    template <Search search, class Real, class From>
    TANDEM_HD_CALL Closest<Real> decide_crowd(const BvhStructure& self, Ray<Real> ray, From source, Closest<Real> best,
                                              float limit) {
        constexpr bool may_start_late = std::is_same_v<From, PathSource<Real>>;
        const Proposal<Real> proposal = self.propose(ray);
        const QueryRay query = make_query_ray(proposal, self.bvh.frame, source);
        const NodeRay node_ray = make_node_ray(query.origin, query.direction);
        const Double<Real> t_max = best.t;
        if (search == Search::any) limit = lesser(limit, to_plain(proposal.limit(t_max)));
        bvh_detail::LocalStack stack;
        bvh_detail::Walk at = bvh_detail::Walk::from_root(stack);
        Candidates<2> certain;
        std::uint32_t tried = 0;  // of all primitives, after a full stack
        while (true) {
            std::uint32_t next = no_primitive;
            if (!at.is_done()) {
                if (!at.is_at_entry()) {
                    at.template descend<may_start_late>(stack, self.bvh, node_ray, query.start, limit);
                }
                if (!at.is_at_entry()) continue;
                const std::uint32_t entry = at.entry();
                std::uint32_t id = no_primitive;
                const HitInterval interval = self.template interval_at<Real>(entry, source, query, id);
                at.pop(stack);
                if (!(interval.lo <= limit)) continue;
                next = keeps_entries<From> ? entry : id;
                if (search == Search::nearest && interval.hi < interval_detail::infinity) {
                    limit = lesser(limit, interval.hi);
                    certain.add(interval.lo, next, limit);
                    if (certain.overflow == 0) continue;
                    certain.overflow = 0;
                }
            } else {
                next = certain.take(limit);
                if (next == no_primitive) {
                    if (at.depth <= 0) return best;
                    if (tried == 0) bvh_detail::count(self.bvh.stack_overflows);
                    if (!bvh_detail::tries_all || tried == primitive_count(self.scene)) return best;
                    next = tried++;
                }
            }
            const Double<Real> t_before = best.t;
            self.decide_kept(ray, source, next, best);
            if (search == Search::any && best.t < t_max) return best;
            // no interval starts before 0
            if (best.t < t_before) limit = lesser(limit, greater(to_plain(proposal.limit(best.t)), 0.0F));
        }
    }

  private:
    /// Whether the scene has no other kinds, as far as is known when kernels are compiled or linked.
    TANDEM_HD_INLINE static bool is_only(std::uint32_t kind) {
        return (kinds & kind) != 0 && ((kinds & ~kind) == 0 || !may_have(kinds & ~kind));
    }

    template <Search search, class Real, class From>
    TANDEM_HD_INLINE void find_in_leaves(const Ray<Real>& ray, const From& source, const Proposal<Real>& proposal,
                                         Closest<Real>& best) const {
        const FilterRay<Real> filter = make_filter_ray(ray);
        const NodeRay node_ray = make_node_ray(to_plain(proposal.ray.origin), to_plain(proposal.ray.direction));
        const Double<Real> t_max = best.t;
        // a constant for other rays: with start_for() nvcc spills more, and nearest hits take 6 % longer
        constexpr bool may_start_late = std::is_same_v<From, PathSource<Real>>;
        const float start = may_start_late ? to_plain(proposal.start_for(source)) : 0.0F;
        float limit = first_limit(proposal, t_max);
        const bvh_detail::WalkEnd end =
            bvh_detail::walk<may_start_late>(bvh, node_ray, start, limit, [&](std::uint32_t entry) {
                try_entry(entry, filter, source, proposal, best, limit);
                return search == Search::any && best.t < t_max;
            });
        if (end.stack_was_full) [[unlikely]] {
            bvh_detail::count(bvh.stack_overflows);
            if constexpr (bvh_detail::tries_all) best = bvh_detail::try_all<kinds>(scene, ray, source, best);
        }
    }

    template <class Real, class From>
    TANDEM_HD_INLINE void try_entry(std::uint32_t entry, const FilterRay<Real>& filter, const From& source,
                                    const Proposal<Real>& proposal, Closest<Real>& best, float& limit) const {
        const Sphere around = bvh_detail::load_entry_sphere(bvh, entry);
        if constexpr (!is_fast<Real>) {  // in the tier fast the test costs hardly more than the filter
            if (!may_touch_sphere(filter, around.centre, around.radius)) return;
        }
        const std::uint32_t id = bvh.entry_ids[entry];
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

    template <Search search, class Real, class From>
    TANDEM_HD_INLINE void find_behind_walk(const Ray<Real>& ray, const From& source, const Proposal<Real>& proposal,
                                           Closest<Real>& best) const {
        float limit = first_limit(proposal, best.t);
        const float enough = search == Search::any ? to_plain(proposal.start(best.t)) : 0.0F;
        Candidates<most_candidates> candidates;
        const QueryRay query = make_query_ray(proposal, bvh.frame, source);
        const Parked<Ray<Real>> parked(ray);
        const bvh_detail::WalkEnd end = collect<search, Real>(source, query, enough, limit, candidates);
        const Ray<Real> same_ray = parked.get();
        const Parked<Candidates<most_candidates>> found(candidates);
        const float reached = Parked<float>(limit).get();
        if (search == Search::any && end.stopped) {
            best = {0.0, some_primitive};
        } else if (candidates.overflow != 0 || end.stack_was_full) [[unlikely]] {
            best = decide_crowd<search>(*this, same_ray, source, best, reached);
        } else {
            found.get().for_each(reached, [&](std::uint32_t kept) { decide_kept(same_ray, source, kept, best); });
        }
    }

    /// Decides about candidates whenever there is no place for more.
    template <class Real, class Hits>
    TANDEM_HD_INLINE bvh_detail::WalkEnd find_blocker_behind_walk(const MaskedShadowSource<Real>& source,
                                                                  const Proposal<Real>& proposal, float limit,
                                                                  float enough, Hits& hits) const {
        const QueryRay query = make_query_ray(proposal, bvh.frame, source);
        const NodeRay node_ray = make_node_ray(query.origin, query.direction);
        bvh_detail::LocalStack stack;
        bvh_detail::Walk at = bvh_detail::Walk::from_root(stack);
        do {
            Candidates<most_candidates> candidates;
            bool is_full = false;
            while (!at.is_done() && !is_full) {
                if (!at.is_at_entry()) at.template descend<false>(stack, bvh, node_ray, 0.0F, limit);
                if (!at.is_at_entry()) continue;
                std::uint32_t id = no_primitive;
                const HitInterval interval = interval_at<Real>(at.entry(), source, query, id);
                if (interval.lo <= limit) {
                    if (interval.hi < enough && !may_let_pass<kinds>(scene, id, id == source.light)) {
                        return {true, false};
                    }
                    candidates.add(interval.lo, id, limit);
                    is_full = candidates.is_full(limit);
                }
                at.pop(stack);
            }
            bool blocked = false;
            candidates.for_each(limit, [&](std::uint32_t id) { blocked = blocked || hits.block(id, true); });
            if (blocked) return {true, false};
        } while (!at.is_done());
        return {false, at.depth > 0};
    }

    /// Where the ray hits the primitive of an entry. `id`: of the primitive, unless keeps_entries.
    template <class Real, class From>
    TANDEM_HD_INLINE HitInterval interval_at(std::uint32_t entry, const From& source, const QueryRay& query,
                                             std::uint32_t& id) const {
        if (is_only(PrimitiveKinds::triangle)) {
            const EntryTriangle triangle = bvh_detail::load_entry_triangle(bvh, entry);
            id = triangle.id;
            return hit_interval_from<Real, Triangle>(source, id, query, triangle);
        }
        if constexpr (kinds == PrimitiveKinds::parallelepiped) {
            if constexpr (!keeps_entries<From>) id = bvh.entry_ids[entry];
            const RoughParallelepiped rough = {bvh_detail::load_placement(bvh, entry)};
            return hit_interval_from<Real, Parallelepiped>(source, id, query, rough);
        }
        const SphereLine line(query, bvh_detail::load_entry_sphere(bvh, entry));
        HitInterval interval = certain_miss;
        if (line.misses()) return interval;
        if constexpr (kinds == PrimitiveKinds::sphere && keeps_entries<From>) {
            return hit_interval_from<Real, Sphere>(source, id, query, line);
        }
        id = bvh.entry_ids[entry];
        if (may_have(PrimitiveKinds::sphere) &&
            (!may_have(kinds & ~PrimitiveKinds::sphere) || id < scene.sphere_count)) {
            interval = hit_interval_from<Real, Sphere>(source, id, query, line);
        } else {
            visit_primitive<kinds>(scene, id, [&]<class Primitive>(const Primitive& primitive) {
                if constexpr (std::is_base_of_v<Placement, Primitive>) {
                    using Rough =
                        std::conditional_t<std::is_same_v<Primitive, Ellipsoid>, RoughEllipsoid, RoughParallelepiped>;
                    const std::uint32_t placed =
                        bvh.placed_by_entry != 0 ? entry : id - scene.sphere_count - scene.box_count;
                    const Rough rough = {bvh_detail::load_placement(bvh, placed)};
                    interval = hit_interval_from<Real, Primitive>(source, id, query, rough);
                } else {
                    interval = hit_interval_from<Real, Primitive>(source, id, query, primitive);
                }
            });
        }
        return interval;
    }
};

template <std::uint32_t kind_set, Decisions decisions = Decisions::in_leaves>
using BvhTracerFor = RayTracer<BvhStructure<kind_set, decisions>>;
using BvhTracer = BvhTracerFor<PrimitiveKinds::all>;
using DeferringBvhTracer = BvhTracerFor<PrimitiveKinds::all, Decisions::behind_walk>;

}  // namespace tandem
