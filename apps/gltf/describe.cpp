#include "apps/gltf/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "tandem/base/error.h"
#include "tandem/compile/derive.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/effects/names.h"

namespace tandem {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t most_prepared_frames = 240;
/// The text lists at most this many nodes, materials and problems, and counts the others.
constexpr std::size_t most_lines = 24;

/// Indexed by the alternative in Shape.
constexpr const char* shape_names[] = {"spheres", "boxes", "meshes"};
static_assert(std::size(shape_names) == std::variant_size_v<Shape>);

Json colour(const Vec3f& c) { return Json::array({c.x, c.y, c.z}); }

Json describe_nodes(const Scene& scene) {
    Json nodes = Json::array();
    std::set<std::uint32_t> animated;
    for (const AnimationChannel& channel : scene.animation) animated.insert(channel.node);
    for (std::uint32_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        Json row = {{"name", node.name}};
        if (node.parent != Node::no_parent) row["parent"] = node.parent;
        std::map<const char*, std::size_t> shapes;
        for (const Geometry& geometry : node.geometry) {
            shapes[shape_names[geometry.shape.index()]] += std::max<std::size_t>(1, geometry.instances.size());
        }
        for (const char* name : shape_names) {
            if (shapes[name] > 0) row[name] = shapes[name];
        }
        if (node.camera) row["camera"] = true;
        if (node.light) row["light"] = true;
        if (animated.contains(i)) row["animated"] = true;
        nodes.push_back(std::move(row));
    }
    return nodes;
}

Json describe_cameras(const Scene& scene) {
    Json cameras = Json::array();
    for (const Node& node : scene.nodes) {
        if (!node.camera) continue;
        Json camera = {{"node", node.name}};
        if (const auto* perspective = std::get_if<PerspectiveCamera>(&*node.camera)) {
            camera.update({{"type", "perspective"},
                           {"yfov_radians", perspective->yfov},
                           {"aperture_radius_metres", perspective->lens.aperture_radius},
                           {"focus_distance_metres", perspective->lens.focus_distance}});
        } else {
            const double ymag = std::get<OrthographicCamera>(*node.camera).ymag;
            camera.update({{"type", "orthographic"}, {"ymag_metres", ymag}});
        }
        const Shutter& shutter = shutter_of(*node.camera);
        camera["shutter_seconds"] = {shutter.open, shutter.close};
        camera["shutter_instants"] = shutter.instants;
        cameras.push_back(std::move(camera));
    }
    return cameras;
}

Json describe_lights(const Scene& scene) {
    Json lights = Json::array();
    for (const Node& node : scene.nodes) {
        if (!node.light) continue;
        static constexpr const char* types[] = {"point", "spot", "directional"};
        lights.push_back({{"node", node.name},
                          {"type", types[static_cast<std::size_t>(node.light->kind)]},
                          {"colour", colour(node.light->colour)},
                          {"intensity", node.light->intensity},
                          {"falls_off", node.light->inverse_square},
                          {"casts_shadows", node.light->casts_shadows}});
    }
    return lights;
}

/// The numbers of an optional part of a material; null without it.
template <class Part>
Json describe_part(const std::optional<Part>& part) {
    Json numbers;
    if (!part) return numbers;
    Part::visit_numbers(*part, [&](const char* name, const auto& value, float, float) {
        if constexpr (std::is_same_v<decltype(value), const float&>) {
            numbers[name] = value;
        } else {
            numbers[name] = colour(value);
        }
    });
    return numbers;
}

Json describe_materials(const Scene& scene) {
    Json materials = Json::array();
    for (const Material& material : scene.materials) {
        Json description = {{"name", material.name},
                            {"ambient", colour(material.phong.ambient)},
                            {"diffuse", colour(material.phong.diffuse)},
                            {"specular", colour(material.phong.specular)},
                            {"shininess", material.phong.shininess},
                            {"double_sided", material.sides == FaceSides::double_sided},
                            {"mirror", colour(material.optics.mirror)},
                            {"transmission", material.optics.transmission},
                            {"ior", material.optics.ior},
                            {"absorption", colour(material.optics.absorption)},
                            {"emission", colour(material.optics.emission)},
                            {"priority", material.optics.priority}};
#define TANDEM_MATERIAL_PART(Type, member, members, needs, is) description[#member] = describe_part(material.member);
#include "tandem/kernel/bsdf/lobes.def"
        materials.push_back(std::move(description));
    }
    return materials;
}

Json describe_animation(const Scene& scene) {
    std::size_t keys = 0;
    for (const AnimationChannel& channel : scene.animation) keys += channel.times.size();
    return {{"channels", scene.animation.size()},
            {"keys", keys},
            {"frames", frame_count(scene)},
            {"frames_per_second", scene.frames_per_second}};
}

/// Adds the number of primitives of each kind at frame 0, and how many are dropped; null if the scene cannot be
/// prepared.
void describe_primitives(const Scene& scene, Json& description) {
    description["primitives"] = nullptr;
    description["dropped_primitives"] = nullptr;
    description["dropped_lights"] = nullptr;
    description["effects"] = nullptr;
    try {
        const PreparedScene prepared = prepare(scene);
        description["primitives"] = {
#define TANDEM_PRIMITIVE(Type, name, names) {#names, prepared.names.size()},
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
        };
        description["dropped_primitives"] = prepared.dropped_primitives;
        description["dropped_lights"] = prepared.dropped_lights;
        Json effects = Json::array();
        for (const EffectNeed& need : derive_effects(scene, prepared)) {
            effects.push_back({{"effect", to_string(need.effect)}, {"reason", need.reason}});
        }
        description["effects"] = std::move(effects);
    } catch (const InputError&) {
        // problems_of() reports it
    }
}

std::string quoted(const Json& name) {
    const auto text = name.get<std::string>();
    return text.empty() ? "(no name)" : name.dump(-1, ' ', true);
}

std::string components(const Json& colour) {
    return fmt::format("({:g}, {:g}, {:g})", colour[0].get<float>(), colour[1].get<float>(), colour[2].get<float>());
}

std::string line_of_node(const Json& node) {
    std::string carries;
    for (const char* what : shape_names) {
        if (node.contains(what)) carries += fmt::format(", {} {}", node[what].get<std::size_t>(), what);
    }
    for (const char* what : {"camera", "light", "animated"}) {
        if (node.contains(what)) carries += fmt::format(", {}", what);
    }
    return quoted(node["name"]) + (carries.empty() ? ", empty" : carries);
}

std::string line_of_camera(const Json& camera) {
    std::string line;
    if (camera.contains("ymag_metres")) {
        line = fmt::format("{}, orthographic, {:g} m high", quoted(camera["node"]),
                           2 * camera["ymag_metres"].get<double>());
    } else {
        line = fmt::format("{}, perspective, {:.4g} degrees high", quoted(camera["node"]),
                           camera["yfov_radians"].get<double>() * 180 / std::numbers::pi);
        if (const auto radius = camera["aperture_radius_metres"].get<double>(); radius > 0) {
            line += fmt::format(", aperture radius {:g} m, focused at {:g} m", radius,
                                camera["focus_distance_metres"].get<double>());
        }
    }
    const auto open = camera["shutter_seconds"][0].get<double>(), close = camera["shutter_seconds"][1].get<double>();
    if (close > open) {
        line += fmt::format(", shutter open from {:g} s to {:g} s after the frame time, {} instants", open, close,
                            camera["shutter_instants"].get<int>());
    }
    return line;
}

std::string line_of_light(const Json& light) {
    return fmt::format("{}, {}, colour {}, intensity {:g}{}{}", quoted(light["node"]), light["type"].get<std::string>(),
                       components(light["colour"]), light["intensity"].get<float>(),
                       light["falls_off"].get<bool>() ? ", falls off with distance" : "",
                       light["casts_shadows"].get<bool>() ? ", casts shadows" : "");
}

/// ", microfacets: metallic 1, roughness 0.5", without numbers that are 0.
std::string line_of_part(const char* is, const Json& part) {
    if (part.is_null()) return {};
    std::string numbers;
    for (const auto& [name, value] : part.items()) {
        if (value == (value.is_array() ? colour({0, 0, 0}) : Json(0.0F))) continue;
        const std::string text = value.is_array() ? components(value) : fmt::format("{:g}", value.get<float>());
        numbers += fmt::format("{} {} {}", numbers.empty() ? ":" : ",", name, text);
    }
    return fmt::format(", {}{}", is, numbers);
}

std::string line_of_material(const Json& material) {
    std::string line =
        fmt::format("{}, ambient {}, diffuse {}, specular {}, shininess {:g}{}", quoted(material["name"]),
                    components(material["ambient"]), components(material["diffuse"]), components(material["specular"]),
                    material["shininess"].get<float>(), material["double_sided"].get<bool>() ? ", double-sided" : "");
    const Json black = colour({0, 0, 0});
#define TANDEM_MATERIAL_PART(Type, member, members, needs, is) line += line_of_part(is, material[#member]);
#include "tandem/kernel/bsdf/lobes.def"
    if (material["mirror"] != black) line += ", mirror " + components(material["mirror"]);
    if (material["transmission"].get<float>() > 0) {
        line += fmt::format(", transmission {:g}, index {:g}, absorption {} per metre, priority {}",
                            material["transmission"].get<float>(), material["ior"].get<float>(),
                            components(material["absorption"]), material["priority"].get<std::uint32_t>());
    }
    if (material["emission"] != black) line += ", emission " + components(material["emission"]);
    return line;
}

template <class LineOf>
void add_list(std::string& text, const char* title, const Json& rows, std::size_t most, LineOf line_of) {
    text += fmt::format("{}: {}\n", title, rows.size());
    for (std::size_t i = 0; i < std::min(rows.size(), most); ++i) text += "  " + line_of(rows[i]) + "\n";
    if (rows.size() > most) text += fmt::format("  and {} more\n", rows.size() - most);
}

}  // namespace

Json describe(const std::string& specification, const Scene& scene, const ImportReport& report) {
    Json notes = Json::array();
    for (const ImportNote& note : report.notes()) {
        notes.push_back({{"treatment", to_string(note.treatment)},
                         {"feature", note.feature},
                         {"json_path", note.json_path},
                         {"uses", note.uses},
                         {"reason", note.reason},
                         {"sentence", to_string(note)}});
    }
    const Environment& environment = scene.environment;
    Json description = {{"file", specification}, {"scene", scene.name}};
    describe_primitives(scene, description);
    description["nodes"] = describe_nodes(scene);
    description["cameras"] = describe_cameras(scene);
    description["lights"] = describe_lights(scene);
    description["materials"] = describe_materials(scene);
    description["environment"] = {{"bottom", colour(environment.bottom)},
                                  {"top", colour(environment.top)},
                                  {"ambient", colour(environment.ambient)},
                                  {"illuminates", environment.illuminates != 0},
                                  {"indirect", scene.indirect_light}};
    if (const auto& image = scene.environment_image) {
        description["environment"]["picture"] = {{"width", image->picture.width},
                                                 {"height", image->picture.height},
                                                 {"rotation", image->rotation},
                                                 {"intensity", image->intensity}};
    }
    description["display"] = {{"transfer", to_string(scene.display.transfer)},
                              {"exposure_stops", scene.display.exposure_stops}};
    description["animation"] = describe_animation(scene);
    description["report"] = std::move(notes);
    return description;
}

std::string to_text(const Json& description) {
    std::string text =
        fmt::format("{}: scene {}\n", description["file"].get<std::string>(), quoted(description["scene"]));
    if (const Json& primitives = description["primitives"]; primitives.is_null()) {
        text += "primitives: the scene cannot be prepared; 'tandem-gltf check' says why\n";
    } else {
        std::string kinds;
        std::size_t total = 0;
        for (const auto& [kind, count] : primitives.items()) {
            total += count.get<std::size_t>();
            kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", count.get<std::size_t>(), kind);
        }
        text += fmt::format("primitives: {} ({})\n", total, kinds);
        if (const auto dropped = description["dropped_primitives"].get<std::size_t>(); dropped > 0) {
            text += fmt::format(
                "dropped: {} primitives that no ray hits: without extent, or masked out by their alpha\n", dropped);
        }
        if (const auto dropped = description["dropped_lights"].get<std::size_t>(); dropped > 0) {
            text += fmt::format("dropped: {} lights without direction (scale 0)\n", dropped);
        }
    }
    if (const Json& effects = description["effects"]; !effects.is_null()) {
        add_list(text, "effects beyond Phong shading", effects, most_lines, [](const Json& need) {
            return fmt::format("{}: {}", need["effect"].get<std::string>(), need["reason"].get<std::string>());
        });
    }
    add_list(text, "nodes", description["nodes"], most_lines, line_of_node);
    add_list(text, "cameras", description["cameras"], most_lines, line_of_camera);
    add_list(text, "lights", description["lights"], most_lines, line_of_light);
    add_list(text, "materials", description["materials"], most_lines, line_of_material);
    const Json& environment = description["environment"];
    std::string background = fmt::format("gradient from {} at the bottom to {} at the top",
                                         components(environment["bottom"]), components(environment["top"]));
    if (const auto picture = environment.find("picture"); picture != environment.end()) {
        background = fmt::format("picture of {} x {} texels, times {:g}", (*picture)["width"].get<int>(),
                                 (*picture)["height"].get<int>(), (*picture)["intensity"].get<double>());
    }
    text += fmt::format("environment: {}, ambient {}{}{}\n", background, components(environment["ambient"]),
                        environment["illuminates"].get<bool>() ? ", lights surfaces" : "",
                        environment["indirect"].get<bool>() ? ", indirect light" : "");
    const Json& display = description["display"];
    text += fmt::format("8-bit images: {}\n", in_words({parse_transfer(display["transfer"].get<std::string>()),
                                                        display["exposure_stops"].get<double>()}));
    const Json& animation = description["animation"];
    text += fmt::format("animation: {} channels, {} keys, {} frames at {:g} per second\n",
                        animation["channels"].get<std::size_t>(), animation["keys"].get<std::size_t>(),
                        animation["frames"].get<std::int64_t>(), animation["frames_per_second"].get<double>());
    add_list(text, "import report", description["report"], SIZE_MAX,
             [](const Json& note) { return note["sentence"].get<std::string>(); });
    return text;
}

std::vector<std::string> problems_of(const Scene& scene) {
    std::vector<std::string> problems;
    const std::int64_t frames = frame_count(scene);
    const std::int64_t steps = std::min(frames, most_prepared_frames);
    for (std::int64_t step = 0; step < steps && problems.size() < most_lines; ++step) {
        const std::int64_t frame = steps == 1 ? 0 : step * (frames - 1) / (steps - 1);
        try {
            (void)prepare(scene, {static_cast<std::int32_t>(frame), ""});
        } catch (const InputError& error) {
            const bool known = std::any_of(problems.begin(), problems.end(),
                                           [&](const std::string& problem) { return problem.ends_with(error.what()); });
            if (!known)
                problems.push_back(frame == 0 ? error.what() : fmt::format("frame {}: {}", frame, error.what()));
        }
    }
    return problems;
}

}  // namespace tandem
