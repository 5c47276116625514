/// glTF's rules across properties: versions, the node hierarchy, views within buffers, accessors within views.
#pragma once

#include <cstdint>

#include "tandem/gltf/document.h"

namespace tandem::gltf {

/// Refuses files of another version of glTF, and files that require an extension that Tandem does not render. Works on
/// an unchecked document. Throws InputError.
void check_edition(const Document& document);

/// Rules of check_schema() for objects whose properties are valid. They repair what they can, with a note, and throw a
/// Flaw for the rest.
void check_buffer_view(const Document& document, FlawLog& flaws, Json& view, const std::string& path);
void check_accessor(const Document& document, FlawLog& flaws, Json& accessor, const std::string& path);
void check_camera(const Document& document, FlawLog& flaws, Json& camera, const std::string& path);
void check_image(const Document& document, FlawLog& flaws, Json& image, const std::string& path);
void check_node(const Document& document, FlawLog& flaws, Json& node, const std::string& path);
void check_animation(const Document& document, FlawLog& flaws, Json& animation, const std::string& path);

/// Leaves every node at most one parent, and cuts cycles. Needs check_schema().
void check_hierarchy(Document& document, FlawLog& flaws);

/// Bytes of one component of an accessor, by its componentType.
[[nodiscard]] std::size_t component_bytes(std::uint64_t component_type);

/// Numbers in one element of an accessor, by its type ("VEC3").
[[nodiscard]] std::size_t component_count(const std::string& type);

}  // namespace tandem::gltf
