#include "cpu/group_hierarchy.h"

namespace tandem {

namespace {

void padded_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& view = *static_cast<const CpuSceneView*>(args->geometryUserPtr);
    Aabb box;
    for (const std::uint32_t id : ids_of_group(*view.groups, args->primID)) {
        if (id != no_primitive) box = merge(box, primitive_bounds(view.scene, id));
    }
    box = pad(box, view.frame.margin);
    *args->bounds_o = {box.lower.x, box.lower.y, box.lower.z, 0, box.upper.x, box.upper.y, box.upper.z, 0};
}

}  // namespace

GroupHierarchy::GroupHierarchy(RTCDevice device, const TierKernels& kernels, const CpuSceneView& scene)
    : groups_(make_groups(device, scene.scene)),
      embree_(rtcNewScene(device)),
      group_view_(groups_.view(embree_.get())),
      view_(scene) {
    view_.groups = &group_view_;
    const EmbreeGeometry geometry = user_geometry(device, &view_, group_count(group_view_));
    rtcSetGeometryBoundsFunction(geometry.get(), padded_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), kernels.intersect_group);
    rtcSetGeometryOccludedFunction(geometry.get(), kernels.occluded_group);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(embree_.get(), geometry.get(), our_primitives);
    rtcCommitScene(embree_.get());
    check_embree(device, "building the hierarchy of groups");
}

}  // namespace tandem
