/// The CUDA kernels, seen from the host.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "tandem/bvh/bvh_tracer.h"
#include "tandem/geometry/hit.h"
#include "tandem/integrator/pixel.h"
#include "tandem/scene/scene_view.h"

namespace tandem::cuda {

/// A scene in device memory. Without nodes the primitives are tried one by one.
struct DeviceSceneView {
    SceneView scene;
    BvhView bvh;
};

struct KernelFacts {
    int registers;
    int local_bytes;   ///< per thread: stack and spills
    double occupancy;  ///< resident warps over the most there can be
};

/// Starts the sums of all pixels; `invalid` counts dropped samples. Both in device memory.
void launch_render(const DeviceSceneView& scene, const PixelJob& job, std::uint32_t height, Vec3d* sums,
                   unsigned long long* invalid, cudaStream_t stream);

/// Starts the nearest hits of `count` rays in device memory.
void launch_trace(const DeviceSceneView& scene, const Ray<float>* rays, Hit* hits, std::size_t count,
                  cudaStream_t stream);

/// Of the render kernel that a scene gets.
[[nodiscard]] KernelFacts render_kernel_facts(const DeviceSceneView& scene);

}  // namespace tandem::cuda
