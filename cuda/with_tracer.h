/// Chooses the tracer that fits a scene, for kernels other than the linked ones (scene_kernels.h). Included by .cu
/// files.
#pragma once

#include <type_traits>

#include "cuda/kernels.h"

namespace tandem::cuda {

/// Blocks per multiprocessor: with 8 a thread has 64 registers, with 6 it has 80, with 4 it has 128. Measured on an
/// H200 (docs/performance/paths.md): fewer blocks do not hide the latency of double precision, and more cause spills.
template <class Real, class Tracer>
inline constexpr unsigned int resident_blocks = [] {
    if (std::is_same_v<Real, double>) return 4;
    const bool faces = (Tracer::kinds & ~PrimitiveKinds::bodies) != 0;
    return faces && !is_fast<Real> ? 6 : 8;
}();

/// The tracer for a scene of Structure::instanced, which counts into `counters`.
inline InstancedTracer instanced_tracer(const DeviceSceneView& scene, DeviceCounters* counters) {
    BvhView bvh = scene.bvh;
    bvh.stack_overflows = &counters->stack_overflows;
    return {{scene.instanced, {{scene.scene, bvh}}, scene.instanced_bvh}};
}

template <class F>
auto with_instanced_tracer(const DeviceSceneView& scene, DeviceCounters* counters, F f) {
    return f(instanced_tracer(scene, counters));
}

/// Calls f with the tracer for a scene without instances, which counts into `counters`. `decisions`: where hierarchies
/// decide. Behind the walk, which is for many rays, scenes without triangles and quads have tracers of their own, and
/// so have hierarchies of one kind.
template <Decisions decisions = Decisions::in_leaves, class F>
auto with_tracer(const DeviceSceneView& scene, DeviceCounters* counters, F f) {
    constexpr bool is_for_many = decisions == Decisions::behind_walk;
    constexpr std::uint32_t all = PrimitiveKinds::all;
    constexpr std::uint32_t bodies = is_for_many ? PrimitiveKinds::bodies : all;
    const bool faces = has_faces(scene.scene);
    switch (structure_of(scene)) {
        case Structure::few:
            return f(scene.few);
        case Structure::loop:
            return faces ? f(LoopTracerFor<all>{scene.scene}) : f(LoopTracerFor<bodies>{scene.scene});
        case Structure::bvh:
        case Structure::instanced:
            break;
    }
    BvhView bvh = scene.bvh;
    bvh.stack_overflows = &counters->stack_overflows;
    if constexpr (is_for_many) {
        constexpr std::uint32_t sphere = PrimitiveKinds::sphere, triangle = PrimitiveKinds::triangle;
        constexpr std::uint32_t parallelepiped = PrimitiveKinds::parallelepiped;
        const std::uint32_t count = primitive_count(scene.scene);
        if (scene.scene.sphere_count == count) return f(BvhTracerFor<sphere, decisions>{scene.scene, bvh});
        if (scene.scene.triangle_count == count) return f(BvhTracerFor<triangle, decisions>{scene.scene, bvh});
        if (bvh.placed_by_entry != 0) return f(BvhTracerFor<parallelepiped, decisions>{scene.scene, bvh});
    }
    return faces ? f(BvhTracerFor<all, decisions>{scene.scene, bvh})
                 : f(BvhTracerFor<bodies, decisions>{scene.scene, bvh});
}

}  // namespace tandem::cuda
