/// Code that the kernels that trace rays share.
#pragma once

#include "cuda/block_shape.h"
#include "cuda/launch.h"
#include "cuda/with_tracer.h"

namespace tandem::cuda {

/// The source of ray `i`.
template <class Real, Ask ask>
__device__ __forceinline__ auto source_of(const DeviceRays& job, std::size_t i) {
    if constexpr (ask == Ask::nearest) {
        return NoSource{};
    } else if constexpr (ask == Ask::nearest_from_surface) {
        return to_real<Real>(job.sources[i]);
    } else {
        ShadowSource<Real> source;
        if (job.sources != nullptr) static_cast<Source<Real>&>(source) = to_real<Real>(job.sources[i]);
        source.light = job.ends[i].light;
        return source;
    }
}

/// The ray at a place in the order of work. In an image, 32 places are a tile of 8 x 4 rays, because the traversals of
/// these are more alike than those of 32 rays of a row.
__device__ __forceinline__ std::size_t ray_at(const DeviceRays& job, std::size_t place) {
    if (place >= job.tiled) return place;
    const auto tile = static_cast<std::uint32_t>(place / 32), within = static_cast<std::uint32_t>(place % 32);
    const std::uint32_t across = job.row / 8, down = tile / across;
    return std::size_t{down * 4 + within / 8} * job.row + (tile - down * across) * 8 + within % 8;
}

__device__ __forceinline__ Ray<float> load_ray(const DeviceRays& job, std::size_t i) {
    static_assert(sizeof(Ray<float>) == 24);
    const auto* at = reinterpret_cast<const float2*>(job.rays + i);
    const float2 a = __ldg(at), b = __ldg(at + 1), c = __ldg(at + 2);
    return {{a.x, a.y, b.x}, {b.y, c.x, c.y}};
}

__device__ __forceinline__ void write_shadow(const DeviceRays& job, std::size_t i, bool occluded) {
    job.hits[i] = {0.0F, occluded ? some_primitive : no_primitive};
    if (job.wide_t != nullptr) job.wide_t[i] = 0.0;
}

template <class Real>
__device__ __forceinline__ void write_hit(const DeviceRays& job, std::size_t i, const Closest<Real>& closest) {
    job.hits[i] = to_hit(closest);
    if (job.wide_t != nullptr) job.wide_t[i] = closest.primitive == no_primitive ? 0.0 : to_wide(closest.t);
}

}  // namespace tandem::cuda
