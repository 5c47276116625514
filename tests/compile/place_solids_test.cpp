// Millions of spheres and boxes: the bytes, the errors and the memory of prepare() on several threads.
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "support/peak_memory.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/thread_limit.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using test::contains;
using test::input_error;
using test::small_scene;
using test::ThreadLimit;

/// All that prepare() decides about solids, as text.
std::string summary(const PreparedScene& scene) {
    std::string text = scene_hash(scene);
    const auto add = [&](const void* data, std::size_t bytes) { text.append(static_cast<const char*>(data), bytes); };
    add(&scene.origin, sizeof(scene.origin));
    add(&scene.dropped_primitives, sizeof(scene.dropped_primitives));
    add(scene.node_of.data(), scene.node_of.size() * sizeof(std::uint32_t));
    for (const PrimitiveCopy& copy : scene.copies)
        text += std::to_string(copy.id) + ":" + std::to_string(copy.of) + " ";
    return text;
}

/// Spheres and boxes of all kinds, some hidden, some equal, in long and short geometries, far from the world's origin.
Scene all_kinds(std::size_t instances) {
    test::Random random(7);
    Scene scene = small_scene();
    scene.nodes[0].trs.translation = {1e6, 0, 3};
    scene.materials.resize(3);
    const auto place = [&](std::size_t i) {
        const auto number = [&] { return random.uniform(-1.0, 1.0); };
        Trs trs;
        trs.translation = {number(), number(), number()};
        if (i % 3 == 1) trs.scale = {2, 2, 1 + 0.5 * number()};
        if (i % 5 == 1) trs.rotation = {number(), number(), number(), 1.5};
        if (i % 7 == 1) trs.scale = {0, 0, 0};
        if (i % 11 == 1) trs = {{0.5, 0.25, 0}, {}, {1, 1, 1}};
        return trs;
    };
    for (int g = 0; g < 4; ++g) {
        Node node;
        node.trs.translation = {1e6, 0, 0.1 * g};
        Geometry geometry{g % 2 == 0 ? Shape(SphereShape{0.01}) : Shape(BoxShape{{0.01, 0.02, 0.03}}),
                          static_cast<std::uint32_t>(g % 3),
                          {}};
        for (std::size_t i = 0; i < instances; ++i) geometry.instances.push_back(place(i));
        node.geometry = {geometry, {SphereShape{0.1}, 2, {}}};
        scene.nodes.push_back(node);
    }
    return scene;
}

TEST(PlaceSolids, BytesDoNotDependOnTheThreads) {
    for (const bool is_named : {true, false}) {
        std::string first;
        for (const int threads : {1, 2, 7}) {
            const ThreadLimit limit(threads);
            const PreparedScene prepared = prepare(is_named ? named_scene("mixed/70001") : all_kinds(20000));
            if (!is_named) {
                EXPECT_GT(prepared.dropped_primitives, 10000U);
                EXPECT_GT(prepared.copies.size(), 5000U);
                for (const std::size_t count : {prepared.spheres.size(), prepared.boxes.size(),
                                                prepared.ellipsoids.size(), prepared.parallelepipeds.size()}) {
                    EXPECT_GT(count, 5000U);
                }
                EXPECT_NEAR(prepared.origin.x, 1e6, 100);
            }
            const std::string bytes = summary(prepared);
            if (first.empty()) first = bytes;
            EXPECT_EQ(bytes == first, true) << threads << " threads";
        }
    }
}

/// The stored hash is that of prepare() on one thread, before it had several.
TEST(PlaceSolids, BytesAreThoseOfOneThread) {
    EXPECT_EQ(scene_hash(prepare(named_scene("spheres/50000"))),
              "c6e510af33fd2fde02d63ea609dd1eb2f0ecc4a8a9338d91a52b04988fa31816");
    EXPECT_EQ(scene_hash(prepare(named_scene("mixed/50000"))),
              "7ffa4d0826751a2f395a770816f6f465d2e6c8a43bf52b74dc861569e96c8c4b");
}

TEST(PlaceSolids, EachIsWhereItsInstanceSays) {
    const Scene scene = all_kinds(20000);
    const PrepareOptions options = {.origin = Vec3d{1e6, 0, 0}};
    const PreparedScene all = prepare(scene, options);
    std::array<std::size_t, 4> next{};
    // the same, one instance at a time: every 50th is compared, and the others only counted
    const auto expect_next = [](const auto& list, std::size_t& at, const auto& alone) {
        if (alone.empty()) return;
        ASSERT_LT(at, list.size());
        // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): bits, not values
        EXPECT_EQ(std::memcmp(&list[at], alone.data(), sizeof(alone[0])), 0) << at;
    };
    const Geometry& first = scene.nodes[3].geometry[0];
    Scene one = scene;
    one.nodes.resize(4);
    for (std::size_t i = 0; i < 600; ++i) {
        one.nodes[3].geometry = {{first.shape, first.material, {first.instances[i]}}};
        const PreparedScene alone = prepare(one, options);
        // the sphere of small_scene() comes first
        ASSERT_EQ(alone.spheres.size() + alone.ellipsoids.size() + alone.dropped_primitives, 2U);
        if (alone.spheres.size() == 2) {
            expect_next(all.spheres, ++next[0], std::vector<Sphere>{alone.spheres[1]});
        }
        expect_next(all.ellipsoids, next[1], alone.ellipsoids);
        next[1] += alone.ellipsoids.size();
    }
    EXPECT_GT(next[0], 100U);
    EXPECT_GT(next[1], 100U);
}

TEST(PlaceSolids, TheFirstErrorInTheSceneIsTheOneThatIsReported) {
    Scene scene = small_scene();
    const Trs flat{{}, {0, 0, 0.3, 1}, {1, 0, 1}}, far{{9.99e17, 0, 0}, {}, {1e17, 1e17, 1e17}};
    for (const char* name : {"a", "b", "c"}) {
        Node node{.name = name};
        node.geometry = {{SphereShape{1}, 0, std::vector<Trs>(100'000)}};
        scene.nodes.push_back(node);
    }
    const auto instances = [&](std::size_t node) -> std::vector<Trs>& {
        return scene.nodes[node].geometry[0].instances;
    };
    instances(5)[3] = flat;
    instances(4)[70'000] = flat;
    instances(4)[50'001] = far;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        for (int round = 0; round < 5; ++round) {
            EXPECT_EQ(input_error([&] { (void)prepare(scene); }),
                      "node 4 'b' has coordinates farther than 1e18 from the origin");
        }
    }
    instances(4)[9] = flat;
    EXPECT_EQ(input_error([&] { (void)prepare(scene); }), "node 4 'b' has a sphere that its transform flattens");
    // a mesh of an earlier node comes before
    scene.nodes[3].geometry[0] = {MeshShape{0}, 0, {}};
    scene.nodes[3].trs.scale = {9e17, 1, 1};
    scene.meshes = {{.positions = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}, .triangles = {0, 1, 2}}};
    EXPECT_TRUE(contains(input_error([&] { (void)prepare(scene); }), "node 3 'a' has coordinates farther than"));
    // and so does a light, but not one of a later node
    scene.nodes[2].trs.translation = {9e17, 0, 0};
    scene.nodes[2].parent = 0;
    scene.nodes[0].trs.scale = {2, 2, 2};
    scene.animation.clear();
    EXPECT_TRUE(contains(input_error([&] { (void)prepare(scene); }), "node 2 'lamp' has coordinates farther than"));
}

TEST(PlaceSolids, TheMemoryIsThatOfTheResult) {
    constexpr std::size_t count = 3'000'000;
    const Scene scene = named_scene("spheres/" + std::to_string(count));
    const long before = test::peak_memory();
    const PreparedScene prepared = prepare(scene);
    const long mebibytes = static_cast<long>(count * (sizeof(Sphere) + 2 * sizeof(std::uint32_t)) >> 20);  // 68
    EXPECT_EQ(prepared.spheres.size(), count);
    EXPECT_LT(test::peak_memory() - before, mebibytes + 40) << "beyond what it returns";
}

}  // namespace
}  // namespace tandem
