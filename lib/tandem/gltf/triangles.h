/// Triangle meshes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tandem/gltf/budget.h"
#include "tandem/gltf/buffers.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// The extension that a file lists to store attributes as integers. It puts nothing into the JSON otherwise.
inline constexpr const char* mesh_quantization = "KHR_mesh_quantization";

/// Sets of texture coordinates that are read: TEXCOORD_0 up to this one.
inline constexpr std::uint32_t last_texcoord = 15;

/// The mesh of a primitive.
struct PrimitiveMesh {
    Mesh mesh;
    /// Which elements of the primitive's accessors the mesh has as vertices; none: all, in their order.
    std::optional<std::vector<std::uint32_t>> elements;
};

/// Does the primitive have triangles that can be drawn? Notes in the report that they are, or why they are not, and
/// which attributes are ignored. `sets`: of texture coordinates, those that its material uses. `is_skinned`: the node
/// has a skin.
[[nodiscard]] bool has_triangles(const Json& primitive, const std::vector<std::uint32_t>& sets, bool is_skinned,
                                 const std::string& path, ImportReport& report);

/// The triangles of such a primitive: a list, a strip or a fan, with or without indices; positions, and where there are
/// some, normals, the texture coordinates of `sets`, and colours.
///
/// An attribute that cannot be read, or has not as many elements as POSITION, is left out; what triangles_of() and
/// mend() say of corners and numbers holds. Throws a Flaw if positions or indices cannot be read, or no triangle is
/// left.
[[nodiscard]] PrimitiveMesh read_triangles(const Source& source, const Json& primitive,
                                           const std::vector<std::uint32_t>& sets, const std::string& path,
                                           Budget& budget, FlawLog& flaws, ImportReport& report);

}  // namespace tandem::gltf
