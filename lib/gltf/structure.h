/// What glTF demands across properties: versions, the node hierarchy, views within buffers, accessors within views.
#pragma once

#include "tandem/gltf/document.h"

namespace tandem::gltf {

/// Needs check_schema(). Throws InputError with the JSON path.
void check_structure(const Document& document);

/// Bytes of one component of an accessor, by its componentType.
[[nodiscard]] std::size_t component_bytes(std::uint64_t component_type);

/// Numbers in one element of an accessor, by its type ("VEC3").
[[nodiscard]] std::size_t component_count(const std::string& type);

}  // namespace tandem::gltf
