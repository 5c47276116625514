/// The hierarchy of groups of a scene.
#pragma once

#include "cpu/embree_handles.h"
#include "cpu/kernels.h"
#include "cpu/make_groups.h"

namespace tandem {

/// Neither copied nor moved, because Embree and kernels keep its address.
class GroupHierarchy {
  public:
    /// `scene`: its arrays outlive the hierarchy. To be called in a TBB arena. Throws EnvironmentError if there
    /// is not enough memory.
    GroupHierarchy(RTCDevice device, const TierKernels& kernels, const CpuSceneView& scene);
    GroupHierarchy(const GroupHierarchy&) = delete;
    GroupHierarchy& operator=(const GroupHierarchy&) = delete;
    ~GroupHierarchy() = default;

    /// The scene for kernels that trace single rays.
    [[nodiscard]] const CpuSceneView& view() const { return view_; }

  private:
    PrimitiveGroups groups_;
    EmbreeScene embree_;
    GroupView group_view_;
    CpuSceneView view_;
};

}  // namespace tandem
