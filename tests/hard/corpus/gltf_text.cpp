#include "hard/corpus/gltf_text.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "support/base64.h"
#include "tandem/math/aabb.h"

namespace tandem::hard {

namespace {

using Json = nlohmann::ordered_json;

Json array(const Vec3d& v) { return {v.x, v.y, v.z}; }
Json array(const Vec3f& v) { return {double{v.x}, double{v.y}, double{v.z}}; }

Json camera_of(const Camera& camera) {
    if (const auto* perspective = std::get_if<PerspectiveCamera>(&camera)) {
        return {{"type", "perspective"}, {"perspective", {{"yfov", perspective->yfov}, {"znear", 0.01}}}};
    }
    const double ymag = std::get<OrthographicCamera>(camera).ymag;
    return {{"type", "orthographic"},
            {"orthographic", {{"xmag", ymag}, {"ymag", ymag}, {"znear", 0.0}, {"zfar", 1.0}}}};
}

/// The numbers of all meshes, one buffer view and one accessor for each list.
class Numbers {
  public:
    /// Index of the accessor. `type` as glTF has it; 5126 is float, 5125 an unsigned integer of 32 bits.
    template <class Number>
    std::size_t add(const std::vector<Number>& list, const char* type, int component, std::size_t count) {
        const auto* data = reinterpret_cast<const char*>(list.data());
        views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", list.size() * sizeof(Number)}});
        bytes_.append(data, list.size() * sizeof(Number));
        accessors_.push_back(
            {{"bufferView", views_.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
        return accessors_.size() - 1;
    }
    /// Positions of meshes must say where they lie (glTF 2.0, 3.7.2.1).
    void set_limits(std::size_t accessor, const Vec3f& least, const Vec3f& most) {
        accessors_[accessor]["min"] = array(least);
        accessors_[accessor]["max"] = array(most);
    }
    void write(Json& document) const {
        if (bytes_.empty()) return;
        document["accessors"] = accessors_;
        document["bufferViews"] = views_;
        document["buffers"] = {
            {{"byteLength", bytes_.size()}, {"uri", "data:application/octet-stream;base64," + test::base64(bytes_)}}};
    }

  private:
    std::string bytes_;
    Json views_ = Json::array();
    Json accessors_ = Json::array();
};

Json primitive_of(const Mesh& mesh, Numbers& numbers) {
    if (!mesh.quads.empty() || !mesh.normals.empty() || !mesh.texcoords.empty()) {
        throw std::logic_error("to_gltf() writes positions and triangles");
    }
    Aabb limits;
    for (const Vec3f& p : mesh.positions) limits = merge(limits, Aabb{p, p});
    const std::size_t positions = numbers.add(mesh.positions, "VEC3", 5126, mesh.positions.size());
    numbers.set_limits(positions, limits.lower, limits.upper);
    const std::size_t corners = numbers.add(mesh.triangles, "SCALAR", 5125, mesh.triangles.size());
    return {{"attributes", {{"POSITION", positions}}}, {"indices", corners}};
}

Json primitive_of(const Shape& shape, const Scene& scene, Numbers& numbers) {
    if (const auto* mesh = std::get_if<MeshShape>(&shape)) return primitive_of(scene.meshes[mesh->mesh], numbers);
    Json json = {{"attributes", Json::object()}};
    Json& implicit = json["extensions"]["EXT_implicit_geometry"];
    if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
        implicit["sphere"] = {{"radius", sphere->radius}};
    } else {
        implicit["box"] = {{"size", array(std::get<BoxShape>(shape).size)}};
    }
    return json;
}

void place(Json& json, const Node& node) {
    if (node.matrix) {  // column by column
        const Matrix3 columns = transpose(node.matrix->linear);
        Json matrix = Json::array();
        for (const Vec3d& column : columns.row) matrix.insert(matrix.end(), {column.x, column.y, column.z, 0.0});
        const Vec3d& t = node.matrix->translation;
        matrix.insert(matrix.end(), {t.x, t.y, t.z, 1.0});
        json["matrix"] = matrix;
        return;
    }
    const Quaternion& q = node.trs.rotation;
    json["translation"] = array(node.trs.translation);
    if (q.x != 0 || q.y != 0 || q.z != 0 || q.w != 1) json["rotation"] = {q.x, q.y, q.z, q.w};
    if (node.trs.scale != Vec3d{1, 1, 1}) json["scale"] = array(node.trs.scale);
}

}  // namespace

bool fits_gltf(const Scene& scene) {
    return std::all_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& mesh) { return mesh.quads.empty(); });
}

std::string to_gltf(const Scene& scene) {
    if (!scene.animation.empty()) throw std::logic_error("to_gltf() writes no animation");
    Json document = {{"asset", {{"version", "2.0"}, {"generator", "tandem-bench hard"}}},
                     {"extensionsUsed", {"EXT_implicit_geometry", "TANDEM_materials_phong", "TANDEM_environment"}},
                     {"scene", 0}};
    // Nodes, with their cameras, lights and meshes
    Numbers numbers;
    Json nodes = Json::array(), meshes = Json::array(), cameras = Json::array(), lights = Json::array();
    std::vector<Json> children(scene.nodes.size(), Json::array());
    Json roots = Json::array();
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const std::int32_t parent = scene.nodes[i].parent;
        (parent == Node::no_parent ? roots : children[static_cast<std::size_t>(parent)]).push_back(i);
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        Json json = {{"name", node.name}};
        place(json, node);
        if (!children[i].empty()) json["children"] = children[i];
        if (node.camera) {
            json["camera"] = cameras.size();
            cameras.push_back(camera_of(*node.camera));
        }
        if (node.light) {
            json["extensions"]["KHR_lights_punctual"]["light"] = lights.size();
            lights.push_back({{"type", "point"},
                              {"color", array(node.light->colour)},
                              {"intensity", double{node.light->intensity}}});
        }
        if (!node.geometry.empty()) {
            Json primitives = Json::array();
            for (const Geometry& geometry : node.geometry) {
                if (!geometry.instances.empty()) throw std::logic_error("to_gltf() writes no instances");
                Json primitive = primitive_of(geometry.shape, scene, numbers);
                primitive["material"] = geometry.material;
                primitives.push_back(primitive);
            }
            json["mesh"] = meshes.size();
            meshes.push_back({{"primitives", primitives}});
        }
        nodes.push_back(json);
    }
    // The scene and its lists
    const Environment& sky = scene.environment;
    document["scenes"] = {{{"name", scene.name},
                           {"nodes", roots},
                           {"extensions",
                            {{"TANDEM_environment",
                              {{"gradient", {{"bottom", array(sky.bottom)}, {"top", array(sky.top)}}},
                               {"ambient", array(sky.ambient)}}}}}}};
    document["nodes"] = nodes;
    for (const auto& [name, list] : {std::pair{"meshes", meshes}, std::pair{"cameras", cameras}}) {
        if (!list.empty()) document[name] = list;
    }
    if (!lights.empty()) {
        document["extensionsUsed"].push_back("KHR_lights_punctual");
        document["extensions"]["KHR_lights_punctual"]["lights"] = lights;
    }
    // Buffer and materials
    numbers.write(document);
    document["materials"] = Json::array();
    for (const Material& material : scene.materials) {
        const PhongMaterial& phong = material.phong;
        document["materials"].push_back({{"name", material.name},
                                         {"extensions",
                                          {{"TANDEM_materials_phong",
                                            {{"ambient", array(phong.ambient)},
                                             {"diffuse", array(phong.diffuse)},
                                             {"specular", array(phong.specular)},
                                             {"shininess", double{phong.shininess}}}}}}});
    }
    return document.dump(1) + "\n";
}

}  // namespace tandem::hard
