#include "tandem/gltf/face_count.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "tandem/gltf/accessor.h"
#include "tandem/gltf/faces.h"
#include "tandem/gltf/geometry.h"

namespace tandem::gltf {

namespace {

/// Memory limits: for a small file, and for each byte of data of a larger one.
constexpr double most_scene_bytes = 3.8e8, bytes_per_byte = 190;
/// Memory of a face: in the prepared scene and in an acceleration structure, and for the values at its corners.
constexpr double bytes_per_face = 235, bytes_of_normals = 36, bytes_of_texcoords = 24, bytes_of_colours = 48;
/// Primitives without faces, and shapes, cost time too.
constexpr double least_faces = 4;
/// The memory of an instance of a mesh that is kept once, while a scene is loaded and traced; and the least numbers of
/// instances and of faces for which a mesh is kept once, as in compile/place_instances.cpp.
constexpr double bytes_per_instance = 500, least_instances = 8, least_faces_kept_once = 64;

// Counts are below 2^53 and their products may be above 2^64, so they are doubles.

/// The cost of one use of a mesh or primitive.
struct Cost {
    double faces = 0;
    double bytes = 0;
    bool can_be_kept_once = false;
};

double bytes_per_face_of(const Json& attributes) {
    double bytes = bytes_per_face;
    for (const auto& [name, accessor] : attributes.items()) {
        if (name == "NORMAL") bytes += bytes_of_normals;
        if (name == "COLOR_0") bytes += bytes_of_colours;
        if (name.starts_with("TEXCOORD_")) bytes += bytes_of_texcoords;
    }
    return bytes;
}

/// Whether a primitive's material lets its mesh be kept once.
bool is_plain(const Json& document, const Json& primitive) {
    const Json* number = find(primitive, "material");
    if (number == nullptr) return true;
    const Json& material = document["materials"][number->get<std::size_t>()];
    if (find(material, "emissiveTexture") != nullptr || find(material, "emissiveFactor") != nullptr) return false;
    return find_extension(material, "KHR_materials_unlit") == nullptr;
}

Cost cost_of(const Source& source, const Json& primitive) {
    const Json* attributes = find(primitive, "attributes");
    const Json* position = attributes == nullptr ? nullptr : find(*attributes, "POSITION");
    if (position == nullptr) return {least_faces, least_faces * bytes_per_face};
    const Json* indices = find(primitive, "indices");
    const Json* corners = indices == nullptr ? position : indices;
    const auto count = static_cast<double>(element_count(source, corners->get<std::size_t>()));
    const std::uint64_t mode = mode_of(primitive);
    double faces = least_faces;
    if (mode == triangle_list) faces = std::max(faces, count / 3);
    if (mode == triangle_strip || mode == triangle_fan) faces = std::max(faces, count - 2);
    const bool can_be_kept_once = faces >= least_faces_kept_once && is_plain(source.document.json, primitive);
    return {faces, faces * bytes_per_face_of(*attributes), can_be_kept_once};
}

/// Whether anything in the file may transmit light: then all meshes are written out.
bool transmits(const Json& json) {
    if (!json.contains("materials")) return false;
    for (const Json& material : json["materials"]) {
        if (find_extension(material, "KHR_materials_transmission") != nullptr) return true;
    }
    return false;
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
    std::vector<double> instances_of_mesh(source.document.length("meshes"), 0);
    std::vector<bool> is_skinned(instances_of_mesh.size(), false);
    std::size_t shown = 0;
    for (std::size_t i = 0; i < node_of.size(); ++i) {
        const Json* mesh = node_of[i] ? find(json["nodes"][i], "mesh") : nullptr;
        if (mesh == nullptr) continue;
        instances_of_mesh[mesh->get<std::size_t>()] += instances_of(source, json["nodes"][i]);
        if (find(json["nodes"][i], "skin") != nullptr) is_skinned[mesh->get<std::size_t>()] = true;
        ++shown;
    }
    const bool may_keep = !transmits(json);
    Cost sum;
    for (std::size_t m = 0; m < instances_of_mesh.size(); ++m) {
        const double instances = instances_of_mesh[m];
        if (instances == 0) continue;
        for (const Json& primitive : json["meshes"][m]["primitives"]) {
            const Cost cost = cost_of(source, primitive);
            const bool is_kept_once =
                may_keep && !is_skinned[m] && cost.can_be_kept_once && instances >= least_instances;
            sum.faces += cost.faces * instances;
            sum.bytes += is_kept_once ? cost.bytes + instances * bytes_per_instance : cost.bytes * instances;
        }
    }
    const auto bytes = static_cast<double>(data_bytes(source));
    const double limit = std::max(most_scene_bytes, bytes_per_byte * bytes);
    if (sum.bytes <= limit) return;
    source.document.refuse(
        "nodes", fmt::format("{} of them show the equivalent of {:.0f} faces, which takes {:.2f} GB of memory; a file "
                             "with {:.0f} bytes of data may take {:.2f} GB, so show fewer",
                             shown, sum.faces, sum.bytes / 1e9, bytes, limit / 1e9));
}

}  // namespace tandem::gltf
