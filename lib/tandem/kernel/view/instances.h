/// Meshes that appear many times and are kept once. Their faces are placed when a ray reaches them, by the operations
/// with which place_mesh() places those of other meshes. So keeping a mesh once changes no bit (docs/instances.md).
#pragma once

#include <cstdint>

#include "tandem/kernel/shapes/triangle.h"
#include "tandem/math/transform.h"

namespace tandem {

/// A corner in render space.
TANDEM_HD_INLINE Vec3f place_corner(const Transform& render_from_object, const Vec3f& position) {
    return narrow(transform_point(render_from_object, widen(position)));
}
/// A normal at a corner in render space. `normals`: the normal_matrix() of the transform.
TANDEM_HD_INLINE Vec3f place_normal(const Matrix3& normals, const Vec3f& normal) {
    return narrow(normalize(normals * widen(normal)));
}

/// A mesh at one place.
struct alignas(16) MeshInstance {
    Transform render_from_object;
    Matrix3 normal_matrix;
    std::uint32_t first_id;  ///< the id of its first face
    std::uint32_t unused[1];
};
static_assert(sizeof(MeshInstance) == 176, "no padding: scene_hash() reads all bytes");

/// A mesh with one material, and its instances, which are neighbours: so are their ids.
struct InstancedMesh {
    std::uint32_t first_id;
    std::uint32_t first_instance, instance_count;
    std::uint32_t first_face, face_count;  ///< in InstancedView::faces
    std::uint32_t material;
};

}  // namespace tandem
