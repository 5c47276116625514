/// Builds triangles from the corners of a mesh primitive.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tandem/gltf/document.h"

namespace tandem::gltf {

/// The modes of mesh primitives that have triangles (glTF 2.0, 3.7.2.1).
enum Mode : std::uint64_t { triangle_list = 4, triangle_strip = 5, triangle_fan = 6 };

/// The mode of a primitive; 4 if it has none.
[[nodiscard]] std::uint64_t mode_of(const Json& primitive);

/// For example "triangle strip".
[[nodiscard]] const char* mode_name(std::uint64_t mode);

/// The vertices of a primitive, in the order of its mode.
struct Corners {
    std::vector<std::uint32_t> vertices;
    std::optional<std::uint32_t> restart;  ///< the largest value of the index type, if there are indices
};

/// Three vertices for each triangle. Left-over corners at the end are left out, with a note.
///
/// glTF forbids the largest value of the index type, because GPUs restart the list, strip or fan after it. We do the
/// same, with a note. Throws a Flaw if there is no triangle.
[[nodiscard]] std::vector<std::uint32_t> triangles_of(const Document& document, Corners corners, Mode mode,
                                                      const std::string& path, FlawLog& flaws);

/// Leaves out triangles with a vertex index of `vertices` or more, with a note. Throws a Flaw if none is left.
void leave_out_missing_vertices(const Document& document, std::vector<std::uint32_t>& triangles, std::size_t vertices,
                                const std::string& path, FlawLog& flaws);

/// Renumbers the used vertices from 0, keeping their order, and returns their old numbers.
[[nodiscard]] std::vector<std::uint32_t> renumber_vertices(std::vector<std::uint32_t>& triangles);

/// Leaves out triangles with a vertex that `is_bad`, and returns their number.
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
