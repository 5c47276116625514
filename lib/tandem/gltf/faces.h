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

/// Leaves out triangles with a vertex that is not below `vertices`, with a note. Throws a Flaw if none is left.
void leave_out_missing_vertices(const Document& document, std::vector<std::uint32_t>& triangles, std::size_t vertices,
                                const std::string& path, FlawLog& flaws);

/// Gives the vertices that triangles have the numbers from 0, in their order, and returns their old numbers.
[[nodiscard]] std::vector<std::uint32_t> renumber_vertices(std::vector<std::uint32_t>& triangles);

/// Leaves out triangles one of whose vertices `is_bad`, and returns how many.
template <class IsBad>
std::size_t remove_triangles(std::vector<std::uint32_t>& triangles, IsBad is_bad) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        if (is_bad(triangles[i]) || is_bad(triangles[i + 1]) || is_bad(triangles[i + 2])) continue;
        for (std::size_t k = 0; k < 3; ++k) triangles[kept++] = triangles[i + k];
    }
    const std::size_t removed = (triangles.size() - kept) / 3;
    triangles.resize(kept);
    return removed;
}

}  // namespace tandem::gltf
