/// From an author's mesh to the faces that kernels read.
#pragma once

#include <cstddef>

#include "tandem/math/aabb.h"
#include "tandem/scene/prepared_scene.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// What place_mesh() made of a mesh.
struct PlacedMesh {
    Aabb bounds;  ///< of all its corners
    std::size_t triangles = 0;
    std::size_t quads = 0;
};

/// Appends the faces of `mesh` (valid, validate()) under world_from_object to the triangles and quads of `scene`, with
/// their normals and texture coordinates, and counts those without area in dropped_primitives.
///
/// Every vertex is transformed once, in double, and rounded once, so that faces that share one share its bits. Areas
/// are judged by the rounded corners, exactly. A quad with one flat half becomes the triangle of the other half. A
/// transform that mirrors turns the corners round, so that front stays front. Normals go by the inverse transpose, in
/// the form that a flattening transform has too. Throws InputError if there are too many corners to number.
PlacedMesh place_mesh(const Mesh& mesh, const Transform& world_from_object, bool double_sided, PreparedScene& scene);

}  // namespace tandem
