#include "tandem/scene/named_scenes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "tandem/base/error.h"
#include "tandem/base/memory.h"
#include "tandem/base/parallel.h"
#include "tandem/kernel/sampler/philox.h"
#include "tandem/math/accurate_functions.h"
#include "tandem/math/fp_environment.h"
#include "tandem/math/lengths.h"
#include "tandem/scene/icosphere.h"

namespace tandem {

namespace {

constexpr int paper_frames = 120;

Node camera_node(const Vec3d& position) {
    Node node;
    node.name = "camera";
    node.trs.translation = position;
    node.camera = PerspectiveCamera{2 * accurate_atan(1 / 1.5)};
    return node;
}

Node shape_node(std::string name, const Vec3d& position, Shape shape, std::uint32_t material) {
    Node node;
    node.name = std::move(name);
    node.trs.translation = position;
    node.geometry.push_back({shape, material, {}});
    return node;
}

Node light_node(const Vec3d& position) {
    Node node;
    node.name = "light";
    node.trs.translation = position;
    node.light = LightSource{.casts_shadows = false};  // as in the paper
    return node;
}

Material phong(std::string name, const Vec3f& diffuse) {
    return {std::move(name), {diffuse * 0.1F, diffuse, {1, 1, 1}, 32}};
}

/// One linear key per frame and one more that closes the circle. `position` maps an angle to a position.
template <class Position>
AnimationChannel circling(std::uint32_t node, double frames_per_second, Position position) {
    AnimationChannel channel;
    channel.node = node;
    for (int frame = 0; frame <= paper_frames; ++frame) {
        const double angle = 2 * std::numbers::pi * (frame % paper_frames) / paper_frames;
        channel.times.push_back(static_cast<float>(frame / frames_per_second));
        for (const double value : position(accurate_sin(angle), accurate_cos(angle))) {
            channel.values.push_back(static_cast<float>(value));
        }
    }
    return channel;
}

Scene paper() {
    Scene scene;
    scene.name = "paper";
    scene.display.transfer = TransferFunction::linear;  // as in the paper
    scene.materials = {phong("red", {0.8F, 0.2F, 0.2F}), phong("green", {0.2F, 0.8F, 0.2F}),
                       phong("blue", {0.2F, 0.2F, 0.8F}), phong("yellow", {0.8F, 0.8F, 0.2F})};
    scene.nodes = {camera_node({0, 0, 0}),
                   shape_node("red sphere", {-1.2F, 0, -3}, SphereShape{0.5}, 0),
                   shape_node("green sphere", {0, 0, -3}, SphereShape{0.5}, 1),
                   shape_node("blue sphere", {1.2F, 0, -3}, SphereShape{0.5}, 2),
                   shape_node("cube", {0.6F, 0, -2.2F}, BoxShape{{0.6F, 0.6F, 0.6F}}, 3),
                   light_node({2, 2, -3})};
    const double fps = scene.frames_per_second;
    scene.animation.push_back(circling(4, fps, [](double sine, double) { return std::array{0.6, 0.8 * sine, -2.2}; }));
    scene.animation.push_back(circling(5, fps, [](double sine, double cosine) {
        return std::array{2 * cosine, 2.0, -3 + 2 * sine};
    }));
    return scene;
}

/// A sphere of the Earth's size, seen from eye level, with small spheres on it.
Scene planet() {
    constexpr double radius = 6.4e6, eye = 1.75;
    Scene scene;
    scene.name = "hard/planet";
    scene.materials = {phong("ground", {0.35F, 0.5F, 0.3F}), phong("red", {0.8F, 0.2F, 0.2F}),
                       phong("blue", {0.2F, 0.2F, 0.8F})};
    scene.nodes = {camera_node({0, 0, 0}), light_node({4, 6, 2}),
                   shape_node("planet", {0, -(radius + eye), 0}, SphereShape{radius}, 0)};
    for (int i = 0; i < 12; ++i) {
        const double r = 0.1 + 0.05 * (i % 4);
        scene.nodes.push_back(shape_node(fmt::format("ball {}", i), {0.9 * (i % 5 - 2), r - eye, -3.0 - 0.8 * i},
                                         SphereShape{r}, static_cast<std::uint32_t>(1 + i % 2)));
    }
    return scene;
}

/// The paper's scene from far away, as large in the image as from nearby.
Scene telescope(std::string name, double distance) {
    Scene scene = paper();
    scene.name = std::move(name);
    scene.nodes[0].trs.translation.z += distance;
    scene.nodes[0].camera = PerspectiveCamera{2 * accurate_atan(3 / 1.5 / distance)};
    return scene;
}

/// Uniform random numbers of object `index`; counter-based, so that an object does not depend on the others.
class ObjectNumbers {
  public:
    ObjectNumbers(std::uint32_t seed, std::uint32_t index) : seed_(seed), index_(index) {}

    double uniform(double low, double high) {
        const auto block = philox4x32<std::uint32_t>({{index_, draw_++, 0, 0}}, seed_, 0x7A4DE3);
        return low + (high - low) * double{to_unit_interval<float>(block.word[0])};
    }
    Vec3d in_cube() {
        const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
        return {x, y, z};
    }
    Vec3d size(double scale) {
        const double x = uniform(0.3, 1), y = uniform(0.3, 1), z = uniform(0.3, 1);
        return Vec3d{x, y, z} * scale;
    }
    Quaternion rotation() {
        const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1), w = uniform(0.1, 1);
        return {x, y, z, w};
    }

  private:
    std::uint32_t seed_;
    std::uint32_t index_;
    std::uint32_t draw_ = 0;
};

/// The common part of spheres/N and similar scenes: camera, light and eight materials; objects go into one node per
/// material.
Scene crowd(std::string name) {
    Scene scene;
    scene.name = std::move(name);
    for (int i = 0; i < 8; ++i) {
        const auto level = [i](int bit) { return (i >> bit & 1) != 0 ? 0.8F : 0.3F; };
        scene.materials.push_back(phong(fmt::format("colour {}", i), {level(0), level(1), level(2)}));
    }
    scene.nodes = {camera_node({0, 0, 3.2F}), light_node({2, 3, 4})};
    return scene;
}

/// Adds a node that holds `instances` of one shape.
void add_instances(Scene& scene, std::string name, Shape shape, std::uint32_t material, std::vector<Trs> instances) {
    if (instances.empty()) return;
    Node node;
    node.name = std::move(name);
    node.geometry.push_back({shape, material, std::move(instances)});
    scene.nodes.push_back(std::move(node));
}

/// How many of `count` objects a part gets, if the parts take turns.
std::size_t objects_of(std::size_t part, std::size_t count, std::size_t parts) {
    return part < count ? (count - part - 1) / parts + 1 : 0;
}

/// The kinds of placements in a scene of many objects.
struct Placements {
    bool spheres, boxes, ellipsoids, parallelepipeds;
};

Scene random_crowd(const std::string& name, std::uint32_t count, std::uint32_t seed, const Placements& wanted) {
    Scene scene = crowd(name);
    const double radius = 0.6 / accurate_cbrt(static_cast<double>(count));
    std::vector<int> kinds;
    if (wanted.spheres) kinds.push_back(0);
    if (wanted.boxes) kinds.push_back(1);
    if (wanted.ellipsoids) kinds.push_back(2);
    if (wanted.parallelepipeds) kinds.push_back(3);
    const auto colours = static_cast<std::uint32_t>(scene.materials.size());
    std::vector<std::vector<Trs>> groups(kinds.size() * colours);
    run_parallel(groups.size(), [&](std::size_t part) {
        // kinds take turns, and then colours
        const std::size_t turn = part % kinds.size(), colour = part / kinds.size();
        const int kind = kinds[turn];
        std::vector<Trs>& group = groups[turn * colours + colour];
        group.reserve(objects_of(part, count, groups.size()));
        for (std::size_t i = part; i < count; i += groups.size()) {
            ObjectNumbers numbers(seed, static_cast<std::uint32_t>(i));
            Trs trs;
            trs.translation = numbers.in_cube();
            if (kind != 0) trs.scale = numbers.size(radius);
            if (kind == 2 || kind == 3) trs.rotation = numbers.rotation();
            group.push_back(trs);
        }
    });
    static constexpr const char* kind_names[] = {"spheres", "boxes", "ellipsoids", "parallelepipeds"};
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const int kind = kinds[g / colours];
        const auto colour = static_cast<std::uint32_t>(g % colours);
        Shape shape = BoxShape{{2, 2, 2}};
        if (kind == 0) shape = SphereShape{radius};
        if (kind == 2) shape = SphereShape{1};
        add_instances(scene, fmt::format("{}, colour {}", kind_names[kind], colour), shape, colour,
                      std::move(groups[g]));
    }
    return scene;
}

/// The random spheres, and below them one of 1000 km.
Scene beside_a_giant(const std::string& name, std::uint32_t count, std::uint32_t seed) {
    constexpr double radius = 1e6;
    Scene scene = random_crowd(name, count, seed, {true, false, false, false});
    scene.nodes.push_back(shape_node("giant", {0, -1.5 - radius, 0}, SphereShape{radius}, 7));
    return scene;
}

/// `count` faces of random shape, in one mesh per colour; `corners` is 3 or 4. Quads are parallelograms, except for the
/// rounding of their corners. All are double-sided.
Scene random_faces(const std::string& name, std::uint32_t count, std::uint32_t seed, std::uint32_t corners) {
    Scene scene = crowd(name);
    const double radius = 0.6 / accurate_cbrt(static_cast<double>(count));
    scene.meshes.resize(scene.materials.size());
    run_parallel(scene.meshes.size(), [&](std::size_t part) {
        Mesh& mesh = scene.meshes[part];
        auto& indices = corners == 3 ? mesh.triangles : mesh.quads;
        const std::size_t vertices = corners * objects_of(part, count, scene.meshes.size());
        mesh.positions.reserve(vertices);
        indices.reserve(vertices);
        for (std::size_t i = part; i < count; i += scene.meshes.size()) {
            ObjectNumbers numbers(seed, static_cast<std::uint32_t>(i));
            const Vec3d centre = numbers.in_cube();
            const Vec3d a = numbers.in_cube() * radius, b = numbers.in_cube() * radius, c = numbers.in_cube() * radius;
            const Vec3d places[] = {a, b, corners == 3 ? c : -a, -b};
            for (std::uint32_t k = 0; k < corners; ++k) {
                indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
                mesh.positions.push_back(narrow(centre + places[k]));
            }
        }
    });
    for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) {
        if (scene.meshes[m].positions.empty()) continue;
        scene.meshes[m].name = fmt::format("faces, colour {}", m);
        scene.materials[m].sides = FaceSides::double_sided;
        scene.nodes.push_back(shape_node(scene.meshes[m].name, {0, 0, 0}, MeshShape{m}, m));
    }
    return scene;
}

/// Thin triangles, four times as long as the edge of the cube that holds one of random_faces().
Scene random_hair(const std::string& name, std::uint32_t count, std::uint32_t seed) {
    Scene scene = crowd(name);
    const double half_length = 2.4 / accurate_cbrt(static_cast<double>(count)), width = 2e-3 * half_length;
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.name = "hair";
    for (std::uint32_t i = 0; i < count; ++i) {
        ObjectNumbers numbers(seed, i);
        const Vec3d centre = numbers.in_cube(), towards = numbers.in_cube(), aside = numbers.in_cube();
        const Vec3d along = towards * (half_length / length(towards)), across = aside * (width / length(aside));
        for (const Vec3d& corner : {centre - along, centre + along, centre - along + across}) {
            mesh.triangles.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(narrow(corner));
        }
    }
    scene.materials[0].sides = FaceSides::double_sided;
    scene.nodes.push_back(shape_node(mesh.name, {0, 0, 0}, MeshShape{0}, 0));
    return scene;
}

/// A leaf: an ellipse of 32 x 32 texels, of one colour, with nothing around it.
Image leaf() {
    constexpr std::uint32_t edge = 32;
    Image image{"leaf", edge, edge, {}};
    for (std::uint32_t i = 0; i < edge * edge; ++i) {
        const double x = (i % edge + 0.5) / (edge / 2.0) - 1, y = (i / edge + 0.5) / (edge / 2.0) - 1;
        const std::uint32_t alpha = x * x + 3 * y * y < 0.9 ? 255U : 0U;
        image.texels.push_back(90U | 160U << 8 | 60U << 16 | alpha << 24);
    }
    return image;
}

/// Turns faces into leaves: material `material`, and the faces of `mesh`, whose vertices 4 i to 4 i + 3 are the corners
/// of face i. The scene has the image of a leaf as texture 0.
void make_leaves(Scene& scene, std::uint32_t mesh, std::uint32_t material) {
    const Vec2f corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    Mesh& faces = scene.meshes[mesh];
    std::vector<Vec2f>& texcoords = faces.texcoords.emplace_back();
    for (std::size_t i = 0; i < faces.positions.size(); ++i) texcoords.push_back(corners[i % 4]);
    scene.materials[material].diffuse_texture = TextureReference{.texture = 0};
    scene.materials[material].alpha_mode = AlphaMode::mask;
    scene.materials[material].sides = FaceSides::double_sided;
}

/// What scenes of leaves have in common.
void begin_leaves(Scene& scene) {
    scene.nodes[1].light->casts_shadows = true;
    scene.images = {leaf()};
    scene.textures = {{.image = 0}};
}

/// The quads of random_faces(), each with an alpha mask, which cast shadows.
Scene random_leaves(const std::string& name, std::uint32_t count, std::uint32_t seed) {
    Scene scene = random_faces(name, count, seed, 4);
    begin_leaves(scene);
    for (std::uint32_t i = 0; i < scene.meshes.size(); ++i) make_leaves(scene, i, i);
    return scene;
}

/// A thousand leaves in a ball of radius 1, each of two triangles.
Mesh crown() {
    Mesh mesh;
    mesh.name = "crown";
    for (std::uint32_t i = 0; i < 1000; ++i) {
        ObjectNumbers numbers(1, i);
        const Vec3d in_cube = numbers.in_cube();
        const Vec3d centre = in_cube * (max_norm(in_cube) / length(in_cube));
        const Vec3d a = numbers.in_cube() * 0.15, b = numbers.in_cube() * 0.15;
        for (const std::uint32_t k : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.triangles.push_back(4 * i + k);
        for (const Vec3d& place : {a, b, -a, -b}) mesh.positions.push_back(narrow(centre + place));
    }
    return mesh;
}

Scene one_icosphere(const std::string& name, int level) {
    Scene scene = crowd(name);
    scene.meshes = {icosphere(level)};
    scene.nodes.push_back(shape_node(scene.meshes[0].name, {0, 0, 0}, MeshShape{0}, 3));
    return scene;
}

/// `count` instances of a mesh, in the cells of a grid: of a cube, or of its floor.
Scene instances_of(const std::string& name, std::uint32_t count, std::uint32_t seed, bool on_floor, Mesh mesh) {
    Scene scene = crowd(name);
    scene.meshes = {std::move(mesh)};
    std::uint32_t edge = 1;
    const auto cells = [on_floor](std::uint64_t n) { return on_floor ? n * n : n * n * n; };
    while (cells(edge) < count) ++edge;
    const double cell = 2.0 / edge;
    std::vector<Trs> instances(count);
    constexpr std::size_t at_once = 4096;
    for_each_chunk(count, at_once, [&](const Chunk& chunk) {
        for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
            ObjectNumbers numbers(seed, static_cast<std::uint32_t>(i));
            const auto row = [&](std::size_t place) { return (static_cast<double>(place % edge) + 0.5) * cell - 1; };
            const Vec3d middle = {row(i), on_floor ? 0.0 : row(i / edge / edge), row(i / edge)};
            instances[i].translation = middle + numbers.in_cube() * (0.2 * cell);
            instances[i].scale = (Vec3d{1, 1, 1} + numbers.in_cube() * 0.5) * (0.364 * cell);
            instances[i].rotation = numbers.rotation();
        }
    });
    if (on_floor) {
        scene.nodes[0].trs.translation = {0, 5.5 * cell, 1};
        scene.nodes[0].trs.rotation = {-0.28, 0, 0, 0.96};  // the horizon is at the top
    }
    add_instances(scene, "instances", MeshShape{0}, 3, std::move(instances));
    return scene;
}

/// Crowns of leaves side by side, above a ground.
Scene forest(const std::string& name, std::uint32_t count, std::uint32_t seed) {
    Scene scene = instances_of(name, count, seed, true, crown());
    begin_leaves(scene);
    make_leaves(scene, 0, 3);
    const double cell = 2 / std::sqrt(static_cast<double>(count));
    scene.nodes.push_back(shape_node("ground", {0, -2, 0}, BoxShape{{4, 4 - 1.6 * cell, 4}}, 7));
    return scene;
}

/// Parses "123" within [least, most]; empty if it is not a number or out of range.
std::optional<std::uint32_t> parse_count(std::string_view text, std::uint32_t most, std::uint32_t least = 1) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < least || value > most) return std::nullopt;
    return value;
}

/// The least memory that a primitive of such a scene takes, here and in prepare().
std::size_t least_bytes(std::string_view kind) {
    if (kind == "triangles" || kind == "hair")
        return 3 * 16 + 56;  // corners and their indices, then the face with material and node
    if (kind == "quads") return 4 * 16 + 72;
    if (kind == "leaves") return 4 * 16 + 72 + 2 * 4 * 8;  // and texture coordinates
    if (kind == "block" || kind == "city" || kind == "forest") return sizeof(Trs) + 240;
    return sizeof(Trs) + (kind == "spheres" || kind == "giant" ? 24
                          : kind == "mixed"                    ? 90
                                                               : 152);  // turned boxes have matrices
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    while (true) {
        const std::size_t at = text.find(separator);
        parts.push_back(text.substr(0, at));
        if (at == std::string_view::npos) return parts;
        text.remove_prefix(at + 1);
    }
}

}  // namespace

std::vector<std::string> scene_names() {
    return {"paper",           "hard/planet",    "hard/telescope",     "hard/far-telescope", "spheres/N[/SEED]",
            "boxes/N[/SEED]",  "mixed/N[/SEED]", "triangles/N[/SEED]", "quads/N[/SEED]",     "icosphere/LEVEL",
            "leaves/N[/SEED]", "block/N[/SEED]", "city/N[/SEED]",      "forest/N[/SEED]",    "giant/N[/SEED]",
            "hair/N[/SEED]"};
}

Scene named_scene(std::string_view name) {
    const DefaultFpEnvironment guard;
    if (name == "paper") return paper();
    if (name == "hard/planet") return planet();
    if (name == "hard/telescope") return telescope(std::string(name), 1e5);
    if (name == "hard/far-telescope") return telescope(std::string(name), 1e7);
    const std::vector<std::string_view> parts = split(name, '/');
    if (parts.size() == 2 && parts[0] == "icosphere") {
        if (const auto level = parse_count(parts[1], 10, 0))
            return one_icosphere(std::string(name), static_cast<int>(*level));
    } else if (parts.size() == 2 || parts.size() == 3) {
        const auto count = parse_count(parts[1], 100'000'000);
        const auto seed = parts.size() == 3 ? parse_count(parts[2], 0xFFFFFFFFU) : std::optional<std::uint32_t>(1);
        const std::string full(name);
        if (count && seed) {
            // refused before the time is spent
            require_memory(*count * least_bytes(parts[0]), fmt::format("the scene {}", name));
            if (parts[0] == "spheres") return random_crowd(full, *count, *seed, {true, false, false, false});
            if (parts[0] == "boxes") return random_crowd(full, *count, *seed, {false, false, false, true});
            if (parts[0] == "mixed") return random_crowd(full, *count, *seed, {true, true, true, true});
            if (parts[0] == "triangles") return random_faces(full, *count, *seed, 3);
            if (parts[0] == "quads") return random_faces(full, *count, *seed, 4);
            if (parts[0] == "hair") return random_hair(full, *count, *seed);
            if (parts[0] == "leaves") return random_leaves(full, *count, *seed);
            if (parts[0] == "block") return instances_of(full, *count, *seed, false, icosphere(5));
            if (parts[0] == "city") return instances_of(full, *count, *seed, true, icosphere(5));
            if (parts[0] == "giant") return beside_a_giant(full, *count, *seed);
            if (parts[0] == "forest") return forest(full, *count, *seed);
        }
    }
    throw InputError(
        fmt::format("there is no scene '{}'; the scenes are {} (N from 1 to 100000000, LEVEL from 0 to 10)", name,
                    fmt::join(scene_names(), ", ")));
}

}  // namespace tandem
