/// Traces rays that may be incoherent, in two kernels. In the first, threads whose rays have ended take new ones, and
/// only candidates are kept; in the second, all threads decide. A decision in the loop that refills would leave the
/// traversal no registers.
/// Source: T. Aila, S. Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009, section 4 (persistent
///         threads, replacement of ended rays).
#pragma once

#include "cuda/trace_rays.h"

namespace tandem::cuda {

/// Whether a tracer defers decisions, so that its traversal can be a kernel of its own.
template <class Tracer>
inline constexpr bool can_refill = false;
template <std::uint32_t kinds>
inline constexpr bool can_refill<BvhTracerFor<kinds, Decisions::behind_walk>> = true;

/// More would overflow the counter of the queue.
inline constexpr std::size_t most_queued_rays = std::size_t{1} << 31;

/// Resident blocks per multiprocessor of find_candidates().
template <class Real, class Tracer>
inline constexpr unsigned int refill_blocks = std::is_same_v<Real, double>                     ? 6
                                              : Tracer::kinds == PrimitiveKinds::triangle      ? 9
                                              : (Tracer::kinds & ~PrimitiveKinds::bodies) != 0 ? 8
                                                                                               : 10;

/// Marks in the first place of FoundCandidates: there were too many candidates; the shadow ray is certainly blocked.
inline constexpr std::uint32_t crowded = no_primitive - 1, blocked = no_primitive - 2;

/// The candidates that a traversal kept, as decide_kept() takes them; no_primitive in unused places.
template <int most>
struct alignas(4 * most) FoundCandidates {
    std::uint32_t id[most];
};
static_assert(sizeof(FoundCandidates<4>) <= candidate_bytes);

/// The stack of a traversal: the lower part, which is used most, in shared memory, the rest in local memory.
class SharedStack {
  public:
    static constexpr int quick = 20;

    /// `mine`: in shared memory; the next entry is a block's threads away.
    __device__ __forceinline__ SharedStack(std::int32_t* mine, std::int32_t* rest)
        : mine_(static_cast<std::uint32_t>(__cvta_generic_to_shared(mine))), rest_(rest) {
        asm volatile("" : "+r"(mine_));  // to be kept: nvcc would compute it again for each access
    }
    __device__ __forceinline__ void set(int i, std::int32_t child) const {
        if (i < quick) {
            asm volatile("st.shared.s32 [%0], %1;" ::"r"(address(i)), "r"(child));
        } else {
            rest_[i - quick] = child;
        }
    }
    __device__ __forceinline__ std::int32_t get(int i) const {
        if (i >= quick) return rest_[i - quick];
        std::int32_t child;
        asm volatile("ld.shared.s32 %0, [%1];" : "=r"(child) : "r"(address(i)));
        return child;
    }

  private:
    __device__ __forceinline__ std::uint32_t address(int i) const {
        return mine_ + static_cast<std::uint32_t>(i) * (block_threads * sizeof(std::int32_t));
    }

    std::uint32_t mine_;
    std::int32_t* rest_;
};

/// The ended rays of a warp are replaced when fewer threads than this are still traversing.
inline constexpr int least_walking = 26;
/// Entries wait until this many threads have one, or until fewer other threads than this are still visiting nodes.
inline constexpr int entry_batch = 6;
/// Nodes that a thread visits before the warp counts its threads again.
inline constexpr int steps_per_count = 2;
/// Rays that a warp takes from the queue at a time.
inline constexpr std::uint32_t queue_chunk = 64;

/// Traverses the hierarchy with all rays, and keeps the candidates of each in job.candidates.
template <class Real, Ask ask, class Tracer>
__global__ void __launch_bounds__(block_threads, refill_blocks<Real, Tracer>)
    find_candidates(const __grid_constant__ Tracer tracer, const __grid_constant__ DeviceRays job) {
    constexpr unsigned int all = 0xFFFFFFFFU;
    constexpr Search search = ask == Ask::occluded ? Search::any : Search::nearest;
    constexpr std::uint32_t is_blocked = 2;  // in Candidates::overflow
    using From = decltype(source_of<Real, ask>(job, 0));
    using Found = FoundCandidates<Tracer::most_candidates>;
    __shared__ std::int32_t quick_stack[SharedStack::quick * block_threads];
    std::int32_t rest[bvh_stack_size - SharedStack::quick];
    const SharedStack stack(quick_stack + threadIdx.x, rest);
    const unsigned int lane = threadIdx.x % 32;
    auto* const found = static_cast<Found*>(job.candidates);
    const auto count = static_cast<std::uint32_t>(job.count);

    bvh_detail::Walk walk = {no_child, no_child, 0};
    QueryRay query{};
    Vec3f inverse_direction{};
    From source = source_of<Real, ask>(job, 0);
    Candidates<Tracer::most_candidates> candidates;
    float limit = 0.0F, enough = 0.0F;
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
        const Ray<float> ray = load_ray(job, index);
        if (!is_traceable(ray)) {
            atomicAdd(&job.counters->rejected_rays, 1ULL);
            return;
        }
        source = source_of<Real, ask>(job, index);
        const Proposal<Real> proposal = tracer.propose(to_real<Real>(ray));
        if (!proposal.active) return;
        if constexpr (search == Search::any) {
            const auto t_max = constant<Double<Real>>(job.ends[index].t);
            limit = to_plain(proposal.limit(t_max));
            enough = to_plain(proposal.start(t_max));
        }
        query = make_query_ray(proposal, tracer.bvh.frame, source);
        inverse_direction = make_node_ray(query.origin, query.direction).inverse_direction;
        walk = bvh_detail::Walk::from_root(stack);
    };
    const auto finish = [&] {
        Found result;
        for (int k = 0; k < Tracer::most_candidates; ++k) {
            result.id[k] = candidates.lo[k] <= limit ? candidates.id[k] : no_primitive;
        }
        if (candidates.overflow != 0 || walk.depth > 0) result.id[0] = crowded;
        if (search == Search::any && candidates.overflow == is_blocked) result.id[0] = blocked;
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
            index = static_cast<std::uint32_t>(ray_at(job, next + rank));
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
#pragma unroll
            for (int step = 0; step < steps_per_count; ++step) {
                if (!walk.is_done() && !walk.is_at_entry()) {
                    const NodeRay node_ray = {query.origin, inverse_direction};
                    walk.template descend<false>(stack, tracer.bvh, node_ray, 0.0F, limit);
                }
            }
            const int waiting = __popc(__ballot_sync(all, walk.is_at_entry()));
            const int moving = __popc(__ballot_sync(all, !walk.is_done() && !walk.is_at_entry()));
            if (waiting >= entry_batch || moving < entry_batch) {
                if (walk.is_at_entry()) {
                    if (tracer.template keep<search, Real>(walk.entry(), source, query, enough, limit, candidates)) {
                        candidates.overflow = is_blocked;
                        walk.at = no_child;
                    } else {
                        walk.pop(stack);
                    }
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
    constexpr Search search = ask == Ask::occluded ? Search::any : Search::nearest;
    Closest<Real> closest = no_hit<Real>();
    if constexpr (search == Search::any) {
        if (first == blocked) return write_shadow(job, i, true);
        closest = closest_starting_at<Real>(constant<Double<Real>>(job.ends[i].t));
    }
    const Double<Real> start = closest.t;
    const auto ray = [&] { return to_real<Real>(load_ray(job, i)); };
    if (first == crowded) [[unlikely]] {
        closest = tracer.template decide_crowd<search>(tracer, ray(), source_of<Real, ask>(job, i), closest, 3e38F);
    } else {
        // Each is read from memory, because indexing registers would move them to memory anyway, and so is the ray for
        // each: in registers it would be spilled, since the rare cases of a decision are calls.
        TANDEM_KEEP_LOOP
        for (int k = 0; k < Tracer::most_candidates; ++k) {
            const std::uint32_t kept = static_cast<const Found*>(job.candidates)[i].id[k];
            if (kept != no_primitive) tracer.decide_kept(ray(), source_of<Real, ask>(job, i), kept, closest);
        }
    }
    if constexpr (search == Search::any) {
        write_shadow(job, i, closest.t < start);
    } else {
        write_hit(job, i, closest);
    }
}

/// Starts both kernels.
template <class Real, Ask ask, class Tracer>
void trace_with_refill(const Tracer& tracer, const DeviceRays& rays, cudaStream_t stream) {
    launch("finding candidates", find_candidates<Real, ask, Tracer>,
           multiprocessor_count() * refill_blocks<Real, Tracer>, block_threads, stream, tracer, rays);
    launch("deciding hits", decide_candidates<Real, ask, Tracer>, blocks_for(rays.count, block_threads), block_threads,
           stream, tracer, rays);
}

}  // namespace tandem::cuda
