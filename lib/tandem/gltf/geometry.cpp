#include "tandem/gltf/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "tandem/base/large_array.h"
#include "tandem/base/parallel.h"
#include "tandem/gltf/accessor.h"
#include "tandem/gltf/materials.h"
#include "tandem/gltf/triangles.h"
#include "tandem/scene/corner_slots.h"
#include "tandem/scene/mesh_topology.h"

namespace tandem::gltf {

namespace {

constexpr const char* implicit_geometry = "EXT_implicit_geometry";
constexpr const char* implicit_shapes = "KHR_implicit_shapes";
constexpr std::size_t instances_at_once = 1U << 16;

SphereShape sphere_from(const Json& sphere) { return {sphere.value("radius", 0.5)}; }

BoxShape box_from(const Json& box) {
    const Json* size = find(box, "size");
    if (size == nullptr) return {};
    return {{(*size)[0].get<double>(), (*size)[1].get<double>(), (*size)[2].get<double>()}};
}

bool is_none(const Quaternion& q) { return q.x == 0 && q.y == 0 && q.z == 0 && q.w == 0; }

/// The values of one attribute; empty if the file has none.
struct Attribute {
    std::vector<float> values;
    std::size_t width = 0;

    std::size_t count() const { return width == 0 ? 0 : values.size() / width; }
    double at(std::size_t element, std::size_t component) const { return double{values[element * width + component]}; }
    Vec3d vec3(std::size_t i) const { return {at(i, 0), at(i, 1), at(i, 2)}; }
};

}  // namespace

std::vector<Geometry> GeometryReader::read(std::size_t index) {
    const Json& node = source_.document.json["nodes"][index];
    const Json* instancing = find_extension(node, instancing_name);
    const std::string node_path = fmt::format("nodes[{}]", index);
    const std::string instancing_path = fmt::format("{}.extensions.{}", node_path, instancing_name);
    const Json* mesh = find(node, "mesh");
    if (mesh == nullptr) {
        if (instancing != nullptr) {
            report_.add(Treatment::ignored, instancing_name, instancing_path, "the node has no mesh to repeat");
        }
        return {};
    }
    is_skinned_ = find(node, "skin") != nullptr;
    std::vector<Trs> instances;
    if (instancing != nullptr) instances = read_instances(*instancing, instancing_path);

    std::vector<Geometry> result;
    const auto mesh_index = mesh->get<std::size_t>();
    const Json& primitives = source_.document.json["meshes"][mesh_index]["primitives"];
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        if (primitives[i].is_string() || left_out_.contains({mesh_index, i})) continue;
        try {
            if (auto geometry = read_primitive(mesh_index, i)) result.push_back(std::move(*geometry));
        } catch (const Flaw& flaw) {
            flaws_.leave_out("primitive", flaw);
            left_out_.insert({mesh_index, i});
        }
    }
    // there may be millions, so the last primitive takes them without a copy
    for (std::size_t i = 0; i + 1 < result.size(); ++i) result[i].instances = instances;
    if (!result.empty()) result.back().instances = std::move(instances);
    return result;
}

std::optional<Geometry> GeometryReader::read_primitive(std::size_t mesh, std::size_t index) {
    const std::string path = fmt::format("meshes[{}].primitives[{}]", mesh, index);
    const auto shape = read_shape(mesh, index, path);
    if (!shape) return std::nullopt;
    const Json& primitive = source_.document.json["meshes"][mesh]["primitives"][index];
    Geometry geometry{*shape, material_of(primitive, path), {}};
    note_sides(geometry, path);
    return geometry;
}

void GeometryReader::complete_texcoords(Mesh& mesh, const Material& material, const std::string& path) {
    for (const std::uint32_t set : texcoord_sets(material)) {
        if (!mesh.texcoords[set].empty()) continue;
        mesh.texcoords[set].assign(mesh.positions.size(), Vec2f{0, 0});
        report_.add(Treatment::approximated, "texture without coordinates", path + ".attributes",
                    fmt::format("there is no TEXCOORD_{}; the texture's corner texel covers the whole mesh", set));
    }
    const std::uint32_t set = tangent_set(material);
    if (!is_anisotropic(material) || !mesh.texcoords[set].empty()) return;
    report_.add(Treatment::approximated, "anisotropy without coordinates", path + ".attributes",
                fmt::format("there is no TEXCOORD_{}; the direction is arbitrary", set));
}

void GeometryReader::note_sides(const Geometry& geometry, const std::string& path) {
    const auto* shape = std::get_if<MeshShape>(&geometry.shape);
    if (shape == nullptr || scene_.materials[geometry.material].sides != FaceSides::culled) return;
    Mesh& mesh = scene_.meshes[shape->mesh];
    mesh.is_closed = is_closed(mesh);
    if (mesh.is_closed) return;
    report_.add(Treatment::rendered, "single-sided faces", path,
                "rays pass through them from behind, because the material is not doubleSided");
}

std::optional<Shape> GeometryReader::read_shape(std::size_t mesh, std::size_t index, const std::string& path) {
    const Json& primitive = source_.document.json["meshes"][mesh]["primitives"][index];
    const Json* geometry = find_extension(primitive, implicit_geometry);
    const Json* reference = find_extension(primitive, implicit_shapes);
    if (geometry != nullptr && reference != nullptr) {
        source_.document.fail(
            path, fmt::format("has a shape of {} and one of {}; keep only one", implicit_geometry, implicit_shapes));
    }
    std::optional<Shape> shape;
    if (geometry != nullptr) shape = read_implicit_geometry(*geometry, path);
    if (reference != nullptr) shape = read_implicit_shape(*reference, path);
    const bool has_vertices = find(primitive, "attributes") != nullptr && !primitive["attributes"].empty();
    if (!shape && (has_vertices || (geometry == nullptr && reference == nullptr))) {
        return read_mesh(mesh, index, path);
    }
    return shape;
}

std::optional<Shape> GeometryReader::read_mesh(std::size_t mesh, std::size_t index, const std::string& path) {
    const Json& described = source_.document.json["meshes"][mesh];
    const Json& primitive = described["primitives"][index];
    const Json* material = find(primitive, "material");
    const Material plain;
    const Material& used = material == nullptr ? plain : scene_.materials[material->get<std::size_t>()];
    const std::vector<std::uint32_t> sets = corner_sets(used);
    ImportReport notes;
    const bool is_drawn = has_triangles(primitive, sets, is_skinned_, path, notes);
    auto known = mesh_of_.find({mesh, index});
    if (is_drawn && known == mesh_of_.end()) {
        auto [read, elements] = read_triangles(source_, primitive, sets, path, budget_, flaws_, notes);
        read.name = described.value("name", std::string());
        complete_texcoords(read, used, path);
        known = mesh_of_.emplace(Primitive{mesh, index}, static_cast<std::uint32_t>(scene_.meshes.size())).first;
        scene_.meshes.push_back(std::move(read));
        primitives_.push_back({known->first, std::move(elements)});
    }
    report_.add(notes);  // only after the mesh has been read
    if (!is_drawn) return std::nullopt;
    return MeshShape{known->second};
}

std::optional<Shape> GeometryReader::read_implicit_geometry(const Json& geometry, const std::string& path) {
    const std::string where = fmt::format("{}.extensions.{}", path, implicit_geometry);
    std::vector<std::string> kinds;
    for (const auto& [name, value] : geometry.items()) {
        if (name != "extensions" && name != "extras") kinds.push_back(name);
    }
    if (kinds.size() != 1) {
        source_.document.fail(where,
                              fmt::format("has {} shapes; it must have one, such as 'sphere' or 'box'", kinds.size()));
    }
    const std::string feature = fmt::format("{} {}", implicit_geometry, kinds[0]);
    if (kinds[0] == "sphere" || kinds[0] == "box") {
        report_.add(Treatment::rendered, feature, where, "exactly, without triangles");
        if (kinds[0] == "sphere") return sphere_from(geometry["sphere"]);
        return box_from(geometry["box"]);
    }
    report_.add(Treatment::ignored, feature, where, "of the implicit shapes, Tandem renders spheres and boxes");
    return std::nullopt;
}

std::optional<Shape> GeometryReader::read_implicit_shape(const Json& reference, const std::string& path) {
    const auto index = reference["shape"].get<std::size_t>();
    const std::string shape_path = fmt::format("extensions.{}.shapes[{}]", implicit_shapes, index);
    const Json& shape = source_.document.json["extensions"][implicit_shapes]["shapes"][index];
    const auto type = shape["type"].get<std::string>();
    const std::string where = fmt::format("{}.extensions.{}", path, implicit_shapes);
    const std::string feature = fmt::format("{} {}", implicit_shapes, type);
    if (type != "sphere" && type != "box") {
        report_.add(Treatment::ignored, feature, where, "of the implicit shapes, Tandem renders spheres and boxes");
        return std::nullopt;
    }
    if (shape.contains(type == "sphere" ? "box" : "sphere")) {
        source_.document.fail(
            shape_path, fmt::format("is of type '{}' and has the parameters of another type; keep only one", type));
    }
    report_.add(Treatment::rendered, feature, where, "exactly, without triangles");
    const Json parameters = shape.value(type, Json::object());
    if (type == "sphere") return sphere_from(parameters);
    return box_from(parameters);
}

std::vector<Trs> GeometryReader::read_instances(const Json& instancing, const std::string& path) {
    const Json& attributes = instancing["attributes"];
    std::size_t count = 0;
    std::string counted;
    const auto read = [&](const char* name, const char* type, std::size_t width) {
        Attribute attribute;
        const Json* index = find(attributes, name);
        if (index == nullptr) return attribute;
        const std::string where = fmt::format("{}.attributes.{}", path, name);
        const auto accessor = index->get<std::size_t>();
        budget_.spend(source_.document, where, element_count(source_, accessor));
        attribute = {read_accessor(source_, accessor, {type, Components::normalised, "an instance attribute", where}),
                     width};
        if (!counted.empty() && attribute.count() != count) {
            source_.document.fail(where, fmt::format("has {} instances, but {} has {}; make them equal",
                                                     attribute.count(), counted, count));
        }
        count = attribute.count();
        counted = name;
        return attribute;
    };
    const Attribute translation = read("TRANSLATION", "VEC3", 3);
    const Attribute rotation = read("ROTATION", "VEC4", 4);
    const Attribute scale = read("SCALE", "VEC3", 3);
    for (const auto& [name, index] : attributes.items()) {
        if (name == "TRANSLATION" || name == "ROTATION" || name == "SCALE") continue;
        report_.add(Treatment::ignored, fmt::format("instance attribute {}", name),
                    fmt::format("{}.attributes.{}", path, name), "Tandem places instances but does not vary them");
    }
    if (counted.empty()) {
        source_.document.fail(path + ".attributes", "has neither TRANSLATION nor ROTATION nor SCALE; add one");
    }
    report_.add(Treatment::rendered, instancing_name, path, "every instance of the mesh");
    std::vector<Trs> instances;
    make_large(instances, count, count);
    std::vector<std::size_t> without_rotation(chunk_count(count, instances_at_once), 0);
    for_each_chunk(count, instances_at_once, [&](const Chunk& chunk) {
        for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
            if (translation.width != 0) instances[i].translation = translation.vec3(i);
            if (rotation.width != 0) {
                const Quaternion q = {rotation.at(i, 0), rotation.at(i, 1), rotation.at(i, 2), rotation.at(i, 3)};
                if (!is_none(q)) instances[i].rotation = q;
                if (is_none(q)) ++without_rotation[chunk.number];
            }
            if (scale.width != 0) instances[i].scale = scale.vec3(i);
        }
    });
    for (const std::size_t number : without_rotation) {
        for (std::size_t i = 0; i < number; ++i) {
            flaws_.replace("rotation of an instance", path + ".attributes.ROTATION",
                           "is (0, 0, 0, 0), which is not a rotation; Tandem uses (0, 0, 0, 1)");
        }
    }
    return instances;
}

std::uint32_t GeometryReader::material_of(const Json& primitive, const std::string& path) {
    if (const Json* index = find(primitive, "material")) return index->get<std::uint32_t>();
    report_.add(Treatment::approximated, "default material", path,
                "the primitive names no material; Tandem uses white, in Phong's model");
    if (!default_material_) {
        default_material_ = static_cast<std::uint32_t>(scene_.materials.size());
        scene_.materials.push_back(default_material());
    }
    return *default_material_;
}

void GeometryReader::note_unused_shapes() {
    std::vector<bool> used(source_.document.length(std::string("extensions/") + implicit_shapes + "/shapes"), false);
    const Json* meshes = find(source_.document.json, "meshes");
    for (std::size_t m = 0; meshes != nullptr && m < meshes->size(); ++m) {
        if ((*meshes)[m].is_string()) continue;  // left out
        for (const Json& primitive : (*meshes)[m]["primitives"]) {
            if (const Json* reference = find_extension(primitive, implicit_shapes)) {
                used[(*reference)["shape"].get<std::size_t>()] = true;
            }
        }
    }
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i]) continue;
        report_.add(Treatment::ignored, fmt::format("{} shape", implicit_shapes),
                    fmt::format("extensions.{}.shapes[{}]", implicit_shapes, i),
                    "no mesh primitive uses it; shapes for other purposes, such as colliders, are not rendered");
    }
}

}  // namespace tandem::gltf
