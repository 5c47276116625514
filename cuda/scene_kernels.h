/// The render kernels. All are linked from the same code: for a scene, at load, once per backend and cached on disk; or
/// when Tandem is built, for all scenes of a variant.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>

#include "cuda/block_shape.h"
#include "cuda/compiled_variants.h"
#include "cuda/jit_link.h"
#include "cuda/kernel_cache.h"
#include "cuda/kernels.h"
#include "cuda/linked_facts.h"
#include "cuda/loaded_kernel.h"

namespace tandem::cuda {

/// The facts of a scene and a job for the kernel that renders them. Unused facts are left out, so that scenes that
/// differ only in these share a kernel.
[[nodiscard]] LinkedFacts linked_facts(const SceneView& scene, EffectMask effects, const PathLimits& limits,
                                       Sampler sampler = Sampler::random, PixelFilter filter = PixelFilter::box);

/// The input for linking a kernel with these facts; needs no GPU. `architecture`: as in JitInput.
[[nodiscard]] JitInput render_input(Tier tier, Structure structure, const LinkedFacts& facts, int architecture);

/// The kernel that was linked when Tandem was built, with the effects of `variants[variant]`, for scenes with faces
/// (has_faces()) or without: a fat binary for CMAKE_CUDA_ARCHITECTURES. Empty for a tier that TANDEM_COMPILED_TIERS
/// leaves out.
[[nodiscard]] std::span<const std::byte> compiled_code(Tier tier, Structure structure, bool faces, std::size_t variant);

/// The number of blocks on a multiprocessor for a kernel with a queue. The threads of a block wait for each other, so
/// with two blocks one works while the other waits. But then two stages of the code are in use at once, so it pays only
/// for code that is not much larger than the instruction caches. `structure`: the tracer of the kernel; `code_bytes`: 0
/// if not known.
[[nodiscard]] unsigned int queue_blocks(Tier tier, Structure structure, std::size_t code_bytes);

/// Whether to follow the paths of such a kernel in stages (cuda/staged_paths.h). `facts`: those of the scene and the
/// job; `width`, `height`: of the window.
[[nodiscard]] bool renders_in_stages(Tier tier, Structure structure, const LinkedFacts& facts, const SceneView& scene,
                                     std::uint32_t width, std::uint32_t height);

/// The memory of paths in stages. `tier`: of the kernel.
[[nodiscard]] StagedMemory staged_memory(Tier tier);

/// A render kernel on the GPU.
struct SceneKernel {
    LoadedCode code;
    /// Its blocks on a multiprocessor, if its threads take pixels from a queue (cuda/render_thread.h); else 0.
    unsigned int queue_blocks;
    StagedMemory staged;  ///< without paths if it does not follow them in stages
    const char* doing;    ///< as with LoadedCode::launch()
};

class SceneKernels {
  public:
    /// For one GPU. Uses the user's cache (kernel_cache_folder()).
    explicit SceneKernels(int architecture);

    struct Found {
        const SceneKernel* kernel = nullptr;  ///< owned by this; null if none can be linked
        double seconds = 0;                   ///< to link or to fetch it; 0 if it was loaded already
        std::string warning;                  ///< why there is no kernel, or why the cache failed; reported once
    };
    /// Not safe from several threads at once. Throws EnvironmentError if none can be linked and compiled() has none.
    [[nodiscard]] Found find(Tier tier, const DeviceSceneView& scene, const LinkedFacts& facts);

    /// The kernel of compiled_code() that renders this scene; lives as long as this object. Throws as LoadedCode, and
    /// EnvironmentError if the build lacks the tier. Not for several threads at once.
    [[nodiscard]] const SceneKernel& compiled(Tier tier, const DeviceSceneView& scene, std::size_t variant);

  private:
    int architecture_;
    KernelCache cache_;
    bool warned_ = false;
    std::map<std::tuple<Tier, Structure, LinkedFacts>, std::unique_ptr<SceneKernel>> kernels_;
    std::map<std::tuple<Tier, Structure, bool, std::size_t>, std::unique_ptr<SceneKernel>> compiled_;
};

/// Starts a kernel that SceneKernels gave for this scene; it computes the sums of all pixels. `culls_pixels`: as in
/// BackendOptions. `sums`, `radiances` (of radiance_bytes()) and `counters` are in device memory.
void launch_render(const SceneKernel& kernel, const DeviceSceneView& scene, const PixelJob& job, std::uint32_t height,
                   bool culls_pixels, Vec3d* sums, void* radiances, DeviceCounters* counters, cudaStream_t stream);

/// The memory that such a kernel needs for radiances of samples that are not in the sums yet (cuda/shared_queue.h).
[[nodiscard]] std::size_t radiance_bytes(const SceneKernel& kernel, const DeviceSceneView& scene);

}  // namespace tandem::cuda
