#include "tandem/gltf/face_count.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "tandem/gltf/accessor.h"
#include "tandem/gltf/faces.h"
#include "tandem/gltf/geometry.h"

namespace tandem::gltf {

namespace {

constexpr double most_faces = 1e6, faces_per_byte = 0.5;
/// Of a face in the prepared scene, with normals and texture coordinates, and in an acceleration structure.
constexpr double bytes_per_face = 350;
/// A primitive without faces, and a shape, cost time as well.
constexpr double least_faces = 4;

// Counts are below 2^53 and their products may be above 2^64, so they are doubles.

double faces_of(const Source& source, const Json& primitive) {
    const Json* attributes = find(primitive, "attributes");
    const Json* indices = find(primitive, "indices");
    const Json* corners = indices != nullptr || attributes == nullptr ? indices : find(*attributes, "POSITION");
    if (corners == nullptr || primitive.is_string()) return least_faces;
    const auto count = static_cast<double>(element_count(source, corners->get<std::size_t>()));
    const std::uint64_t mode = mode_of(primitive);
    const double faces = mode == triangle_list                            ? count / 3
                         : mode == triangle_strip || mode == triangle_fan ? count - 2
                                                                          : 0;
    return std::max(faces, least_faces);
}

double instances_of(const Source& source, const Json& node) {
    const Json* instancing = find_extension(node, instancing_name);
    if (instancing == nullptr) return 1;
    std::size_t count = 1;
    for (const Json& accessor : (*instancing)["attributes"]) {
        count = std::max(count, element_count(source, accessor.get<std::size_t>()));
    }
    return static_cast<double>(count);
}

}  // namespace

void check_face_count(const Source& source, const std::vector<std::optional<std::uint32_t>>& node_of) {
    const Json& json = source.document.json;
    std::vector<double> faces_of_mesh(source.document.length("meshes"), -1);
    double faces = 0;
    std::size_t shown = 0;
    for (std::size_t i = 0; i < node_of.size(); ++i) {
        const Json* mesh = node_of[i] ? find(json["nodes"][i], "mesh") : nullptr;
        if (mesh == nullptr) continue;
        double& of_mesh = faces_of_mesh[mesh->get<std::size_t>()];
        if (of_mesh < 0) {
            of_mesh = 0;
            for (const Json& primitive : json["meshes"][mesh->get<std::size_t>()]["primitives"]) {
                of_mesh += faces_of(source, primitive);
            }
        }
        faces += of_mesh * instances_of(source, json["nodes"][i]);
        ++shown;
    }
    const auto bytes = static_cast<double>(data_bytes(source));
    const double limit = std::max(most_faces, faces_per_byte * bytes);
    if (faces <= limit) return;
    source.document.refuse(
        "nodes",
        fmt::format("{} of them show what counts as {:.0f} faces in all, and takes {:.1f} GB of memory; a file "
                    "with {:.0f} bytes of data may have {:.0f}, so show fewer",
                    shown, faces, faces * bytes_per_face / 1e9, bytes, limit));
}

}  // namespace tandem::gltf
