#include "support/hard_scenes.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem::test {

namespace {

class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double uniform(double low, double high) {
        // not std::uniform_real_distribution, which differs between libraries
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    Vec3d in_cube(double half) {
        const double x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
        return {x, y, z};
    }
    std::size_t index(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

  private:
    std::mt19937_64 engine_;
};

/// A triangle, or a quad that need not be flat, with corners up to `size` from the origin.
Mesh one_face(Random& random, double size, bool is_triangle) {
    Mesh mesh;
    for (std::uint32_t corner = 0; corner < (is_triangle ? 3 : 4); ++corner) {
        mesh.positions.push_back(narrow(random.in_cube(size)));
        (is_triangle ? mesh.triangles : mesh.quads).push_back(corner);
    }
    return mesh;
}

}  // namespace

std::vector<HardScene> hard_scenes() {
    return {{"unit", 1, 0, 1.5, 96},
            {"far", 1, 1e3, 1, 96},
            {"very far", 1, 1e6, 0.5, 96},
            {"tiny", 1e-6, 0, 2, 96},
            {"tiny and far", 1e-4, 10, 1, 96},
            {"huge", 1e9, 0, 3, 96},
            {"astronomical", 1e15, 1e16, 2, 96},
            {"mixed sizes", 100, 0, 5, 96},
            {"crowd", 1, 0, 2, 2000},
            {"few", 1, 0, 1, 8},
            {"faces", 1, 0, 1.5, 96, HardKinds::faces},
            {"far faces", 1, 1e6, 0.5, 96, HardKinds::faces},
            {"tiny faces", 1e-6, 1e-3, 1, 96, HardKinds::faces},
            {"huge faces", 1e9, 0, 3, 96, HardKinds::faces},
            {"few faces", 1, 0, 1, 8, HardKinds::faces}};
}

std::vector<HardScene> scenes_of_one_kind() {
    return {{"spheres", 1, 0, 1.5, 96, HardKinds::spheres},
            {"turned boxes", 1, 0, 1.5, 96, HardKinds::parallelepipeds},
            {"far turned boxes", 1, 1e3, 1, 96, HardKinds::parallelepipeds},
            {"triangles", 1, 0, 1.5, 96, HardKinds::triangles}};
}

PreparedScene make_scene(const HardScene& parameters, std::uint64_t seed) {
    Random random(seed);
    Scene scene;
    scene.materials.emplace_back();
    Node camera;
    camera.camera = PerspectiveCamera{};
    scene.nodes.push_back(camera);
    const Vec3d middle = random.in_cube(parameters.offset);
    for (int i = 0; i < parameters.count; ++i) {
        Node node;
        const auto size = [&] {
            return parameters.scale * std::pow(10.0, -random.uniform(0, parameters.spread)) * 0.3;
        };
        node.trs.translation = middle + random.in_cube(parameters.scale);
        Geometry geometry;
        const HardKinds kinds = parameters.kinds;
        if (kinds == HardKinds::faces || kinds == HardKinds::triangles) {
            geometry.shape = MeshShape{static_cast<std::uint32_t>(scene.meshes.size())};
            scene.meshes.push_back(one_face(random, 10 * size(), kinds == HardKinds::triangles || i % 2 == 0));
        } else if (kinds == HardKinds::spheres || (kinds == HardKinds::solids && i % 2 == 0)) {
            geometry.shape = SphereShape{size()};
        } else {
            const double x = size(), y = size(), z = size();
            geometry.shape = BoxShape{{x, y, z}};
        }
        if (kinds == HardKinds::parallelepipeds || (kinds != HardKinds::spheres && i % 4 >= 2)) {
            const Vec3d axis = random.in_cube(1);
            node.trs.rotation = {axis.x, axis.y, axis.z, random.uniform(0.1, 1)};
            const double x = random.uniform(0.2, 2), y = random.uniform(0.2, 2);
            node.trs.scale = {x, y, 1};
        }
        node.geometry.push_back(geometry);
        scene.nodes.push_back(node);
    }
    return prepare(scene, {.origin = Vec3d{0, 0, 0}});  // keeps the scene far from the origin
}

std::vector<Ray<float>> make_rays(const PreparedScene& scene, std::size_t count, std::uint64_t seed) {
    Random random(seed);
    const SceneView scene_view = view(scene);
    Aabb all;
    for (std::uint32_t id = 0; id < primitive_count(scene_view); ++id)
        all = merge(all, primitive_bounds(scene_view, id));
    const Vec3d middle = widen(centre(all));
    const Vec3d extent = widen(all.upper) - widen(all.lower);
    const double size = std::max({extent.x, extent.y, extent.z});
    const auto point_near_primitive = [&] {
        const Aabb box = primitive_bounds(scene_view, static_cast<std::uint32_t>(random.index(primitive_count(scene))));
        const Vec3d half = (widen(box.upper) - widen(box.lower)) * 0.5;
        return widen(centre(box)) + half * random.in_cube(1.1);
    };
    std::vector<Ray<float>> rays;
    rays.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        Vec3d origin;
        switch (i % 5) {
            case 0:
                origin = middle + random.in_cube(size);
                break;
            case 1:
                origin = middle + random.in_cube(100 * size);
                break;
            case 2:
                origin = middle + random.in_cube(1e5 * size);
                break;
            default:
                origin = point_near_primitive();
        }
        const Vec3d target = i % 7 == 0 ? middle + random.in_cube(size) : point_near_primitive();
        Vec3d direction = target - origin;
        if (i % 11 == 0) {  // along an axis, or in a plane of two
            const std::size_t axis = random.index(3);
            direction = {axis == 0 ? direction.x : 0, axis == 1 ? direction.y : -0.0,
                         axis == 2    ? direction.z
                         : i % 2 == 0 ? 0
                                      : direction.z};
        }
        direction = direction * (std::pow(10.0, random.uniform(-9, 9)) / std::sqrt(dot(direction, direction)));
        rays.push_back({narrow(origin), narrow(direction)});
    }
    return rays;
}

}  // namespace tandem::test
