#include <fmt/format.h>

#include "tandem/base/error.h"
#include "tandem/base/memory.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {

std::uint64_t instanced_face_count(const PreparedInstances& instances) {
    std::uint64_t count = 0;
    for (const InstancedMesh& mesh : instances.meshes) count += std::uint64_t{mesh.instance_count} * mesh.face_count;
    return count;
}

InstancedView instanced_view(const PreparedScene& scene) {
    const PreparedInstances& all = scene.instances;
    return {view(scene),
            all.instances.data(),
            all.meshes.data(),
            all.faces.data(),
            all.normals.data(),
            static_cast<std::uint32_t>(all.meshes.size()),
            static_cast<std::uint32_t>(primitive_count(scene))};
}

PreparedScene written_out(const PreparedScene& scene, const std::string& why) {
    const PreparedInstances& all = scene.instances;
    const std::uint64_t faces = instanced_face_count(all);
    const std::uint64_t per_face = sizeof(Triangle) + 2 * sizeof(std::uint32_t) + (all.normals.empty() ? 0 : 36);
    require_memory(faces * per_face,
                   fmt::format("the scene of {} faces, which are written out because {},", faces, why));
    if (scene.normals.size() + 3 * faces > no_attributes - 4 && !all.normals.empty()) {
        throw InputError(
            fmt::format("the {} faces of instances have more normals than there are 32-bit indices; they "
                        "are written out because {}",
                        faces, why));
    }
    PreparedScene result = scene;
    result.instances = {};
    const std::size_t all_faces = scene.triangles.size() + faces;
    result.triangles.reserve(all_faces);
    result.material_of.reserve(scene.material_of.size() + faces);
    result.node_of.reserve(scene.material_of.size() + faces);
    for (const InstancedMesh& mesh : all.meshes) {
        for (std::uint32_t i = mesh.first_instance; i < mesh.first_instance + mesh.instance_count; ++i) {
            const MeshInstance& instance = all.instances[i];
            for (std::uint32_t f = mesh.first_face; f < mesh.first_face + mesh.face_count; ++f) {
                const Triangle& of_mesh = all.faces[f];
                Triangle face = placed({instance, of_mesh, mesh.material});
                if (of_mesh.attributes.normals != no_attributes) {
                    face.attributes.normals = static_cast<std::uint32_t>(result.normals.size());
                    for (std::uint32_t k = 0; k < 3; ++k) {
                        result.normals.push_back(
                            place_normal(instance.normal_matrix, all.normals[of_mesh.attributes.normals + k]));
                    }
                }
                result.triangles.push_back(face);
            }
            result.material_of.insert(result.material_of.end(), mesh.face_count, mesh.material);
            result.node_of.insert(result.node_of.end(), mesh.face_count, all.node_of[i]);
        }
    }
    result.copies = find_copies(result);
    return result;
}

}  // namespace tandem
