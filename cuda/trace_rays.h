/// What the kernels that trace rays share.
#pragma once

#include "cuda/block_shape.h"
#include "cuda/launch.h"
#include "cuda/with_tracer.h"

namespace tandem::cuda {

/// The queries of a trace: nearest hits of rays that start in space or on surfaces, or whether shadow rays are blocked.
enum class Ask { nearest, nearest_from_surface, occluded };

/// The source of ray `i` in a search for nearest hits.
template <class Real, Ask ask>
__device__ __forceinline__ auto source_of(const DeviceRays& job, std::size_t i) {
    if constexpr (ask == Ask::nearest) {
        return NoSource{};
    } else {
        return to_real<Real>(job.sources[i]);
    }
}

template <class Real>
__device__ __forceinline__ void write_hit(const DeviceRays& job, std::size_t i, const Closest<Real>& closest) {
    job.hits[i] = to_hit(closest);
    if (job.wide_t != nullptr) job.wide_t[i] = closest.primitive == no_primitive ? 0.0 : to_wide(closest.t);
}

}  // namespace tandem::cuda
