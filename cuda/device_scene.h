/// A prepared scene in GPU memory.
#pragma once

#include <memory>

#include "cuda/kernels.h"
#include "cuda/memory.h"
#include "cuda/refit_bvh.h"
#include "cuda/stream.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/render/backend.h"

namespace tandem::cuda {

/// Memory for one scene: on the GPU, its arrays and its BVH; and page-locked staging memory on the host, for two pieces
/// of a large one.
struct SceneMemory {
    Buffer<DeviceMemory> device;
    BuildMemory bvh;
    LastingBvh lasting_bvh;  ///< in `bvh`
    Buffer<PinnedMemory> staging;
    Event piece_copied[2];
    Event upload_start;
    Event upload_end;
    Event build_end;
};

class DeviceScene final : public ResidentScene {
  public:
    /// Starts the upload on `stream`. For a scene of many primitives, then builds a BVH, or `refits` the one that is in
    /// the memory.
    DeviceScene(const PreparedScene& scene, Tier tier, std::shared_ptr<SceneMemory> memory, Stream& stream,
                bool refits = true);

    /// Waits for upload and build, to measure their times.
    [[nodiscard]] PhaseTimes load_times() const override;
    [[nodiscard]] const DeviceSceneView& view() const { return view_; }
    [[nodiscard]] const Event& uploaded() const { return memory_->build_end; }
    // From the prepared scene, which is not kept:
    [[nodiscard]] const PreparedCamera& camera() const { return camera_; }
    [[nodiscard]] EffectMask effects() const { return effects_; }
    [[nodiscard]] std::uint64_t dropped_primitives() const { return dropped_primitives_; }
    [[nodiscard]] std::uint64_t dropped_lights() const { return dropped_lights_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    /// The number of nodes of view().bvh; 0 without a BVH.
    [[nodiscard]] std::uint32_t bvh_node_count() const { return bvh_nodes_; }
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
    std::uint32_t bvh_nodes_ = 0;
    std::vector<PrimitiveCopy> copies_;
};

}  // namespace tandem::cuda
