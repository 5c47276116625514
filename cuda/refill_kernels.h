/// The tracing of incoherent rays, in two kernels. In the first, threads whose rays have ended take new ones, and only
/// candidates are kept; in the second, all threads decide. With a decision in the loop that refills, the walk would
/// have no registers left.
/// Source: T. Aila, S. Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009, section 4 (persistent
///         threads, replacement of ended rays).
#pragma once

#include "cuda/trace_rays.h"

namespace tandem::cuda {

/// Whether a tracer decides behind its walk, so that the walk can be a kernel of its own.
template <class Tracer>
inline constexpr bool can_refill = false;
template <std::uint32_t kinds>
inline constexpr bool can_refill<BvhTracerFor<kinds, Decisions::behind_walk>> = true;

/// More would overflow the counter of the queue.
inline constexpr std::size_t most_queued_rays = std::size_t{1} << 31;

/// Resident blocks per multiprocessor of find_candidates().
template <class Real, class Tracer>
inline constexpr unsigned int refill_blocks = std::is_same_v<Real, double>                     ? 6
                                              : (Tracer::kinds & ~PrimitiveKinds::bodies) != 0 ? 8
                                                                                               : 10;

/// In the first place of FoundCandidates: there were too many.
inline constexpr std::uint32_t crowded = no_primitive - 1;

/// The ids that a walk found; no_primitive where there is none.
template <int most>
struct alignas(4 * most) FoundCandidates {
    std::uint32_t id[most];
};
static_assert(sizeof(FoundCandidates<4>) <= candidate_bytes);

/// The stack of a walk: what is used most in shared memory, the rest in local memory.
struct SharedStack {
    static constexpr int quick = 20;

    std::int32_t* mine;  ///< in shared memory; the next entry is a block's threads away
    std::int32_t* rest;

    __device__ __forceinline__ void set(int i, std::int32_t child) const {
        if (i < quick) {
            mine[i * static_cast<int>(block_threads)] = child;
        } else {
            rest[i - quick] = child;
        }
    }
    __device__ __forceinline__ std::int32_t get(int i) const {
        return i < quick ? mine[i * static_cast<int>(block_threads)] : rest[i - quick];
    }
};

/// Rays of a warp are replaced when fewer than this walk.
inline constexpr int least_walking = 26;
/// Entries wait until so many threads have one, or hardly any other walks.
inline constexpr int entry_batch = 4;
/// Rays that a warp takes from the queue at a time.
inline constexpr std::uint32_t queue_chunk = 128;

/// Walks with all rays, and keeps the candidates of each in job.candidates.
template <class Real, Ask ask, class Tracer>
__global__ void __launch_bounds__(block_threads, refill_blocks<Real, Tracer>)
    find_candidates(const __grid_constant__ Tracer tracer, const __grid_constant__ DeviceRays job) {
    constexpr unsigned int all = 0xFFFFFFFFU;
    using From = decltype(source_of<Real, ask>(job, 0));
    using Found = FoundCandidates<Tracer::most_candidates>;
    __shared__ std::int32_t quick_stack[SharedStack::quick * block_threads];
    std::int32_t rest[bvh_stack_size - SharedStack::quick];
    const SharedStack stack = {quick_stack + threadIdx.x, rest};
    const unsigned int lane = threadIdx.x % 32;
    auto* const found = static_cast<Found*>(job.candidates);
    const auto count = static_cast<std::uint32_t>(job.count);

    bvh_detail::Walk walk = {no_child, no_child, 0};
    QueryRay query{};
    NodeRay node_ray{};
    From source = source_of<Real, ask>(job, 0);
    Candidates<Tracer::most_candidates> candidates;
    float limit = 0.0F;
    std::uint32_t index = 0;
    bool has_ray = false;
    std::uint32_t next = 0, end = 0;  // of the rays that the warp has taken
    bool queue_has_more = true;

    const auto begin = [&] {
        has_ray = true;
        candidates = Candidates<Tracer::most_candidates>();
        limit = 3e38F;
        walk.at = no_child;
        walk.depth = 0;
        const Ray<float> ray = job.rays[index];
        if (!is_traceable(ray)) {
            atomicAdd(&job.counters->rejected_rays, 1ULL);
            return;
        }
        source = source_of<Real, ask>(job, index);
        const Proposal<Real> proposal = tracer.propose(to_real<Real>(ray));
        if (!proposal.active) return;
        query = make_query_ray(proposal, tracer.bvh.frame, source);
        node_ray = make_node_ray(query.origin, query.direction);
        walk = bvh_detail::Walk::from_root(stack);
    };
    const auto finish = [&] {
        Found result;
        for (int k = 0; k < Tracer::most_candidates; ++k) {
            result.id[k] = candidates.lo[k] <= limit ? candidates.id[k] : no_primitive;
        }
        if (candidates.overflow != 0 || walk.depth > 0) result.id[0] = crowded;
        found[index] = result;
        has_ray = false;
    };

    while (true) {
        if (has_ray && walk.is_done()) finish();
        // Take new rays
        const unsigned int idle = __ballot_sync(all, !has_ray);
        if (next == end && queue_has_more) {
            std::uint32_t first = 0;
            if (lane == 0) first = atomicAdd(&job.counters->next_in_queue, queue_chunk);
            next = __shfl_sync(all, first, 0);
            end = next + queue_chunk < count ? next + queue_chunk : count;
            if (next >= count) {
                queue_has_more = false;
                next = end = 0;
            }
        }
        const unsigned int rank = __popc(idle & ((1U << lane) - 1));
        if (!has_ray && rank < end - next) {
            index = next + rank;
            begin();
        }
        const auto taken = static_cast<std::uint32_t>(__popc(idle));
        next = taken < end - next ? next + taken : end;
        const int walking = __popc(__ballot_sync(all, has_ray && !walk.is_done()));
        const bool can_refill = queue_has_more || next < end;
        if (can_refill && walking < least_walking) continue;
        if (walking == 0) {
            if (__ballot_sync(all, has_ray) == 0) break;
            continue;
        }
        // Walk
        const int least = can_refill ? least_walking : 1;
        do {
            if (!walk.is_done() && !walk.is_at_entry()) {
                walk.template descend<false>(stack, tracer.bvh, node_ray, 0.0F, limit);
            }
            const int waiting = __popc(__ballot_sync(all, walk.is_at_entry()));
            const int moving = __popc(__ballot_sync(all, !walk.is_done() && !walk.is_at_entry()));
            if (waiting >= entry_batch || moving < entry_batch) {
                if (walk.is_at_entry()) {
                    (void)tracer.template keep<Search::nearest, Real>(walk.entry(), source, query, 0.0F, limit,
                                                                      candidates);
                    walk.pop(stack);
                }
            }
        } while (__popc(__ballot_sync(all, !walk.is_done())) >= least);
    }
}

/// Decides about the candidates, one ray a thread.
template <class Real, Ask ask, class Tracer>
__global__ void __launch_bounds__(block_threads, resident_blocks<Real, Tracer>)
    decide_candidates(const __grid_constant__ Tracer tracer, const __grid_constant__ DeviceRays job) {
    const std::size_t i = static_cast<std::size_t>(blockIdx.x) * block_threads + threadIdx.x;
    if (i >= job.count) return;
    using Found = FoundCandidates<Tracer::most_candidates>;
    const std::uint32_t first = static_cast<const Found*>(job.candidates)[i].id[0];
    Closest<Real> closest = no_hit<Real>();
    const Ray<Real> ray = to_real<Real>(job.rays[i]);
    const auto source = source_of<Real, ask>(job, i);
    if (first == crowded) [[unlikely]] {
        closest = tracer.template decide_crowd<Search::nearest>(tracer, ray, source, closest, 3e38F);
    } else {
        // each from memory, because an index into registers would put them there
        TANDEM_KEEP_LOOP
        for (int k = 0; k < Tracer::most_candidates; ++k) {
            const std::uint32_t id = static_cast<const Found*>(job.candidates)[i].id[k];
            if (id != no_primitive) tracer.decide(ray, source, id, closest);
        }
    }
    write_hit(job, i, closest);
}

/// Starts both kernels.
template <class Real, Ask ask, class Tracer>
void trace_with_refill(const Tracer& tracer, const DeviceRays& rays, cudaStream_t stream) {
    const RenderGrid grid = pixel_queue();
    launch("finding candidates", find_candidates<Real, ask, Tracer>, grid.blocks.x * refill_blocks<Real, Tracer>,
           block_threads, stream, tracer, rays);
    launch("deciding hits", decide_candidates<Real, ask, Tracer>, blocks_for(rays.count, block_threads), block_threads,
           stream, tracer, rays);
}

}  // namespace tandem::cuda
