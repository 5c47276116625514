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

/// A tracer for scenes of instances, or for all with a hierarchy, which counts into `counters`.
template <class Tracer>
Tracer instanced_tracer(const DeviceSceneView& scene, DeviceCounters* counters) {
    return {{scene.instanced, {{scene.scene, counting_bvh(scene, counters)}}, scene.instanced_bvh}};
}

/// Calls f with the tracer that traces many rays best in a scene without instances, and counts into `counters`. Scenes
/// without triangles and quads have tracers of their own, and so have hierarchies of one kind.
template <class F>
auto with_tracer(const DeviceSceneView& scene, DeviceCounters* counters, F f) {
    const bool faces = has_faces(scene.scene);
    switch (structure_of(scene)) {
        case Structure::few:
            return f(scene.few);
        case Structure::loop:
            return faces ? f(LoopTracer{scene.scene}) : f(LoopTracerFor<PrimitiveKinds::bodies>{scene.scene});
        case Structure::bvh:
        case Structure::instanced:
            break;
    }
    const BvhView bvh = counting_bvh(scene, counters);
    constexpr Decisions behind_walk = Decisions::behind_walk;
    const std::uint32_t count = primitive_count(scene.scene);
    if (scene.scene.sphere_count == count) {
        return f(BvhTracerFor<PrimitiveKinds::sphere, behind_walk>{scene.scene, bvh});
    }
    if (scene.scene.triangle_count == count) {
        return f(BvhTracerFor<PrimitiveKinds::triangle, behind_walk>{scene.scene, bvh});
    }
    if (bvh.placed_by_entry != 0) {
        return f(BvhTracerFor<PrimitiveKinds::parallelepiped, behind_walk>{scene.scene, bvh});
    }
    return faces ? f(BvhTracerFor<PrimitiveKinds::all, behind_walk>{scene.scene, bvh})
                 : f(BvhTracerFor<PrimitiveKinds::bodies, behind_walk>{scene.scene, bvh});
}

}  // namespace tandem::cuda
