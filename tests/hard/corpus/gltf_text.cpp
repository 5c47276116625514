#include "hard/corpus/gltf_text.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

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

Json shape_of(const Shape& shape) {
    if (const auto* sphere = std::get_if<SphereShape>(&shape)) return {{"sphere", {{"radius", sphere->radius}}}};
    if (const auto* box = std::get_if<BoxShape>(&shape)) return {{"box", {{"size", array(box->size)}}}};
    throw std::logic_error("to_gltf() writes no meshes");
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

std::string to_gltf(const Scene& scene) {
    if (!scene.animation.empty()) throw std::logic_error("to_gltf() writes no animation");
    Json document = {{"asset", {{"version", "2.0"}, {"generator", "tandem-bench hard"}}},
                     {"extensionsUsed", {"EXT_implicit_geometry", "TANDEM_materials_phong", "TANDEM_environment"}},
                     {"extensionsRequired", {"EXT_implicit_geometry"}},
                     {"scene", 0}};
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
                primitives.push_back({{"attributes", Json::object()},
                                      {"material", geometry.material},
                                      {"extensions", {{"EXT_implicit_geometry", shape_of(geometry.shape)}}}});
            }
            json["mesh"] = meshes.size();
            meshes.push_back({{"primitives", primitives}});
        }
        nodes.push_back(json);
    }
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
