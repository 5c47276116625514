#include "kind_scenes.h"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "ray_sets.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem::bench {

namespace {

constexpr int primitives = 64;

// Streams of random numbers.
constexpr std::uint32_t place_stream = 31, turn_stream = 32, scale_stream = 33, aim_stream = 34, origin_stream = 35;

struct KindShape {
    const char* name;
    Shape shape;
    bool scaled;  ///< unevenly
    bool turned;
    Mesh mesh{};
};

const Mesh one_triangle = {.positions = {{-0.6F, -0.5F, 0}, {0.6F, -0.5F, 0}, {0, 0.7F, 0}}, .triangles = {0, 1, 2}};
const Mesh one_quad = {.positions = {{-0.5F, -0.5F, 0}, {0.5F, -0.5F, 0}, {0.5F, 0.5F, 0}, {-0.5F, 0.5F, 0}},
                       .quads = {0, 1, 2, 3}};

const std::array kinds = {
    KindShape{"sphere", SphereShape{0.5}, false, false},
    KindShape{"box", BoxShape{{1, 1, 1}}, true, false},
    KindShape{"ellipsoid", SphereShape{0.5}, true, true},
    KindShape{"parallelepiped", BoxShape{{1, 1, 1}}, true, true},
    KindShape{"triangle", MeshShape{0}, true, true, one_triangle},
    KindShape{"quad", MeshShape{0}, true, true, one_quad},
};

/// A rotation as a quaternion of any length except zero.
Quaternion random_turn(std::uint32_t i) {
    const Vec3d axis = uniform_in_cube(turn_stream, i, 0);
    return {axis.x, axis.y, axis.z, 1.5 + uniform_in_cube(turn_stream, i, 1).x};
}

Vec3d random_scale(std::uint32_t i) { return Vec3d{1, 1, 1} + uniform_in_cube(scale_stream, i, 0) * 0.5; }

/// The place of the scene, its size and that of its primitives.
struct Setting {
    double offset;
    double size;
    double distance;  ///< from the centre to the origins of the rays
};

Setting setting_of(Difficulty difficulty) {
    return difficulty == Difficulty::easy ? Setting{0, 0.25, 3} : Setting{1000, 0.0025, 3000};
}

}  // namespace

std::vector<std::string> primitive_kinds() {
    std::vector<std::string> names;
    names.reserve(kinds.size());
    for (const KindShape& kind : kinds) names.emplace_back(kind.name);
    return names;
}

KindScene make_kind_scene(const std::string& name, Difficulty difficulty, std::size_t ray_count) {
    const auto* const kind =
        std::find_if(kinds.begin(), kinds.end(), [&](const KindShape& k) { return name == k.name; });
    if (kind == kinds.end()) throw InputError("there is no kind of primitive '" + name + "'");
    const auto [offset, size, distance] = setting_of(difficulty);
    const Vec3d centre = {offset, offset, offset};

    Scene scene;
    scene.name = name;
    scene.materials.emplace_back();
    if (std::holds_alternative<MeshShape>(kind->shape)) scene.meshes.push_back(kind->mesh);
    Node camera;
    camera.camera = PerspectiveCamera{};
    Node crowd;
    crowd.geometry.push_back({kind->shape, 0, {}});
    for (std::uint32_t i = 0; i < primitives; ++i) {
        Trs place;
        place.translation = centre + uniform_in_cube(place_stream, i, 0);
        place.scale = (kind->scaled ? random_scale(i) : Vec3d{1, 1, 1}) * size;
        if (kind->turned) place.rotation = random_turn(i);
        crowd.geometry.back().instances.push_back(place);
    }
    scene.nodes = {std::move(camera), std::move(crowd)};

    // rays and primitives keep the coordinates of the setting
    KindScene result{name, difficulty, prepare(scene, {.origin = Vec3d{0, 0, 0}}), {}};
    const SceneView window = view(result.scene);
    result.rays.reserve(ray_count);
    for (std::uint32_t i = 0; i < ray_count; ++i) {
        const Aabb bounds = primitive_bounds(window, i % primitives);
        const Vec3d half = (widen(bounds.upper) - widen(bounds.lower)) * 0.5;
        const Vec3d target = widen(bounds.lower) + half + half * uniform_in_cube(aim_stream, i, 0);
        const Vec3f origin = narrow(centre + normalize(uniform_in_cube(origin_stream, i, 0)) * distance);
        result.rays.push_back({origin, narrow(target - widen(origin))});
    }
    return result;
}

}  // namespace tandem::bench
