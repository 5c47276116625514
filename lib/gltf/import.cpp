#include "tandem/gltf/import.h"

#include <fmt/format.h>

#include <cstdint>
#include <optional>

#include "tandem/error/error.h"
#include "tandem/gltf/animation.h"
#include "tandem/gltf/buffers.h"
#include "tandem/gltf/display.h"
#include "tandem/gltf/features.h"
#include "tandem/gltf/geometry.h"
#include "tandem/gltf/lights.h"
#include "tandem/gltf/materials.h"
#include "tandem/gltf/model.h"
#include "tandem/gltf/printable.h"
#include "tandem/gltf/schema.h"
#include "tandem/gltf/skins.h"
#include "tandem/gltf/structure.h"
#include "tandem/gltf/textures.h"

namespace tandem {

namespace {

using gltf::Document;
using gltf::find;
using gltf::find_extension;
using gltf::Json;
using gltf::Source;

Trs read_trs(const tinygltf::Node& node) {
    Trs trs;
    const auto vec3 = [](const std::vector<double>& v) { return Vec3d{v[0], v[1], v[2]}; };
    if (!node.translation.empty()) trs.translation = vec3(node.translation);
    if (!node.scale.empty()) trs.scale = vec3(node.scale);
    if (const auto& q = node.rotation; !q.empty()) trs.rotation = {q[0], q[1], q[2], q[3]};
    return trs;
}

/// glTF stores matrices column by column.
Transform read_matrix(const Document& document, const std::vector<double>& m, const std::string& node_path) {
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) {
        document.fail(node_path + ".matrix", "has a last row other than 0, 0, 0, 1; a node's matrix must be affine");
    }
    return {{{{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}}}, {m[12], m[13], m[14]}};
}

/// What an author calls a node that has no name of its own: the name of what it carries.
std::string carried_name(const Document& document, const Json& node) {
    for (const auto& [member, array] : {std::pair{"camera", "cameras"}, std::pair{"mesh", "meshes"}}) {
        const Json* index = find(node, member);
        if (index == nullptr) continue;
        auto name = document.json[array][index->get<std::size_t>()].value("name", std::string());
        if (!name.empty()) return name;
    }
    return {};
}

class SceneBuilder {
  public:
    SceneBuilder(const Source& source, ImportReport& report)
        : source_(source), document_(source.document), report_(report), geometry_(source, scene_, report) {}

    /// Everything but the report.
    ImportResult run() {
        choose_scene();
        number_nodes();
        scene_.materials = gltf::read_materials(source_, report_);
        gltf::read_textures(source_, scene_, report_);
        const auto environment = gltf::read_environment(document_, chosen_, chosen_path_, report_);
        scene_.environment = environment.value_or(Environment{});
        scene_.display = gltf::read_display(document_, chosen_, chosen_path_, report_);
        for (std::size_t i = 0; i < node_of_.size(); ++i) {
            if (node_of_[i]) scene_.nodes.push_back(read_node(i));
        }
        geometry_.note_unused_shapes();
        gltf::pose_skins(source_, node_of_, geometry_, scene_, report_);
        gltf::read_animation(source_, node_of_, scene_, report_);
        read_frame_rate();
        return {std::move(scene_), {}, std::move(chosen_path_), environment.has_value()};
    }

  private:
    /// The scene that `scene` names, else the first, else all nodes.
    void choose_scene() {
        scene_.name = document_.file.stem().string();
        const std::size_t count = document_.length("scenes");
        if (count == 0) {
            chosen_path_ = "nodes";
            report_.add(Treatment::approximated, "file without scenes", "nodes", "all root nodes make up the scene");
            return;
        }
        const auto index = document_.json.value("scene", std::size_t{0});
        chosen_ = &document_.json["scenes"][index];
        chosen_path_ = fmt::format("scenes[{}]", index);
        if (count > 1 && find(document_.json, "scene") == nullptr) {
            report_.add(Treatment::approximated, "no default scene", "scenes", "Tandem takes the first one");
        }
        for (std::size_t i = 0; i < count; ++i) {
            if (i == index) continue;
            report_.add(Treatment::ignored, "further scene", fmt::format("scenes[{}]", i),
                        fmt::format("Tandem renders one scene of a file, here {}", chosen_path_));
        }
        const auto name = chosen_->value("name", std::string());
        if (!name.empty()) scene_.name = name;
    }

    /// Numbers the nodes that the scene reaches, in the order of the file.
    void number_nodes() {
        const std::size_t count = source_.model.nodes.size();
        parent_of_.assign(count, Node::no_parent);
        for (std::size_t i = 0; i < count; ++i) {
            for (const int child : source_.model.nodes[i].children) {
                parent_of_[static_cast<std::size_t>(child)] = static_cast<std::int32_t>(i);
            }
        }
        std::vector<std::size_t> open;
        if (chosen_ == nullptr) {
            for (std::size_t i = 0; i < count; ++i) {
                if (parent_of_[i] == Node::no_parent) open.push_back(i);
            }
        } else if (const Json* roots = find(*chosen_, "nodes")) {
            for (const Json& root : *roots) open.push_back(root.get<std::size_t>());
        }
        std::vector<bool> reached(count, false);
        while (!open.empty()) {
            const std::size_t at = open.back();
            open.pop_back();
            reached[at] = true;
            for (const int child : source_.model.nodes[at].children) open.push_back(static_cast<std::size_t>(child));
        }
        node_of_.assign(count, std::nullopt);
        std::uint32_t next = 0;
        for (std::size_t i = 0; i < count; ++i) {
            if (reached[i]) {
                node_of_[i] = next++;
            } else {
                report_.add(Treatment::ignored, "node outside of the scene", fmt::format("nodes[{}]", i),
                            fmt::format("{} does not reach it", chosen_path_));
            }
        }
    }

    Node read_node(std::size_t index) {
        const tinygltf::Node& read = source_.model.nodes[index];
        const Json& json = document_.json["nodes"][index];
        const std::string path = fmt::format("nodes[{}]", index);
        Node node;
        node.name = read.name.empty() ? carried_name(document_, json) : read.name;
        if (parent_of_[index] != Node::no_parent) {
            node.parent = static_cast<std::int32_t>(*node_of_[static_cast<std::size_t>(parent_of_[index])]);
        }
        node.trs = read_trs(read);
        if (!read.matrix.empty()) node.matrix = read_matrix(document_, read.matrix, path);
        node.geometry = geometry_.read(index);
        if (read.camera >= 0) node.camera = read_camera(static_cast<std::size_t>(read.camera), path);
        if (const Json* light = find_extension(json, "KHR_lights_punctual")) {
            read_light((*light)["light"].get<std::size_t>(), path, node);
        }
        return node;
    }

    Lens read_lens(const Json& json, std::size_t camera) {
        Lens lens;
        lens.aperture_radius = json["apertureRadius"].get<double>();
        lens.focus_distance = json["focusDistance"].get<double>();
        lens.blades = json.value("blades", 0);
        lens.rotation = json.value("rotation", 0.0);
        const std::string path = fmt::format("cameras[{}].extensions.TANDEM_camera_lens", camera);
        if (lens.blades == 1 || lens.blades == 2) document_.fail(path + ".blades", "must be 0 or from 3 to 32");
        report_.add(Treatment::rendered, "TANDEM_camera_lens", path, "a thin lens");
        return lens;
    }

    Shutter read_shutter(const Json& json, std::size_t camera) {
        Shutter shutter;
        shutter.open = json["open"].get<double>();
        shutter.close = json["close"].get<double>();
        shutter.instants = json.value("instants", shutter.instants);
        const std::string path = fmt::format("cameras[{}].extensions.TANDEM_camera_shutter", camera);
        if (shutter.close < shutter.open) document_.fail(path + ".close", "must not be before open");
        report_.add(Treatment::rendered, "TANDEM_camera_shutter", path, "motion blur where something moves");
        return shutter;
    }

    Camera read_camera(std::size_t index, const std::string& node_path) {
        const tinygltf::Camera& camera = source_.model.cameras[index];
        report_.add(Treatment::rendered, camera.type + " camera", node_path + ".camera",
                    "its height; the width follows the film");
        Shutter shutter;
        if (const Json* json = find_extension(document_.json["cameras"][index], "TANDEM_camera_shutter")) {
            shutter = read_shutter(*json, index);
        }
        const Json* lens = find_extension(document_.json["cameras"][index], "TANDEM_camera_lens");
        if (camera.type == "perspective") {
            PerspectiveCamera perspective{camera.perspective.yfov, {}, shutter};
            if (lens != nullptr) perspective.lens = read_lens(*lens, index);
            return perspective;
        }
        if (lens != nullptr) {
            report_.add(Treatment::ignored, "TANDEM_camera_lens",
                        fmt::format("cameras[{}].extensions.TANDEM_camera_lens", index),
                        "an orthographic camera has no lens");
        }
        return OrthographicCamera{camera.orthographic.ymag, shutter};
    }

    void read_light(std::size_t index, const std::string& node_path, Node& node) {
        const Json& light = document_.json["extensions"]["KHR_lights_punctual"]["lights"][index];
        if (node.name.empty()) node.name = light.value("name", std::string());
        node.light = gltf::read_light(document_, light, node_path + ".extensions.KHR_lights_punctual", report_);
    }

    /// glTF knows seconds only. A scene may say how many frames make one in its extras.
    void read_frame_rate() {
        const Json* extras = chosen_ == nullptr ? nullptr : find(*chosen_, "extras");
        const Json* rate = extras == nullptr || !extras->is_object() ? nullptr : find(*extras, "frames_per_second");
        const std::string path = chosen_path_ + ".extras.frames_per_second";
        if (rate != nullptr) {
            const double value = rate->is_number() ? rate->get<double>() : 0;
            if (!(value >= 1e-3 && value <= 1e6)) document_.fail(path, "must be a number from 0.001 to 1000000");
            scene_.frames_per_second = value;
            report_.add(Treatment::rendered, "frame rate", path, fmt::format("{} frames a second", value));
        } else if (!scene_.animation.empty()) {
            report_.add(Treatment::approximated, "frame rate", "animations[0]",
                        fmt::format("glTF has none; Tandem takes {} frames a second unless {} says otherwise",
                                    scene_.frames_per_second, path));
        }
    }

    const Source& source_;
    const Document& document_;
    ImportReport& report_;
    Scene scene_;
    gltf::GeometryReader geometry_;
    const Json* chosen_ = nullptr;  ///< the scene; null if the file has none
    std::string chosen_path_;
    std::vector<std::int32_t> parent_of_;                ///< by node of the file
    std::vector<std::optional<std::uint32_t>> node_of_;  ///< from node of the file to node of the scene
};

}  // namespace

ImportResult import_gltf(const std::filesystem::path& file) {
    Document document = gltf::read_document(file);
    gltf::check_schema(document);
    gltf::check_structure(document);
    const Source source = gltf::load_model(document, gltf::locate_buffers(document));
    ImportReport report;
    ImportResult result = SceneBuilder(source, report).run();
    gltf::note_ignored_features(document, report);
    result.report = std::move(report);
    const std::vector<std::string> problems = validate(result.scene);
    if (!problems.empty()) {
        const std::string others = problems.size() == 1 ? "" : fmt::format("; and {} more", problems.size() - 1);
        throw InputError(
            fmt::format("{}: the scene is not valid: {}{}", file.string(), gltf::printable(problems[0]), others));
    }
    return result;
}

}  // namespace tandem
