#include "tandem/gltf/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/gltf/animation.h"
#include "tandem/gltf/buffers.h"
#include "tandem/gltf/display.h"
#include "tandem/gltf/environment.h"
#include "tandem/gltf/face_count.h"
#include "tandem/gltf/features.h"
#include "tandem/gltf/geometry.h"
#include "tandem/gltf/lights.h"
#include "tandem/gltf/materials.h"
#include "tandem/gltf/printable.h"
#include "tandem/gltf/schema.h"
#include "tandem/gltf/skins.h"
#include "tandem/gltf/structure.h"
#include "tandem/gltf/textures.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

using gltf::Document;
using gltf::find;
using gltf::find_extension;
using gltf::FlawLog;
using gltf::Json;
using gltf::Source;

Trs read_trs(const Json& node, const std::string& path, FlawLog& flaws) {
    Trs trs;
    const auto vec3 = [](const Json& v) { return Vec3d{v[0].get<double>(), v[1].get<double>(), v[2].get<double>()}; };
    if (const Json* translation = find(node, "translation")) trs.translation = vec3(*translation);
    if (const Json* scale = find(node, "scale")) trs.scale = vec3(*scale);
    if (const Json* q = find(node, "rotation")) {
        trs.rotation = {(*q)[0].get<double>(), (*q)[1].get<double>(), (*q)[2].get<double>(), (*q)[3].get<double>()};
        if (*q == Json{0, 0, 0, 0}) {
            trs.rotation = {};
            flaws.replace("rotation", path + ".rotation",
                          "is (0, 0, 0, 0), which is not a rotation; Tandem uses (0, 0, 0, 1)");
        }
    }
    return trs;
}

/// glTF stores matrices column by column.
Transform read_matrix(const Json& matrix) {
    const auto m = matrix.get<std::vector<double>>();
    return {{{{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}}}, {m[12], m[13], m[14]}};
}

/// The name of the camera or the mesh of a nameless node.
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
    SceneBuilder(const Source& source, ImportReport& report, FlawLog& flaws)
        : source_(source),
          document_(source.document),
          report_(report),
          flaws_(flaws),
          geometry_(source, scene_, report, flaws) {}

    /// Everything but the report.
    ImportResult run() {
        choose_scene();
        number_nodes();
        gltf::check_face_count(source_, node_of_);
        scene_.materials = gltf::read_materials(source_, report_);
        gltf::read_textures(source_, scene_, report_, flaws_);
        const bool has_environment = gltf::read_environment(document_, chosen_, chosen_path_, scene_, report_);
        scene_.display = gltf::read_display(document_, chosen_, chosen_path_, report_);
        scene_.nodes.reserve(node_of_.size());
        for (std::size_t i = 0; i < node_of_.size(); ++i) {
            if (node_of_[i]) scene_.nodes.push_back(read_node(i));
        }
        geometry_.note_unused_shapes();
        gltf::pose_skins(source_, node_of_, geometry_, scene_, report_, flaws_);
        gltf::read_animation(source_, node_of_, scene_, report_, flaws_);
        read_frame_rate();
        gltf::note_length(scene_, report_);
        return {std::move(scene_), {}, std::move(chosen_path_), has_environment};
    }

  private:
    /// The scene that `scene` names, else the first, else all nodes.
    void choose_scene() {
        scene_.name = document_.file.stem().string();
        const std::size_t count = document_.length("scenes");
        if (count == 0) {
            chosen_path_ = "nodes";
            report_.add(Treatment::approximated, "file without scenes", "nodes",
                        "the scene consists of all root nodes");
            return;
        }
        const auto index = document_.json.value("scene", std::size_t{0});
        chosen_ = &document_.json["scenes"][index];
        chosen_path_ = fmt::format("scenes[{}]", index);
        if (count > 1 && find(document_.json, "scene") == nullptr) {
            report_.add(Treatment::approximated, "no default scene", "scenes", "Tandem uses the first one");
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
        const std::size_t count = document_.length("nodes");
        parent_of_.assign(count, Node::no_parent);
        for (std::size_t i = 0; i < count; ++i) {
            for (const Json& child : children_of(i)) {
                parent_of_[child.get<std::size_t>()] = static_cast<std::int32_t>(i);
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
            if (reached[at]) continue;
            reached[at] = true;
            for (const Json& child : children_of(at)) open.push_back(child.get<std::size_t>());
        }
        note_listed_children(reached);
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

    const Json& children_of(std::size_t node) const {
        static const Json none = Json::array();
        const Json* children = find(document_.json["nodes"][node], "children");
        return children == nullptr ? none : *children;
    }

    /// A scene must list only root nodes.
    void note_listed_children(const std::vector<bool>& reached) {
        const Json* roots = chosen_ == nullptr ? nullptr : find(*chosen_, "nodes");
        for (std::size_t k = 0; roots != nullptr && k < roots->size(); ++k) {
            const auto root = (*roots)[k].get<std::size_t>();
            if (parent_of_[root] == Node::no_parent) continue;
            const auto parent = static_cast<std::size_t>(parent_of_[root]);
            flaws_.replace(
                "child listed by the scene", fmt::format("{}.nodes[{}]", chosen_path_, k),
                fmt::format("node {} is a child of node {}; {}", root, parent,
                            reached[parent] ? "Tandem uses it once, below that node"
                                            : "the scene does not reach that node, so Tandem treats it as a root"));
            if (!reached[parent]) parent_of_[root] = Node::no_parent;
        }
    }

    Node read_node(std::size_t index) {
        const Json& json = document_.json["nodes"][index];
        const std::string path = fmt::format("nodes[{}]", index);
        Node node;
        node.name = json.value("name", std::string());
        if (node.name.empty()) node.name = carried_name(document_, json);
        if (parent_of_[index] != Node::no_parent) {
            node.parent = static_cast<std::int32_t>(*node_of_[static_cast<std::size_t>(parent_of_[index])]);
        }
        node.trs = read_trs(json, path, flaws_);
        if (const Json* matrix = find(json, "matrix")) node.matrix = read_matrix(*matrix);
        node.geometry = geometry_.read(index);
        if (const Json* camera = find(json, "camera")) node.camera = read_camera(camera->get<std::size_t>(), path);
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
        const Json& camera = document_.json["cameras"][index];
        const auto type = camera["type"].get<std::string>();
        report_.add(Treatment::rendered, type + " camera", node_path + ".camera",
                    "its height; the width follows from the film's shape");
        Shutter shutter;
        if (const Json* json = find_extension(camera, "TANDEM_camera_shutter")) {
            shutter = read_shutter(*json, index);
        }
        const Json* lens = find_extension(camera, "TANDEM_camera_lens");
        if (type == "perspective") {
            PerspectiveCamera perspective{camera["perspective"]["yfov"].get<double>(), {}, shutter};
            if (lens != nullptr) perspective.lens = read_lens(*lens, index);
            return perspective;
        }
        if (lens != nullptr) {
            report_.add(Treatment::ignored, "TANDEM_camera_lens",
                        fmt::format("cameras[{}].extensions.TANDEM_camera_lens", index),
                        "an orthographic camera has no lens");
        }
        return OrthographicCamera{camera["orthographic"]["ymag"].get<double>(), shutter};
    }

    void read_light(std::size_t index, const std::string& node_path, Node& node) {
        const Json& light = document_.json["extensions"]["KHR_lights_punctual"]["lights"][index];
        if (node.name.empty()) node.name = light.value("name", std::string());
        node.light = gltf::read_light(light, node_path + ".extensions.KHR_lights_punctual", report_);
    }

    /// glTF only has seconds. A scene may set the number of frames per second in its extras.
    void read_frame_rate() {
        const Json* extras = chosen_ == nullptr ? nullptr : find(*chosen_, "extras");
        const Json* rate = extras == nullptr || !extras->is_object() ? nullptr : find(*extras, "frames_per_second");
        const std::string path = chosen_path_ + ".extras.frames_per_second";
        if (rate != nullptr) {
            const double value = rate->is_number() ? rate->get<double>() : 0;
            if (!(value >= 1e-3 && value <= 1e6)) document_.fail(path, "must be a number from 0.001 to 1000000");
            scene_.frames_per_second = value;
            report_.add(Treatment::rendered, "frame rate", path, fmt::format("{} frames per second", value));
        } else if (!scene_.animation.empty()) {
            report_.add(
                Treatment::approximated, "frame rate", "animations[0]",
                fmt::format("glTF has none; Tandem uses {} frames per second{}", scene_.frames_per_second,
                            chosen_ == nullptr ? "; in a file with scenes, extras.frames_per_second of a scene sets it"
                                               : fmt::format(" unless {} says otherwise", path)));
        }
    }

    const Source& source_;
    const Document& document_;
    ImportReport& report_;
    FlawLog& flaws_;
    Scene scene_;
    gltf::GeometryReader geometry_;
    const Json* chosen_ = nullptr;  ///< the scene; null if the file has none
    std::string chosen_path_;
    std::vector<std::int32_t> parent_of_;                ///< by node of the file
    std::vector<std::optional<std::uint32_t>> node_of_;  ///< from node of the file to node of the scene
};

}  // namespace

ImportResult import_gltf(const std::filesystem::path& file) {
    const DefaultFpEnvironment guard;
    ImportReport report;
    FlawLog flaws(report);
    Document document = gltf::read_document(file, flaws);
    gltf::check_edition(document);
    gltf::check_schema(document, flaws);
    gltf::check_hierarchy(document, flaws);
    const Source source = gltf::load_buffers(std::move(document));
    ImportResult result = SceneBuilder(source, report, flaws).run();
    gltf::note_ignored_features(source.document, report);
    result.report = std::move(report);
    const std::vector<Node>& nodes = result.scene.nodes;
    if (std::all_of(nodes.begin(), nodes.end(), [](const Node& node) { return node.geometry.empty(); })) {
        flaws.refuse_lost_geometry();
    }
    const std::vector<std::string> problems = validate(result.scene);
    if (!problems.empty()) {
        const std::string others = problems.size() == 1 ? "" : fmt::format("; and {} more", problems.size() - 1);
        throw InputError(
            fmt::format("{}: the scene is not valid: {}{}", file.string(), gltf::printable(problems[0]), others));
    }
    return result;
}

}  // namespace tandem
