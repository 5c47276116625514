#include "accuracy/accuracy_scenes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "accuracy/settings.h"
#include "support/input_error.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem::bench {
namespace {

using test::contains;
using test::input_error;

/// The mean radiance of a scene with these limits, on the CPU.
Vec3d mean_of(const AccuracyScene& scene, const PathLimits& limits, int samples) {
    const std::unique_ptr<Backend> cpu = make_backend("cpu");
    RenderJob job;
    job.width = job.height = 16;
    job.samples = samples;
    job.limits = limits;
    const RenderResult result = cpu->render(cpu->load(prepare(scene.scene)), job);
    Vec3d sum{0, 0, 0};
    for (const Vec3d& pixel : result.film.sums()) sum = sum + pixel;
    return sum / (static_cast<double>(result.film.pixel_count()) * samples);
}

TEST(AccuracyScenes, ClosedFormsAreWhatRenderingConvergesTo) {
    for (const char* name : {"closed:furnace/50", "closed:furnace/80", "closed:glass"}) {
        const AccuracyScene scene = load_accuracy_scene(name, {16, 16});
        ASSERT_TRUE(scene.truth) << name;
        EXPECT_NEAR(mean_of(scene, unlimited, 256).x, double{scene.truth->x}, 0.01) << name;
        EXPECT_FALSE(scene.closed_form.empty());
    }
}

TEST(AccuracyScenes, AFurnaceWithoutBouncesShowsItsEmission) {
    const AccuracyScene scene = load_accuracy_scene("closed:furnace/75", {16, 16});
    EXPECT_NEAR(mean_of(scene, unlimited, 256).y, 1, 0.02);
    // direct light is found at the first vertex, by sampling the walls: e + r e
    const double direct = mean_of(scene, {0, 0, 0}, 256).y;
    EXPECT_GE(direct, 0.24);
    EXPECT_LE(direct, 0.25 * 1.75 + 0.02);
}

TEST(AccuracyScenes, RefusesScenesThatItDoesNotKnow) {
    for (const char* name :
         {"closed:furnace/0", "closed:furnace/100", "closed:furnace/5x", "closed:furnace/", "closed:"}) {
        EXPECT_TRUE(contains(input_error([&] { (void)load_accuracy_scene(name, {4, 4}); }), "closed:glass")) << name;
    }
    EXPECT_TRUE(contains(input_error([&] { (void)load_accuracy_scene("named:nothing", {4, 4}); }), "nothing"));
}

TEST(AccuracyScenes, ListHasAnEasyAndAHardSceneForEachAxis) {
    std::set<std::pair<std::string, std::string>> found;
    for (const ListedScene& listed : listed_scenes()) {
        found.emplace(listed.axis, listed.difficulty);
    }
    for (const char* axis : {"samples", "sampler", "filter", "tier", "effects", "depth", "tessellation"}) {
        EXPECT_TRUE(found.contains({axis, "easy"}) && found.contains({axis, "hard"})) << axis;
    }
    const std::filesystem::path repository = std::filesystem::path(TANDEM_SCENES).parent_path().parent_path();
    for (const std::string& name : listed_scene_names()) {
        const bool file = name.starts_with("assets/");
        EXPECT_NO_THROW((void)load_accuracy_scene(file ? (repository / name).string() : name, {16, 16})) << name;
    }
}

TEST(AccuracyScenes, TwinHasTheSpheresAsMeshes) {
    const AccuracyScene paper = load_accuracy_scene("named:paper", {16, 16});
    const std::optional<Scene> twin = tessellated_twin(paper.scene, 2);
    ASSERT_TRUE(twin);
    const PreparedScene prepared = prepare(*twin);
    EXPECT_EQ(primitive_count(prepared), 3U * 320 + 1) << "three spheres, and the cube";
    EXPECT_EQ(triangles_per_sphere(2), 320);
    for (const Vec3f& position : twin->meshes.front().positions) {
        EXPECT_NEAR(dot(widen(position), widen(position)), 0.25, 1e-7);
    }
    EXPECT_FALSE(tessellated_twin(load_accuracy_scene("named:boxes/5", {4, 4}).scene, 2)) << "no sphere";
    Scene textured = paper.scene;
    textured.materials[0].normal_texture.emplace();
    EXPECT_FALSE(tessellated_twin(textured, 2));
}

TEST(AccuracySettings, VaryTheSampler) {
    const SettingPlan plan =
        plan_settings(load_accuracy_scene("named:paper", {4, 4}).scene, parse_axes({"sampler"}, {Tier::strict}));
    ASSERT_EQ(plan.settings.size(), 3U);
    EXPECT_EQ(plan.settings[0].sampler, Sampler::random);
    EXPECT_EQ(plan.settings[1].name, "sobol");
    EXPECT_EQ(plan.settings[2].sampler, Sampler::sobol_blue);
    EXPECT_EQ(plan.settings[2].axis, Axis::sampler);
}

TEST(AccuracySettings, VaryTheFilter) {
    const SettingPlan plan =
        plan_settings(load_accuracy_scene("named:paper", {4, 4}).scene, parse_axes({"filter"}, {Tier::strict}));
    ASSERT_EQ(plan.settings.size(), 4U);
    EXPECT_EQ(plan.settings[0].filter, PixelFilter::box);
    EXPECT_TRUE(has_the_image_of_the_baseline(plan.settings[0]));
    EXPECT_EQ(plan.settings[3].name, "blackman_harris");
    EXPECT_EQ(plan.settings[3].filter, PixelFilter::blackman_harris);
    EXPECT_EQ(plan.settings[3].axis, Axis::filter);
    EXPECT_FALSE(has_the_image_of_the_baseline(plan.settings[3]));
    ASSERT_EQ(plan.biases.size(), 1U);
    EXPECT_TRUE(contains(plan.biases[0], "A filter is a choice of the image"));
}

TEST(AccuracySettings, VaryWhatTheSceneHas) {
    const std::vector<Tier> tiers = {Tier::fast, Tier::strict, Tier::precise};
    const VariedAxes all = parse_axes({"samples", "sampler", "tier", "effects", "depth", "tessellation"}, tiers);
    const SettingPlan paper = plan_settings(load_accuracy_scene("named:paper", {4, 4}).scene, all);
    EXPECT_EQ(paper.settings.front().name, "strict");
    EXPECT_EQ(paper.settings.front().axis, Axis::baseline);
    EXPECT_EQ(paper.settings.size(), 8U) << "tiers, samplers and tessellations";
    EXPECT_EQ(paper.skipped.size(), 5U) << "effects and depth, and what was not asked for";
    const SettingPlan furnace = plan_settings(load_accuracy_scene("closed:furnace/50", {4, 4}).scene, all);
    std::set<Axis> axes;
    for (const Setting& setting : furnace.settings) axes.insert(setting.axis);
    EXPECT_TRUE(axes.contains(Axis::effects) && axes.contains(Axis::depth));
    EXPECT_FALSE(axes.contains(Axis::tessellation));
    const SettingPlan alone = plan_settings(load_accuracy_scene("named:paper", {4, 4}).scene, parse_axes({}, tiers));
    EXPECT_EQ(alone.settings.size(), 1U);
    EXPECT_EQ(alone.skipped.size(), 8U);
    EXPECT_TRUE(contains(input_error([&] { (void)parse_axes({"colour"}, tiers); }), "tessellation"));
    EXPECT_TRUE(contains(input_error([&] { (void)parse_axes({}, {}); }), "fast"));
}

}  // namespace
}  // namespace tandem::bench
