/// Turns an authored mesh into the faces that kernels read.
#pragma once

#include <cstddef>

#include "tandem/compile/prepared_scene.h"
#include "tandem/math/aabb.h"
#include "tandem/scene/corner_slots.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// A mesh of the scene at one place. In world space and double until the render origin is known.
struct PlacedSurface {
    const Mesh* mesh;
    Transform world_from_object;
    std::uint32_t material;
    std::size_t node;
};

/// The result of place_mesh().
struct PlacedMesh {
    Aabb bounds;  ///< of all its corners
    std::size_t triangles = 0;
    std::size_t quads = 0;
};

/// Appends the faces of `mesh` (valid, validate()) under world_from_object to the triangles and quads of `scene`, with
/// their normals and the values of `slots`, and counts degenerate ones in dropped_primitives. A set of texture
/// coordinates that the mesh lacks is (0, 0), and colours that it lacks are white.
///
/// Every vertex is transformed once, in double, and rounded once, so that faces that share it have the same bits. Areas
/// are computed exactly, from the rounded corners. A quad with one degenerate half becomes the triangle of the other
/// half. A mirroring transform reverses the order of the corners, so that fronts stay fronts. Normals are transformed
/// by the inverse transpose, in a form that exists for flattening transforms too (normal_matrix.h). Throws InputError
/// if there are too many corners for 32-bit indices.
PlacedMesh place_mesh(const Mesh& mesh, const Transform& world_from_object, FaceSides sides, const CornerSlots& slots,
                      PreparedScene& scene);

/// Whether the backs of a mesh's faces cannot be seen from outside: it is closed, and no alpha mask opens it.
[[nodiscard]] bool hides_backs(const Mesh& mesh, std::uint32_t material, const PreparedScene& scene);

/// The bounds of a placed mesh, before its corners are rounded.
[[nodiscard]] Aabb bounds_of(const Mesh& mesh, const Transform& world_from_object);

}  // namespace tandem
