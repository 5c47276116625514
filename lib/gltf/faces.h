/// The triangles that the corners of a mesh primitive make.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tandem/gltf/document.h"

namespace tandem::gltf {

/// Of a mesh primitive (glTF 2.0, 3.7.2.1). The others have no triangles.
enum Mode : std::uint64_t { triangle_list = 4, triangle_strip = 5, triangle_fan = 6 };

/// Of a primitive; 4 where it has none.
[[nodiscard]] std::uint64_t mode_of(const Json& primitive);

/// "triangle strip", for instance.
[[nodiscard]] const char* mode_name(std::uint64_t mode);

/// The vertices of a primitive in the order in which its mode counts them.
struct Corners {
    std::vector<std::uint32_t> vertices;
    std::optional<std::uint32_t> restart;  ///< the largest value of the type of the indices, if there are any
};

/// Three vertices for each triangle. Corners at the end that make no whole triangle are left out, with a note.
///
/// glTF forbids the largest value of the type of the indices, because GPUs begin the list, strip or fan anew behind it.
/// So do we, with a note. Throws a Flaw if there is no triangle.
[[nodiscard]] std::vector<std::uint32_t> triangles_of(const Document& document, Corners corners, Mode mode,
                                                      const std::string& path, FlawLog& flaws);

}  // namespace tandem::gltf
