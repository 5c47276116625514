/// The host interface of the CUDA kernels.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "cuda/pair_pace.h"
#include "tandem/kernel/pixel.h"
#include "tandem/kernel/shapes/hit.h"
#include "tandem/kernel/shapes/ray_end.h"
#include "tandem/kernel/shapes/source.h"
#include "tandem/kernel/traversal/bvh_tracer.h"
#include "tandem/kernel/traversal/constant_memory_tracer.h"
#include "tandem/kernel/traversal/instanced_tracer.h"
#include "tandem/kernel/view/scene_view.h"
#include "tandem/render/tiers.h"

namespace tandem::cuda {

/// A scene in device memory.
struct DeviceSceneView {
    SceneView scene;
    BvhView bvh;               ///< without nodes for a scene of few primitives, which are tested one by one
    ConstantMemoryTracer few;  ///< filled for a scene that fits_constant_memory(), without the view of a camera
    CertainScene certain;      ///< for that view
    bool diverges;             ///< even neighbouring rays visit very different numbers of nodes
    InstancedView instanced;   ///< the same scene; without instances in most scenes
    InstancedBvhView instanced_bvh;
};

/// The tracers: how the primitives of a scene are found.
enum class Structure { few, loop, bvh, instanced };
[[nodiscard]] inline Structure structure_of(const DeviceSceneView& view) {
    if (view.instanced.instances != nullptr) return Structure::instanced;
    if (view.bvh.nodes != nullptr) return Structure::bvh;
    return fits_constant_memory(view.scene) ? Structure::few : Structure::loop;
}

struct KernelFacts {
    int registers;
    int local_bytes;   ///< per thread: stack and spills
    double occupancy;  ///< resident warps over the most there can be
};

/// The properties of a render kernel. Throws if CUDA cannot tell them.
[[nodiscard]] KernelFacts kernel_facts(const void* kernel);

/// The number of ray counters: each pixel adds to one of them, the threads of a warp to different ones.
inline constexpr std::size_t ray_counters = 32;

/// The counters of kernels, in device memory.
struct DeviceCounters {
    unsigned long long invalid_samples;
    unsigned long long lost_media;
    unsigned long long rejected_rays;
    unsigned long long stack_overflows;
    unsigned long long rays[ray_counters];
    unsigned int next_in_queue;                        ///< the next pixel, or ray
    std::uint32_t stages[most_paced_multiprocessors];  ///< PairPace's
};

/// The hierarchy of a scene, which counts full stacks into `counters`.
[[nodiscard]] inline BvhView counting_bvh(const DeviceSceneView& scene, DeviceCounters* counters) {
    BvhView bvh = scene.bvh;
    bvh.stack_overflows = &counters->stack_overflows;
    return bvh;
}

/// A TraceJob in device memory. `sources`, `ends` and `wide_t` may be null.
struct DeviceRays {
    const Ray<float>* rays;
    const RaySource* sources;
    const RayEnd* ends;
    Hit* hits;
    double* wide_t;
    DeviceCounters* counters;
    std::size_t count;
    void* candidates;   ///< candidate_bytes for each ray, if may_refill()
    bool are_coherent;  ///< neighbouring rays visit nearly the same nodes
    std::uint32_t row;  ///< rays per row of an image, a multiple of 8; 0: the rays are no image
    std::size_t tiled;  ///< the rays of the rows in whole tiles of 8 x 4
};

/// Whether rays may be traced by two kernels (refill_kernels.h).
[[nodiscard]] inline bool may_refill(const DeviceSceneView& scene, bool are_coherent) {
    return structure_of(scene) == Structure::bvh && (!are_coherent || scene.diverges);
}

/// The size of a ray's candidates between the two kernels that trace incoherent rays.
inline constexpr std::size_t candidate_bytes = 16;

/// The queries of a trace: nearest hits of rays that start in space or on surfaces, or whether shadow rays are blocked.
enum class Ask { nearest, nearest_from_surface, occluded };

[[nodiscard]] inline Ask ask_of(const DeviceRays& rays) {
    if (rays.ends != nullptr) return Ask::occluded;
    return rays.sources != nullptr ? Ask::nearest_from_surface : Ask::nearest;
}

/// Starts tracing the rays.
using TraceLaunch = void(const DeviceSceneView& scene, const DeviceRays& rays, cudaStream_t stream);

// For each query and tier: trace.cu; for scenes of instances: trace_instanced.cu, where fast uses the code of strict.
extern TraceLaunch trace_instanced_strict, trace_instanced_precise;
#define TANDEM_TIER(name, promise) \
    extern TraceLaunch trace_nearest_##name, trace_nearest_from_surface_##name, trace_occluded_##name;
#include "tandem/render/tiers.def"
#undef TANDEM_TIER

[[nodiscard]] inline TraceLaunch& trace_kernels(Structure structure, Tier tier, Ask ask) {
    if (structure == Structure::instanced) {
        return tier == Tier::precise ? trace_instanced_precise : trace_instanced_strict;
    }
    const auto of_query = [ask](TraceLaunch & nearest, TraceLaunch & from_surface, TraceLaunch & occluded) -> auto& {
        if (ask == Ask::nearest) return nearest;
        return ask == Ask::nearest_from_surface ? from_surface : occluded;
    };
    switch (tier) {
#define TANDEM_TIER(name, promise) \
    case Tier::name:               \
        return of_query(trace_nearest_##name, trace_nearest_from_surface_##name, trace_occluded_##name);
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
    }
    return of_query(trace_nearest_strict, trace_nearest_from_surface_strict, trace_occluded_strict);
}

}  // namespace tandem::cuda
