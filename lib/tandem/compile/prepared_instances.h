/// Meshes of a prepared scene that appear many times and are kept once.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tandem/kernel/traversal/instanced_tracer.h"
#include "tandem/kernel/view/instances.h"

namespace tandem {

struct PreparedScene;

/// As InstancedView has them.
struct PreparedInstances {
    std::vector<MeshInstance> instances;
    std::vector<std::uint32_t> node_of;  ///< by instance: index into Scene::nodes, for messages
    std::vector<InstancedMesh> meshes;
    std::vector<Triangle> faces;
    std::vector<Vec3f> normals;

    [[nodiscard]] bool empty() const { return instances.empty(); }
};

/// The faces of all instances.
[[nodiscard]] std::uint64_t instanced_face_count(const PreparedInstances& instances);

/// The kernels' view; `scene` must outlive it.
[[nodiscard]] InstancedView instanced_view(const PreparedScene& scene);

/// The same scene, with the same ids, without instances: each face is a primitive of its own. `why` completes "faces,
/// which are written out because ...". Throws EnvironmentError if the memory cannot hold it, and InputError if there
/// are too many normals.
[[nodiscard]] PreparedScene written_out(const PreparedScene& scene, const std::string& why);

inline constexpr const char* only_cuda_keeps_instances = "only the backend cuda keeps a mesh once that appears often";

/// The hierarchies of the instances.
struct InstancedBvh {
    std::vector<BvhNode> nodes;
    std::vector<EntryInstance> entry_instances;
    std::vector<EntryFace> entry_faces;
    StructureFrame frame;
};
/// Instances that are exact copies of an earlier one are left out, since the lower id wins; not those with an alpha
/// mask, which a ray passes one by one. Deterministic.
[[nodiscard]] InstancedBvh build_instanced_bvh(const PreparedScene& scene);

/// What is wrong with the hierarchies of instances, as find_bvh_defect(): a face or an instance that is missing or
/// twice, a box that does not contain its child, or a mesh's box that is not padded enough for an instance. For tests.
[[nodiscard]] std::string find_instanced_bvh_defect(const InstancedBvh& bvh, const PreparedScene& scene);

}  // namespace tandem
