#include "tandem/gltf/faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

namespace tandem::gltf {

namespace {

using Run = std::span<const std::uint32_t>;

/// Adds the triangles of a sequence of corners without a primitive restart.
void add_triangles(Run corners, Mode mode, std::vector<std::uint32_t>& triangles) {
    if (mode == triangle_list) {
        triangles.insert(triangles.end(), corners.begin(),
                         corners.end() - static_cast<std::ptrdiff_t>(corners.size() % 3));
        return;
    }
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        if (mode == triangle_fan) {
            triangles.insert(triangles.end(), {corners[i + 1], corners[i + 2], corners[0]});
        } else {  // every other triangle of a strip runs backward
            triangles.insert(triangles.end(), {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
        }
    }
}

}  // namespace

std::uint64_t mode_of(const Json& primitive) { return primitive.value("mode", std::uint64_t{triangle_list}); }

const char* mode_name(std::uint64_t mode) {
    static constexpr const char* names[] = {"points",        "lines",          "line loop",   "line strip",
                                            "triangle mesh", "triangle strip", "triangle fan"};
    return mode < std::size(names) ? names[mode] : "mesh of unknown mode";
}

std::vector<std::uint32_t> triangles_of(const Document& document, Corners corners, Mode mode, const std::string& path,
                                        FlawLog& flaws) {
    const Run all = corners.vertices;
    const auto restart_behind = [&](Run::iterator from) {
        return corners.restart ? std::find(from, all.end(), *corners.restart) : all.end();
    };
    const auto first = restart_behind(all.begin());
    const bool is_whole = mode == triangle_list ? all.size() % 3 == 0 : all.size() >= 3;
    if (first == all.end() && mode == triangle_list && is_whole && !all.empty()) return std::move(corners.vertices);
    std::vector<std::uint32_t> triangles;
    triangles.reserve(mode == triangle_list ? all.size() : 3 * all.size());
    for (auto from = all.begin();;) {
        const auto end = restart_behind(from);
        add_triangles(Run(from, end), mode, triangles);
        if (end == all.end()) break;
        from = end + 1;
    }
    if (first != all.end()) {
        const std::string what = fmt::format("entry {} is {}, which glTF forbids; as on GPUs, the {} restarts after it",
                                             first - all.begin(), *corners.restart, mode_name(mode));
        if (triangles.empty()) document.fail(path + ".indices", what + ", and no triangle is left");
        flaws.replace("primitive restart", path + ".indices", what);
        return triangles;
    }
    const std::string what = fmt::format("has {} corners; a {} needs {}", all.size(), mode_name(mode),
                                         mode == triangle_list ? "a multiple of 3" : "3 or more");
    if (triangles.empty()) document.fail(path, what);
    if (!is_whole) flaws.replace("corners", path, what + ", so Tandem leaves out the last");
    return triangles;
}

void leave_out_missing_vertices(const Document& document, std::vector<std::uint32_t>& triangles, std::size_t vertices,
                                const std::string& path, FlawLog& flaws) {
    const auto is_missing = [vertices](std::uint32_t vertex) { return vertex >= vertices; };
    const auto first = std::find_if(triangles.begin(), triangles.end(), is_missing);
    if (first == triangles.end()) return;
    const std::string where = path + ".indices";
    const std::string what = fmt::format("name vertex {}, but POSITION has {} vertices", *first, vertices);
    const std::size_t all = triangles.size() / 3;
    const std::size_t removed = remove_triangles(triangles, is_missing);
    if (removed == all) document.fail(where, what);
    flaws.replace("triangles", where, fmt::format("{}; Tandem leaves out {} of {} triangles", what, removed, all));
}

std::vector<std::uint32_t> renumber_vertices(std::vector<std::uint32_t>& triangles) {
    std::vector<std::uint32_t> used = triangles;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::uint32_t& vertex : triangles) {
        vertex = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), vertex) - used.begin());
    }
    return used;
}

}  // namespace tandem::gltf
