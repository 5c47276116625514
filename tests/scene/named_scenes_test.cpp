#include "tandem/scene/named_scenes.h"

#include <gtest/gtest.h>

#include "support/scenes.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/math/lengths.h"

namespace tandem {
namespace {

using test::contains;

TEST(NamedScenes, PaperIsTheScenarioOfThePaper) {
    const Scene scene = named_scene("paper");
    EXPECT_TRUE(validate(scene).empty());
    EXPECT_EQ(frame_count(scene), 120);
    const auto prepared = prepare(scene, {30, ""});
    EXPECT_EQ(prepared.spheres.size(), 3U);
    ASSERT_EQ(prepared.boxes.size(), 1U);
    EXPECT_NEAR(prepared.boxes[0].lower.y, 0.5, 1e-6);  // 0.8 up, half a side of 0.6 down
    EXPECT_NEAR(prepared.lights[0].position.z, -1, 1e-6);
    EXPECT_NEAR(prepared.camera.half_height, 1 / 1.5, 1e-15);
}

TEST(NamedScenes, CrowdsHaveWhatTheirNamesSay) {
    EXPECT_EQ(prepare(named_scene("spheres/100")).spheres.size(), 100U);
    const PreparedScene giant = prepare(named_scene("giant/40"));
    ASSERT_EQ(giant.spheres.size(), 41U);
    EXPECT_EQ(giant.spheres.back().radius, 1e6F);
    EXPECT_EQ(prepare(named_scene("boxes/100")).parallelepipeds.size(), 100U);
    const auto mixed = prepare(named_scene("mixed/103"));
    EXPECT_EQ(mixed.spheres.size(), 26U);
    EXPECT_EQ(mixed.boxes.size(), 26U);
    EXPECT_EQ(mixed.ellipsoids.size(), 26U);
    EXPECT_EQ(mixed.parallelepipeds.size(), 25U);
    EXPECT_EQ(mixed.materials.size(), 8U);
}

TEST(NamedScenes, FacesAreWhatTheirNamesSay) {
    const auto triangles = prepare(named_scene("triangles/100"));
    EXPECT_EQ(triangles.triangles.size(), 100U);
    EXPECT_EQ(triangles.triangles[0].attributes.sides, FaceSides::double_sided);
    EXPECT_EQ(prepare(named_scene("quads/3")).quads.size(), 3U);
    const PreparedScene hair = prepare(named_scene("hair/1000"));
    EXPECT_EQ(hair.triangles.size(), 1000U);
    EXPECT_NEAR(length(widen(hair.triangles[7].v1 - hair.triangles[7].v0)), 0.48, 1e-6);
    EXPECT_NEAR(length(widen(hair.triangles[7].v2 - hair.triangles[7].v0)), 0.48e-3, 1e-6);
    const PreparedScene leaves = prepare(named_scene("leaves/40"));
    EXPECT_EQ(leaves.quads.size(), 40U);
    EXPECT_EQ(leaves.masked_kinds, PrimitiveKinds::quad);
    EXPECT_TRUE(leaves.effects.covers(Effect::shadows | Effect::cutouts));
    const auto ball = prepare(named_scene("icosphere/2"));
    EXPECT_EQ(ball.triangles.size(), 320U);
    EXPECT_EQ(ball.normals.size(), 960U);
    EXPECT_EQ(ball.dropped_primitives, 0U);
    for (const char* name : {"icosphere", "icosphere/", "icosphere/11", "icosphere/-1", "icosphere/2/1", "quads/0"}) {
        EXPECT_TRUE(contains(test::input_error([&] { (void)named_scene(name); }), "icosphere/LEVEL")) << name;
    }
}

TEST(NamedScenes, BlocksAndCitiesAreInstancesInTheirCells) {
    for (const char* name : {"block/125", "city/121"}) {
        const Scene scene = named_scene(name);
        const bool is_city = name[0] == 'c';
        const PreparedScene prepared = prepare(scene);
        EXPECT_EQ(prepared.instances.instances.size(), is_city ? 121U : 125U);
        EXPECT_EQ(prepared.instances.faces.size(), 20480U);
        const double cell = 2.0 / (is_city ? 11 : 5);
        Vec3d least{9, 9, 9}, most{-9, -9, -9};
        for (const Trs& trs : scene.nodes.at(2).geometry.at(0).instances) {
            for (int i = 0; i < 3; ++i) {
                least[i] = lesser(least[i], trs.translation[i]);
                most[i] = greater(most[i], trs.translation[i]);
            }
        }
        for (int i = 0; i < 3; ++i) {
            const double edge = is_city && i == 1 ? 0 : 1 - cell / 2;
            EXPECT_NEAR(least[i], -edge, 0.21 * cell) << name << ", axis " << i;
            EXPECT_NEAR(most[i], edge, 0.21 * cell) << name << ", axis " << i;
        }
    }
    EXPECT_TRUE(contains(test::input_error([&] { (void)named_scene("city/0"); }), "city/N"));
}

TEST(NamedScenes, ForestsAreInstancesWithAlphaMasks) {
    const PreparedScene forest = prepare(named_scene("forest/1000"));
    EXPECT_EQ(forest.instances.instances.size(), 1000U);
    EXPECT_EQ(forest.instances.faces.size(), 2000U);
    EXPECT_EQ(forest.masked_kinds, PrimitiveKinds::triangle);
    EXPECT_EQ(primitive_count(forest), 1U);
    EXPECT_TRUE(forest.effects.covers(Effect::shadows | Effect::cutouts));
}

TEST(NamedScenes, SeedsMakeOtherScenesAndNamesTheSame) {
    const auto hash = [](const char* name) { return scene_hash(prepare(named_scene(name))); };
    EXPECT_EQ(hash("mixed/50"), hash("mixed/50/1"));
    EXPECT_NE(hash("mixed/50/1"), hash("mixed/50/2"));
}

TEST(NamedScenes, RefuseOtherNames) {
    for (const char* name : {"", "papers", "spheres", "spheres/", "spheres/0", "spheres/-1", "spheres/1x",
                             "spheres/100000001", "spheres/1/0", "spheres/1/2/3", "cubes/3"}) {
        EXPECT_TRUE(contains(test::input_error([&] { (void)named_scene(name); }), "paper, hard/planet")) << name;
    }
}

TEST(LoadScene, TakesNamesAndFiles) {
    ImportReport report;
    EXPECT_EQ(load_scene("named:paper", &report).name, "paper");
    EXPECT_TRUE(report.notes().empty());
    EXPECT_TRUE(contains(test::input_error([] { (void)load_scene("named:none"); }), "there is no scene 'none'"));
    EXPECT_TRUE(contains(test::input_error([] { (void)load_scene("no/such.gltf"); }), "cannot read 'no/such.gltf'"));
}

}  // namespace
}  // namespace tandem
