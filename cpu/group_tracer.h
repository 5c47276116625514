/// Traces rays one by one through the hierarchy of groups, several at a time.
#pragma once

#include "cpu/group_query.h"
#include "cpu/group_walk.h"
#include "cpu/kernels/called_tracer.h"
#include "tandem/kernel/traversal/quick_proposal.h"

namespace tandem {

/// The traversal of one ray. `Isa`: the instruction set, which Real does not determine.
template <Search search, class Real, class Isa>
class GroupRay {
  public:
    /// Ray i of a batch. False if it cannot hit anything.
    TANDEM_HD_INLINE bool start(const CpuSceneView& view, const RayBatch<Real>& batch, int i) {
        const Ray<Real>& ray = batch.ray[i];
        const Double<Real>& t_max = batch.t_max[i];
        const QuerySource<Real>& source = *batch.source[i];
        query_.best = search == Search::any ? closest_starting_at<Real>(t_max) : no_hit<Real>();
        query_.limit = 3e38F;
        if (!batch.active[i]) return false;
        if constexpr (std::is_same_v<Real, float>) {
            query_.proposal = propose_quickly(ray, view.frame);
        } else {
            query_.proposal = propose(ray, view.frame, true);
        }
        if (!query_.proposal.active) return false;
        float from = 0.0F;
        if constexpr (search == Search::any) {
            query_.limit = to_plain(query_.proposal.limit(t_max));
            if (!(query_.limit >= 0)) return false;
            query_.enough = to_plain(query_.proposal.start(t_max));
        } else {
            from = to_plain(query_.proposal.start_for(source));
        }
        if constexpr (!is_fast<Real>) {
            const PathSource<Real>& path = source;
            query_.interval_ray = make_query_ray(query_.proposal, view.frame, path);
        }
        query_.ray = &ray;
        query_.source = &source;
        query_.filter = in_all_lanes<typename GroupQuery<Real, Isa>::Lane>(make_filter_ray(ray));
        const auto& ray_to = query_.proposal.ray;
        walk_.start({to_plain(ray_to.origin), to_plain(ray_to.direction)}, from, view.groups->root);
        return true;
    }

    /// Visits one node or group. False at the end of the traversal.
    TANDEM_HD_INLINE bool advance(const CpuSceneView& view) {
        const std::uint32_t child = walk_.at();
        if ((child & group_bit) == 0) {
            return walk_.enter(view.groups->nodes[child], query_.limit);
        }
        if (query_.template test<search>(view, child & ~group_bit)) {
            is_occluded_ = true;
            return false;
        }
        return walk_.next(query_.limit);
    }

    /// Loads what advance() visits next.
    TANDEM_HD_INLINE void prefetch(const GroupView& groups) const {
        const std::uint32_t child = walk_.at();
        if ((child & group_bit) == 0) {
            prefetch_lines(groups.nodes[child]);
        } else {
            visit_group(groups, child & ~group_bit, [](const auto& group) { prefetch_lines(group); });
        }
    }

    /// After the last advance().
    TANDEM_HD_INLINE const Closest<Real>& closest(const CpuSceneView& view) {
        query_.decide_candidates(view);
        return query_.best;
    }
    TANDEM_HD_INLINE bool occluded(const CpuSceneView& view, const Double<Real>& t_max) {
        return is_occluded_ || closest(view).t < t_max;
    }

  private:
    template <class T>
    TANDEM_HD_INLINE static void prefetch_lines(const T& item) {
        constexpr std::size_t line = 64;
        for (std::size_t at = 0; at < sizeof(T); at += line) {
            __builtin_prefetch(reinterpret_cast<const char*>(&item) + at);
        }
    }

    GroupQuery<Real, Isa> query_;
    GroupWalk<Isa> walk_;
    bool is_occluded_ = false;
};

/// Nearest hits, or whether shadow rays are blocked, for all rays of a batch. Memory is loaded for one ray while others
/// advance: after each visit of a node or group, the next one of the same ray is prefetched, and another ray continues.
template <Search search, class Isa, class Real, class Finish>
TANDEM_HD_INLINE void trace_groups(const CpuSceneView& view, const RayBatch<Real>& batch, const Finish& finish) {
    GroupRay<search, Real, Isa> rays[RayBatch<Real>::most];
    std::uint8_t on_the_way[RayBatch<Real>::most];
    int count = 0;
    for (int i = 0; i < batch.count; ++i) {
        if (rays[i].start(view, batch, i)) {
            on_the_way[count++] = static_cast<std::uint8_t>(i);
        } else {
            finish(i, rays[i]);
        }
    }
    while (count > 0) {
        for (int k = 0; k < count;) {
            const int i = on_the_way[k];
            if (rays[i].advance(view)) {
                rays[i].prefetch(*view.groups);
                ++k;
            } else {
                finish(i, rays[i]);
                on_the_way[k] = on_the_way[--count];
            }
        }
    }
}

}  // namespace tandem
