/// Reads triangle meshes.
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

/// The extension that a file lists to store attributes as integers. It adds nothing else to the JSON.
inline constexpr const char* mesh_quantization = "KHR_mesh_quantization";

/// The last set of texture coordinates that is read, from TEXCOORD_0 on.
inline constexpr std::uint32_t last_texcoord = 15;

/// The mesh of a primitive.
struct PrimitiveMesh {
    Mesh mesh;
    /// The elements of the primitive's accessors that became vertices of the mesh; empty: all, in their order.
    std::optional<std::vector<std::uint32_t>> elements;
};

/// Whether the primitive has triangles that can be rendered. Notes that they are, or why not, and which attributes are
/// ignored. `sets`: the texture coordinates that its material uses. `is_skinned`: the node has a skin.
[[nodiscard]] bool has_triangles(const Json& primitive, const std::vector<std::uint32_t>& sets, bool is_skinned,
                                 const std::string& path, ImportReport& report);

/// Reads the triangles of such a primitive: a list, a strip or a fan, with or without indices; positions and, if the
/// file has them, normals, the texture coordinates of `sets`, and colours.
///
/// An attribute that cannot be read, or has another number of elements than POSITION, is left out; triangles_of() and
/// mend() treat invalid corners and numbers. Throws a Flaw if positions or indices cannot be read, or if no triangle is
/// left.
[[nodiscard]] PrimitiveMesh read_triangles(const Source& source, const Json& primitive,
                                           const std::vector<std::uint32_t>& sets, const std::string& path,
                                           Budget& budget, FlawLog& flaws, ImportReport& report);

}  // namespace tandem::gltf
