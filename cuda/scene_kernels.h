/// The render kernels that are specialised for scenes: each is linked once per backend, and cached on disk.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "cuda/jit_link.h"
#include "cuda/kernel_cache.h"
#include "cuda/kernels.h"
#include "cuda/linked_facts.h"
#include "cuda/loaded_kernel.h"

namespace tandem::cuda {

/// The facts of a scene and a job for the kernel that renders them. Unused facts are left out, so that scenes that
/// differ only in these share a kernel.
[[nodiscard]] LinkedFacts linked_facts(const SceneView& scene, EffectMask effects, const PathLimits& limits);

/// The input for linking a kernel with these facts; needs no GPU. `architecture`: as in JitInput.
[[nodiscard]] JitInput render_input(Tier tier, Structure structure, const LinkedFacts& facts, int architecture);

/// A kernel that is linked for a scene.
struct SceneKernel {
    LoadedCode code;
    bool has_queue;  ///< its threads take pixels from a queue (cuda/render_thread.h)
};

class SceneKernels {
  public:
    /// Uses the user's cache (kernel_cache_folder()).
    explicit SceneKernels(int architecture);

    struct Found {
        const SceneKernel* kernel = nullptr;  ///< owned by this; null if none can be linked
        double seconds = 0;                   ///< to link or to fetch it; 0 if it was loaded already
        std::string warning;                  ///< why there is no kernel, or why the cache failed; reported once
    };
    /// Not safe from several threads at once.
    [[nodiscard]] Found find(Tier tier, const DeviceSceneView& scene, const LinkedFacts& facts);

  private:
    int architecture_;
    KernelCache cache_;
    bool warned_ = false;
    std::map<std::tuple<Tier, Structure, LinkedFacts>, std::unique_ptr<SceneKernel>> kernels_;
};

/// Starts a kernel that SceneKernels returned for this scene, like TierKernels::render.
void launch_linked(const SceneKernel& kernel, const DeviceSceneView& scene, const PixelJob& job, std::uint32_t height,
                   Vec3d* sums, DeviceCounters* counters, cudaStream_t stream);

}  // namespace tandem::cuda
