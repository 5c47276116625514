/// Triangle meshes.
#pragma once

#include <string>

#include "tandem/gltf/budget.h"
#include "tandem/gltf/buffers.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// The extension that a file lists to store attributes as integers. It puts nothing into the JSON otherwise.
inline constexpr const char* mesh_quantization = "KHR_mesh_quantization";

/// Does the primitive have triangles that can be drawn? Notes in the report that they are, or why they are not, and
/// which attributes are ignored.
[[nodiscard]] bool has_triangles(const Json& primitive, const std::string& path, ImportReport& report);

/// The triangles of such a primitive: a list, a strip or a fan, with or without indices; positions, and normals and
/// the first texture coordinates where there are some.
///
/// An attribute that cannot be read, or has not as many elements as POSITION, is left out; what triangles_of() and
/// mend() say of corners and numbers holds. Throws a Flaw if positions or indices cannot be read, or no triangle is left.
[[nodiscard]] Mesh read_triangles(const Source& source, const Json& primitive, const std::string& path, Budget& budget,
                                  FlawLog& flaws);

}  // namespace tandem::gltf
