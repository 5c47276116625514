#include "tandem/compile/copies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "support/random.h"
#include "support/scenes.h"
#include "support/thread_limit.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/render/traced_job.h"

namespace tandem {
namespace {

using test::small_scene;

std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(const std::vector<PrimitiveCopy>& copies) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> result;
    result.reserve(copies.size());
    for (const PrimitiveCopy& copy : copies) result.emplace_back(copy.id, copy.of);
    return result;
}

PreparedScene spheres(const std::vector<Sphere>& list, const std::vector<std::uint32_t>& materials) {
    PreparedScene scene;
    scene.spheres = list;
    scene.material_of = materials;
    scene.node_of.assign(list.size(), 0);
    for (std::uint32_t i = 0; i < list.size(); ++i) scene.node_of[i] = i;
    scene.materials.resize(2);
    scene.optics.resize(2);
    return scene;
}

TEST(Copies, AreOfOneShapeAndMaterial) {
    const Sphere a = {{1, 2, 3}, 1}, b = {{1, 2, 3}, 2}, zero = {{0, 0, 0}, 1}, minus = {{-0.0F, 0, 0}, 1};
    const auto copies = find_copies(spheres({a, b, a, a, zero, b, minus}, {0, 0, 1, 0, 0, 0, 0}));
    EXPECT_EQ(pairs(copies), (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{3, 0}, {5, 1}}));
}

TEST(Copies, AreFoundAmongFacesWithSidesAndAlphaMasks) {
    Scene scene = small_scene();
    scene.meshes.push_back({.name = "sheet",
                            .positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                            .texcoords = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}},
                            .triangles = {0, 1, 2, 0, 1, 2},
                            .quads = {0, 1, 2, 3, 0, 1, 2, 3, 1, 2, 3, 0}});
    const auto mesh = static_cast<std::uint32_t>(scene.meshes.size() - 1);
    scene.nodes[1].geometry[0].shape = MeshShape{mesh};
    PreparedScene prepared = prepare(scene);
    const auto first = static_cast<std::uint32_t>(primitive_count(prepared) - 5);
    EXPECT_EQ(pairs(prepared.copies),
              (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{first + 1, first}, {first + 3, first + 2}}));
    prepared.quads[1].attributes.sides = FaceSides::double_sided;
    EXPECT_EQ(find_copies(prepared).size(), 1U);
}

TEST(Copies, AreTakenOutAndTheIdsStay) {
    for (std::uint64_t number = 0; number < 200; ++number) {
        test::Random random(number);
        std::vector<Sphere> list;
        const std::uint32_t count = 1 + random.below(60);
        for (std::uint32_t i = 0; i < count; ++i) list.push_back({{static_cast<float>(random.below(12)), 0, 0}, 1});
        PreparedScene scene = spheres(list, std::vector<std::uint32_t>(count, 0));
        scene.copies = find_copies(scene);
        const PreparedScene unique = without_copies(scene);
        ASSERT_EQ(unique.spheres.size() + scene.copies.size(), count);
        ASSERT_TRUE(find_copies(unique).empty());
        const TracedIds ids(scene.copies);
        for (std::uint32_t id = 0; id < count; ++id) {
            const std::uint32_t traced = ids.traced(id), back = ids.of_scene(traced);
            ASSERT_LT(traced, unique.spheres.size()) << number;
            ASSERT_EQ(unique.spheres[traced].centre, list[id].centre) << number;
            ASSERT_LE(back, id);
            ASSERT_EQ(list[back].centre, list[id].centre) << number;
            ASSERT_EQ(unique.node_of[traced], back) << number;
        }
        ASSERT_EQ(ids.traced(no_primitive), no_primitive);
        ASSERT_EQ(ids.of_scene(some_primitive), some_primitive);
    }
}

TEST(Copies, AreFoundAmongManyOnAnyNumberOfThreads) {
    test::Random random(3);
    std::vector<Sphere> list;
    for (std::uint32_t i = 0; i < 200'000; ++i) {
        // every fourth repeats an earlier one
        const bool repeats = i > 0 && i % 4 == 3;
        const auto number = [&] { return random.uniform(-1.0F, 1.0F); };
        list.push_back(repeats ? list[random.below(i)] : Sphere{{number(), number(), number()}, 1});
    }
    const std::vector<std::uint32_t> materials(list.size(), 0);
    // the first with the same bytes, by a map
    std::map<std::array<float, 4>, std::uint32_t> first;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> expected;
    for (std::uint32_t i = 0; i < list.size(); ++i) {
        const Vec3f& c = list[i].centre;
        const auto [known, is_new] = first.try_emplace({c.x, c.y, c.z, list[i].radius}, i);
        if (!is_new) expected.emplace_back(i, known->second);
    }
    EXPECT_GE(expected.size(), 50'000U);
    for (const int threads : {1, 2, 7}) {
        const test::ThreadLimit limit(threads);
        EXPECT_EQ(pairs(find_copies(spheres(list, materials))) == expected, true) << threads;
    }
    const test::ThreadLimit limit(7);
    const auto equal = find_copies(spheres(std::vector<Sphere>(150'000, list[0]), materials));
    ASSERT_EQ(equal.size(), 149'999U);
    for (const PrimitiveCopy& copy : equal) ASSERT_EQ(copy.of, 0U);
}

TEST(Copies, AreNoLightsOfTheirOwn) {
    Scene scene = small_scene();
    scene.materials[0].optics.emission = {1, 1, 1};
    Geometry ball = {SphereShape{0.5}, 0, std::vector<Trs>(3)};
    ball.instances[1].translation = {1, 0, 0};
    scene.nodes[1].geometry = {ball};
    const PreparedScene prepared = prepare(scene);
    ASSERT_EQ(prepared.copies.size(), 1U);
    std::vector<std::uint32_t> lights;
    for (const AreaLight& light : prepared.area_lights) lights.push_back(light.primitive);
    const std::uint32_t copy = prepared.copies[0].id;
    EXPECT_EQ(std::count(lights.begin(), lights.end(), copy), 0);
    EXPECT_EQ(std::count(lights.begin(), lights.end(), prepared.copies[0].of), 1);
}

}  // namespace
}  // namespace tandem
