/// The hierarchy of groups of a scene.
#pragma once

#include "cpu/kernels.h"
#include "cpu/make_groups.h"

namespace tandem {

/// Neither copied nor moved, because its view has its address.
class GroupHierarchy {
  public:
    /// `scene`: its arrays outlive the hierarchy. `cut`: as for make_groups(). To be called in a TBB arena. Throws
    /// EnvironmentError if there is not enough memory.
    GroupHierarchy(RTCDevice device, const CpuSceneView& scene, const CutPrimitives& cut)
        : groups_(make_groups(device, scene.scene, cut, scene.frame.padding.least)),
          group_view_(groups_.view()),
          view_(scene) {
        view_.groups = &group_view_;
    }
    GroupHierarchy(const GroupHierarchy&) = delete;
    GroupHierarchy& operator=(const GroupHierarchy&) = delete;
    ~GroupHierarchy() = default;

    /// The scene for kernels that trace single rays.
    [[nodiscard]] const CpuSceneView& view() const { return view_; }

  private:
    PrimitiveGroups groups_;
    GroupView group_view_;
    CpuSceneView view_;
};

}  // namespace tandem
