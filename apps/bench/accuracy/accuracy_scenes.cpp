#include "accuracy/accuracy_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <string_view>

#include "tandem/base/error.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/scene/icosphere.h"

namespace tandem::bench {

namespace {

constexpr std::string_view closed = "closed:";

Node node_of(Shape shape, const Vec3d& at, std::uint32_t material) {
    Node node{.name = "body", .trs = {.translation = at}};
    node.geometry.push_back({shape, material, {}});
    return node;
}

/// A room of six quads, from -1 to 1, seen from its middle.
Mesh room() {
    Mesh mesh{.name = "room"};
    for (int i = 0; i < 8; ++i) {
        const auto at = [&](int bit) { return (i & bit) != 0 ? 1.0F : -1.0F; };
        mesh.positions.push_back({at(1), at(2), at(4)});
    }
    mesh.quads = {0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1, 2, 3, 7, 6, 0, 2, 6, 4, 1, 5, 7, 3};
    return mesh;
}

Scene dark_scene(const std::string& name, const Vec3f& background) {
    Scene scene;
    scene.name = name;
    scene.environment = {background, background, {1, 1, 1}};
    scene.materials = {{name, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 1}}};
    return scene;
}

/// L = e + r L everywhere, so L = e / (1 - r). The emission is chosen so that L is 1, apart from rounding.
AccuracyScene furnace(const std::string& name, int percent) {
    const float reflectance = static_cast<float>(percent) / 100;
    const float emission = 1 - reflectance;
    Scene scene = dark_scene("furnace", {0, 0, 0});
    scene.indirect_light = true;
    Material& wall = scene.materials[0];
    wall.phong.diffuse = {reflectance, reflectance, reflectance};
    wall.optics.emission = {emission, emission, emission};
    wall.sides = FaceSides::double_sided;
    scene.meshes = {room()};
    scene.nodes = {{.name = "camera", .camera = PerspectiveCamera{}}, node_of(MeshShape{0}, {0, 0, 0}, 0)};
    const float radiance = static_cast<float>(double{emission} / (1 - double{reflectance}));
    return {name, std::move(scene), Vec3f{radiance, radiance, radiance},
            fmt::format("every pixel is e / (1 - r), with the reflectance r = {}", reflectance)};
}

/// R + T = 1 at every interface, so uniform light keeps its radiance.
AccuracyScene clear_glass(const std::string& name) {
    Scene scene = dark_scene("glass", {1, 1, 1});
    scene.materials[0].optics.transmission = 1;
    scene.materials[0].optics.ior = 1.5F;
    scene.nodes = {{.name = "camera", .trs = {.translation = {0, 0, 4}}, .camera = PerspectiveCamera{0.6}},
                   node_of(SphereShape{0.7}, {-0.6, 0.2, 0}, 0),
                   node_of(BoxShape{{0.8, 0.5, 0.6}}, {0.6, -0.4, 0}, 0)};
    scene.nodes.back().trs.rotation = {0.2, 0.3, 0.1, 0.9};
    return {name, std::move(scene), Vec3f{1, 1, 1}, "clear glass in uniform light is invisible: every pixel is 1"};
}

AccuracyScene closed_scene(const std::string& name) {
    const std::string_view what = std::string_view(name).substr(closed.size());
    if (what == "glass") return clear_glass(name);
    constexpr std::string_view furnaces = "furnace/";
    if (what.starts_with(furnaces)) {
        const std::string_view digits = what.substr(furnaces.size());
        int percent = 0;
        const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), percent);
        const bool whole = problem == std::errc() && end == digits.data() + digits.size();
        if (whole && percent >= 1 && percent <= 99) return furnace(name, percent);
    }
    throw InputError(
        fmt::format("no scene \"{}\"; those with a closed form are closed:glass and "
                    "closed:furnace/PERCENT, with a percentage from 1 to 99",
                    name));
}

bool needs_parametrisation(const Material& material) {
    return material.diffuse_texture || material.normal_texture || material.emissive_texture ||
           material.metallic_roughness_texture || material.anisotropy_texture || is_anisotropic(material);
}

}  // namespace

AccuracyScene load_accuracy_scene(const std::string& name, const FilmSize& size) {
    if (name.starts_with(closed)) return closed_scene(name);
    return {name, load_scene(name, nullptr, {.aspect = aspect_of(size)}), std::nullopt, {}};
}

const std::vector<ListedScene>& listed_scenes() {
    static const std::vector<ListedScene> list = {
        {"samples", "easy", "named:paper", "smooth shading, edges"},
        {"samples", "hard", "assets/scenes/soft-shadows.gltf", "noise from area lights over the whole image"},
        {"tier", "easy", "named:spheres/300", "float represents the scene"},
        {"tier", "hard", "named:hard/planet", "float represents neither the planet nor the balls on it"},
        {"tier", "hard", "named:hard/far-telescope", "at 10,000 km the balls are as large as one ulp of a float"},
        {"sampler", "easy", "../shared/gltf/CornellBox.glb", "plain walls, light from everywhere; a real file"},
        {"sampler", "hard", "../shared/gltf/FlightHelmet/FlightHelmet.gltf",
         "textures and normals finer than a pixel; a real file"},
        {"filter", "easy", "assets/scenes/plain.gltf", "smooth shading: neighbouring pixels differ little"},
        {"filter", "hard", "assets/scenes/whitted.gltf",
         "a chequered floor that becomes finer than the pixels towards the horizon"},
        {"effects", "easy", "assets/scenes/whitted.gltf", "mirrors and glass that the image is made of"},
        {"effects", "hard", "assets/scenes/glass.gltf",
         "glass in glass, with absorption: effects that depend on others"},
        {"depth", "easy", "closed:furnace/50", "half of the light is gone after each bounce"},
        {"depth", "hard", "closed:furnace/95", "light still counts after a hundred bounces"},
        {"tessellation", "easy", "named:spheres/300", "small opaque spheres"},
        {"tessellation", "hard", "closed:glass", "light that is refracted twice at the triangles"},
    };
    return list;
}

bool is_beside_the_repository(const ListedScene& listed) { return std::string_view(listed.scene).starts_with("../"); }

std::vector<std::string> listed_scene_names() {
    std::vector<std::string> names;
    for (const ListedScene& listed : listed_scenes()) {
        if (is_beside_the_repository(listed) && !std::filesystem::exists(listed.scene)) continue;
        if (std::find(names.begin(), names.end(), listed.scene) == names.end()) names.emplace_back(listed.scene);
    }
    return names;
}

int triangles_per_sphere(int level) { return 20 << (2 * level); }

std::optional<Scene> tessellated_twin(const Scene& scene, int level) {
    Scene twin = scene;
    std::map<double, std::uint32_t> meshes;  // by radius
    const auto mesh_of = [&](double radius) {
        const auto [at, added] = meshes.emplace(radius, static_cast<std::uint32_t>(twin.meshes.size()));
        if (added) {
            Mesh mesh = icosphere(level);
            for (Vec3f& position : mesh.positions) position = narrow(widen(position) * radius);
            twin.meshes.push_back(std::move(mesh));
        }
        return MeshShape{at->second};
    };
    for (Node& node : twin.nodes) {
        for (Geometry& geometry : node.geometry) {
            const auto* sphere = std::get_if<SphereShape>(&geometry.shape);
            if (sphere == nullptr) continue;
            if (needs_parametrisation(scene.materials.at(geometry.material))) return std::nullopt;
            geometry.shape = mesh_of(sphere->radius);
        }
    }
    if (meshes.empty()) return std::nullopt;
    return twin;
}

}  // namespace tandem::bench
