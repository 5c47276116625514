/// The host interface of the CUDA kernels for the planes beside the colour. They are separate from the kernels of the
/// colour.
#pragma once

#include "cuda/kernels.h"
#include "tandem/film/film_planes.h"

namespace tandem::cuda {

/// Starts the planes of first hits among `planes`; they and `counters` are in device memory.
using FirstHitLaunch = void(const DeviceSceneView& scene, const PixelJob& job, std::uint32_t height,
                            const FilmPlanes& planes, DeviceCounters* counters, cudaStream_t stream);

// Defined by first_hits.cu.
#define TANDEM_TIER(name, promise) extern FirstHitLaunch launch_first_hits_##name;
#include "tandem/render/tiers.def"
#undef TANDEM_TIER

[[nodiscard]] inline FirstHitLaunch& first_hits(Structure structure, Tier tier) {
    // in scenes of instances the tier fast has the kernel of strict
    if (structure == Structure::instanced && tier == Tier::fast) return launch_first_hits_strict;
    switch (tier) {
#define TANDEM_TIER(name, promise) \
    case Tier::name:               \
        return launch_first_hits_##name;
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
    }
    return launch_first_hits_strict;
}

/// Starts adding a sample of each pixel to the sums and its square to the squares, all in device memory.
void add_samples(const Vec3d* samples, Vec3d* sums, Vec3d* squares, std::size_t pixels, cudaStream_t stream);

}  // namespace tandem::cuda
