/// From an authored mesh to the faces that kernels read.
#pragma once

#include <cstddef>

#include "tandem/compile/prepared_scene.h"
#include "tandem/math/aabb.h"
#include "tandem/scene/corner_slots.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// What place_mesh() made of a mesh.
struct PlacedMesh {
    Aabb bounds;  ///< of all its corners
    std::size_t triangles = 0;
    std::size_t quads = 0;
};

/// Appends the faces of `mesh` (valid, validate()) under world_from_object to the triangles and quads of `scene`, with
/// their normals and the values of `slots`, and counts degenerate ones in dropped_primitives. A set of texture
/// coordinates that the mesh lacks is (0, 0), and colours that it lacks are white.
///
/// Every vertex is transformed once, in double, and rounded once, so that faces that share one share its bits. Areas
/// are judged by the rounded corners, exactly. A quad with one flat half becomes the triangle of the other half. A
/// transform that mirrors turns the corners round, so that front stays front. Normals go by the inverse transpose, in
/// the form that a flattening transform has too. Throws InputError if there are too many corners to number.
PlacedMesh place_mesh(const Mesh& mesh, const Transform& world_from_object, FaceSides sides, const CornerSlots& slots,
                      PreparedScene& scene);

/// The bounds of a placed mesh, but for the rounding of its corners.
[[nodiscard]] Aabb bounds_of(const Mesh& mesh, const Transform& world_from_object);

}  // namespace tandem
