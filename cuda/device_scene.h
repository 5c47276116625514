/// A prepared scene in GPU memory.
#pragma once

#include <memory>

#include "cuda/kernels.h"
#include "cuda/memory.h"
#include "cuda/stream.h"
#include "tandem/render/backend.h"

namespace tandem::cuda {

/// Memory for one scene: on the GPU, and page-locked staging memory on the host.
struct SceneMemory {
    Buffer<DeviceMemory> device;
    Buffer<PinnedMemory> staging;
    Event upload_start;
    Event upload_end;
};

class DeviceScene final : public ResidentScene {
  public:
    /// Starts the upload on `stream`. For a scene of many primitives, builds a BVH on the host first.
    DeviceScene(const PreparedScene& scene, Tier tier, std::shared_ptr<SceneMemory> memory, Stream& stream);

    /// Waits for the upload, to measure its time.
    [[nodiscard]] PhaseTimes load_times() const override;
    [[nodiscard]] const DeviceSceneView& view() const { return view_; }
    [[nodiscard]] const Event& uploaded() const { return memory_->upload_end; }
    // From the prepared scene, which is not kept:
    [[nodiscard]] const PreparedCamera& camera() const { return camera_; }
    [[nodiscard]] EffectMask effects() const { return effects_; }
    [[nodiscard]] std::uint64_t dropped_primitives() const { return dropped_primitives_; }
    [[nodiscard]] std::uint64_t dropped_lights() const { return dropped_lights_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    /// Copies that were removed from the scene; empty unless set_copies() was called.
    [[nodiscard]] const std::vector<PrimitiveCopy>& copies() const { return copies_; }
    void set_copies(std::vector<PrimitiveCopy> copies) { copies_ = std::move(copies); }

  private:
    std::shared_ptr<SceneMemory> memory_;
    PreparedCamera camera_;
    EffectMask effects_;
    std::uint64_t dropped_primitives_;
    std::uint64_t dropped_lights_;
    DeviceSceneView view_{};
    std::size_t bytes_ = 0;
    double build_seconds_ = 0;
    std::vector<PrimitiveCopy> copies_;
};

}  // namespace tandem::cuda
