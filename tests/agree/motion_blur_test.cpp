// Motion blur: a closed form, equal bits wherever they are promised, and what leaves the picture as it is.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/backend_list.h"
#include "support/compiled_tiers.h"
#include "support/effect_scenes.h"
#include "support/pixel_index.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/compare.h"
#include "tandem/render/motion_blur.h"
#include "tandem/scene/camera_node.h"
#include "tandem/scene/motion.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

AnimationChannel move(std::size_t node, AnimatedPath path, std::vector<float> values) {
    AnimationChannel channel;
    channel.node = static_cast<std::uint32_t>(node);
    channel.path = path;
    channel.times = {0, 1};
    channel.values = std::move(values);
    return channel;
}

/// Bodies that fly, turn and grow, a light and a camera that move, before a shutter that is open for a twentieth
/// second.
Scene moving_scene() {
    const auto& scenes = test::effect_scenes();
    Scene scene = std::find_if(scenes.begin(), scenes.end(), [](const auto& s) { return s.name == "shadows"; })->scene;
    shutter_of(*scene.nodes[0].camera) = {0.3, 0.35, 3};
    const auto node = [&](const char* name) {
        return static_cast<std::size_t>(
            std::find_if(scene.nodes.begin(), scene.nodes.end(), [&](const Node& n) { return n.name == name; }) -
            scene.nodes.begin());
    };
    scene.animation = {
        move(node("eye"), AnimatedPath::translation, {0.1F, 0.9F, 3.2F, 0.6F, 0.9F, 3.2F}),
        move(node("ball"), AnimatedPath::translation, {-3, 0, 0, 4, 0, 0}),
        move(node("block"), AnimatedPath::rotation, {0, 0, 0, 1, 0, 1, 0, 0}),
        move(node("small ball"), AnimatedPath::scale, {1, 1, 1, 3, 1, 2}),
        move(node("lamp"), AnimatedPath::translation, {1.5F, 3, 2, -1.5F, 3, 2}),
    };
    return scene;
}

class MotionBlur : public test::ExactBackend {
  protected:
    [[nodiscard]] RenderJob job() const {
        RenderJob job;
        job.width = 61;
        job.height = 43;
        job.samples = 7;
        job.seed = 3;
        job.tier = GetParam().tier;
        return job;
    }
    [[nodiscard]] std::string hash(const Scene& scene, const ForcedEffects& effects = {}) {
        return film_hash(render_frame(*backend_, scene, {.effects = effects}, job()).result.film);
    }
};

// A bright ball flies over a black film: a point of its track is bright for as long as the ball needs to pass it. The
// share of time that rows of the track are bright, over a width that is a multiple of the way between two instants, has
// a closed form for any number of instants.
TEST_P(MotionBlur, SpreadsABallOverItsTrack) {
    constexpr double radius = 0.25, way = 2;  // metres; the way while the shutter is open
    constexpr int size = 64, samples = 64;
    Scene scene;
    scene.environment = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    scene.materials = {{"lamp", {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 1}}};
    scene.materials[0].optics.emission = {1, 1, 1};
    Node eye{.name = "eye", .trs = {.translation = {0, 0, 5}}, .camera = OrthographicCamera{1, {0, 0.5, 16}}};
    Node ball{.name = "ball"};
    ball.geometry.push_back({SphereShape{radius}, 0, {}});
    scene.nodes = {eye, ball};
    scene.animation = {move(1, AnimatedPath::translation, {-1, 0, 0, 3, 0, 0})};
    RenderJob job;
    job.width = job.height = size;
    job.samples = samples;
    job.tier = GetParam().tier;
    const RenderedFrame frame = render_frame(*backend_, scene, {}, job);
    EXPECT_EQ(frame.result.stats.counters, RenderCounters{});
    const std::span<const Vec3d> sums = frame.result.film.sums();
    // the area of a disc between its horizontal diameter and a height
    const auto area_below = [&radius](double y) {
        y = std::clamp(y, -radius, radius);
        return y * std::sqrt(radius * radius - y * y) + radius * radius * std::asin(y / radius);
    };
    for (int row = 0; row < size; row += 2) {
        double sum = 0;
        for (int y = row; y < row + 2; ++y) {
            for (int x = size / 4; x < 3 * size / 4; ++x) sum += sums[test::pixel_index(x, y, size)].x;
        }
        const double count = samples * 2.0 * size / 2;
        const double top = 1 - 2.0 * row / size, bottom = top - 4.0 / size;
        const double expected = (area_below(top) - area_below(bottom)) / ((top - bottom) * way);
        const double error = std::sqrt(expected * (1 - expected) / count);  // of samples without strata: theirs is less
        EXPECT_NEAR(sum / count, expected, 5 * error) << "rows " << row << " and the next";
    }
}

TEST_P(MotionBlur, HasTheBitsOfTheLeastProcessor) {
    BackendOptions least;
    least.instruction_set = "x86-64-v2";
    const auto reference = make_backend("cpu", least);
    const Film expected = render_frame(*reference, moving_scene(), {}, job()).result.film;
    const RenderResult result = render_frame(*backend_, moving_scene(), {}, job()).result;
    EXPECT_EQ(film_hash(result.film), film_hash(expected));
    EXPECT_EQ(result.stats.effects, Effect::shadows | Effect::motion_blur);
    EXPECT_FALSE(result.stats.carried.has(Effect::motion_blur)) << "no kernel does";
    EXPECT_EQ(result.stats.counters, RenderCounters{});
}

TEST_P(MotionBlur, IsTheSumOfItsInstants) {
    const Scene scene = moving_scene();
    Film expected(61, 43, 7);
    // 7 samples among 3 instants: 2, 2 and 3, each of a seventh of the interval
    const int first[] = {0, 2, 4, 7};
    for (int i = 0; i < 3; ++i) {
        RenderJob part = job();
        part.first_sample = first[i];
        part.samples = first[i + 1] - first[i];
        const double time = 0.3 + (0.35 - 0.3) * (0.5 * (first[i] + first[i + 1]) / 7);
        const Film film = backend_->render(load(prepare(scene, {.time = time})), part).film;
        for (std::size_t p = 0; p < film.pixel_count(); ++p) {
            expected.sums()[p] = expected.sums()[p] + film.sums()[p];
        }
    }
    EXPECT_EQ(hash(scene), film_hash(expected));
}

TEST_P(MotionBlur, OfNothingThatMovesChangesNoBit) {
    Scene scene = moving_scene();
    Scene closed = scene;
    shutter_of(*closed.nodes[0].camera) = {};
    const std::string sharp = film_hash(backend_->render(load(prepare(closed)), job()).film);
    EXPECT_EQ(hash(closed), sharp);
    EXPECT_EQ(hash(closed, {Effect::motion_blur, {}}), sharp) << "forced on";
    EXPECT_EQ(hash(scene, {{}, Effect::motion_blur}), sharp) << "forced off";
    EXPECT_NE(hash(scene), sharp);
    scene.animation.clear();
    closed.animation.clear();
    EXPECT_EQ(hash(scene), hash(closed));
}

TEST_P(MotionBlur, NeedsNoLargerKernel) {
    Scene scene = named_scene("paper");  // whose bodies and light move
    shutter_of(*scene.nodes[camera_node(scene, "")].camera) = {0, 0.02};
    const RenderStats stats = render_frame(*backend_, scene, {}, job()).result.stats;
    EXPECT_EQ(stats.effects, EffectMask(Effect::motion_blur));
    const bool is_linked = GetParam().backend == "cuda" && !test::is_compiled(GetParam().tier);
    EXPECT_TRUE(stats.variant.ends_with(is_linked ? "for the scene" : "plain")) << stats.variant;
    EXPECT_TRUE(stats.carried.empty());
}

TEST_P(MotionBlur, IsNearTheOracle) {
    const auto oracle = make_backend("oracle");
    const Film expected = render_frame(*oracle, moving_scene(), {}, job()).result.film;
    const Film film = render_frame(*backend_, moving_scene(), {}, job()).result.film;
    const FilmDifference difference = compare(film, expected);
    const bool precise = GetParam().tier == Tier::precise;
    EXPECT_LE(difference.residual_rate(Tolerance::one_level), precise ? 5e-4 : 1e-2);
    EXPECT_LE(difference.mean, precise ? 1e-5 : 2e-4);
}

INSTANTIATE_TEST_SUITE_P(Backends, MotionBlur, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

}  // namespace
}  // namespace tandem
