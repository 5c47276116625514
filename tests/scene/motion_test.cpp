// What moves within an interval, and how a frame is shared among instants.

#include "tandem/scene/motion.h"

#include <gtest/gtest.h>

#include "support/gradient_backend.h"
#include "support/scenes.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/render/motion_blur.h"
#include "tandem/scene/animation.h"
#include "tandem/scene/camera_node.h"

namespace tandem {
namespace {

using test::small_scene;

AnimationChannel channel(AnimatedPath path, Interpolation interpolation, std::vector<float> times,
                         std::vector<float> values) {
    AnimationChannel result;
    result.path = path;
    result.interpolation = interpolation;
    result.times = std::move(times);
    result.values = std::move(values);
    return result;
}

TEST(ChangesBetween, LooksAtThePartsOfALine) {
    const auto move =
        channel(AnimatedPath::translation, Interpolation::linear, {1, 2, 3, 4}, {0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0});
    EXPECT_FALSE(changes_between(move, 0, 1));
    EXPECT_TRUE(changes_between(move, 0, 1.001));
    EXPECT_TRUE(changes_between(move, 1.5, 1.6));
    EXPECT_FALSE(changes_between(move, 2, 3));
    EXPECT_TRUE(changes_between(move, 1.999, 2.5));
    EXPECT_TRUE(changes_between(move, -9, 9)) << "there and back";
    EXPECT_FALSE(changes_between(move, 4, 9));
}

TEST(ChangesBetween, LooksAtTheKeysOfSteps) {
    const auto step = channel(AnimatedPath::scale, Interpolation::step, {1, 2, 3}, {1, 1, 1, 1, 1, 1, 2, 2, 2});
    EXPECT_FALSE(changes_between(step, 0, 3));
    EXPECT_TRUE(changes_between(step, 2.5, 3.001));
    EXPECT_FALSE(changes_between(step, 3, 4));
}

TEST(ChangesBetween, LooksAtTheTangentsOfSplines) {
    const auto spline = [](float tangent) {
        return channel(AnimatedPath::translation, Interpolation::cubic, {0, 1},
                       {9, 9, 9, 1, 1, 1, 0, tangent, 0, 0, -tangent, 0, 1, 1, 1, 9, 9, 9});
    };
    EXPECT_TRUE(changes_between(spline(1), 0.2, 0.3)) << "equal values, but an arc between them";
    EXPECT_FALSE(changes_between(spline(0), 0, 1)) << "tangents outside of the keys do not matter";
}

TEST(ChangesBetween, KnowsThatAQuaternionAndItsNegativeAreOneRotation) {
    const auto turn = [](float sign) {
        return channel(AnimatedPath::rotation, Interpolation::linear, {0, 1},
                       {0.5F, 0.5F, 0.5F, 0.5F, sign * 0.5F, sign * 0.5F, sign * 0.5F, 0.5F * sign});
    };
    EXPECT_FALSE(changes_between(turn(1), 0, 1));
    EXPECT_FALSE(changes_between(turn(-1), 0, 1));
    AnimationChannel other = turn(-1);
    other.values[7] = 0.5F;
    EXPECT_TRUE(changes_between(other, 0, 1));
}

TEST(ParentsFirst, PutsEveryNodeBehindItsParent) {
    Scene scene;
    scene.nodes.resize(5);
    scene.nodes[0].parent = 3;
    scene.nodes[3].parent = 4;
    scene.nodes[1].parent = 0;
    EXPECT_EQ(parents_first(scene), (std::vector<std::size_t>{4, 3, 0, 1, 2}));
}

TEST(CameraNode, IsTheFirstOrTheNamed) {
    Scene scene = small_scene();
    scene.nodes[2].camera = OrthographicCamera{};
    EXPECT_EQ(camera_node(scene, ""), 0U);
    EXPECT_EQ(camera_node(scene, "lamp"), 2U);
    EXPECT_EQ(test::thrown_message<InputError>([&] { (void)camera_node(scene, "body"); }),
              "the scene has no camera 'body'; it has 'eye', 'lamp'");
}

/// The light of small_scene() moves from 0 s to 3 s.
Scene open_scene(const Shutter& shutter) {
    Scene scene = small_scene();
    shutter_of(*scene.nodes[0].camera) = shutter;
    return scene;
}

RenderJob job_of(int samples) {
    RenderJob job;
    job.width = 5;
    job.height = 4;
    job.samples = samples;
    return job;
}

TEST(PlanFrame, TakesTheMiddlesOfEqualParts) {
    const FramePlan plan = plan_frame(open_scene({-0.1, 0.3, 4}), {.frame = 24}, job_of(8));
    EXPECT_TRUE(is_blurred(plan));
    EXPECT_EQ(plan.effects, EffectMask(Effect::motion_blur));
    ASSERT_EQ(plan.instants.size(), 4U);
    for (int i = 0; i < 4; ++i) {
        const FrameInstant& instant = plan.instants[static_cast<std::size_t>(i)];
        EXPECT_DOUBLE_EQ(*instant.prepare.time, 1 - 0.1 + 0.4 * (i + 0.5) / 4);
        EXPECT_EQ(instant.job.first_sample, 2 * i);
        EXPECT_EQ(instant.job.samples, 2);
    }
}

TEST(PlanFrame, SharesSamplesThatCannotBeDivided) {
    RenderJob job = job_of(7);
    job.first_sample = 100;
    const FramePlan plan = plan_frame(open_scene({0, 0.7, 3}), {}, job);
    ASSERT_EQ(plan.instants.size(), 3U);
    int next = 100;
    for (const FrameInstant& instant : plan.instants) {
        EXPECT_EQ(instant.job.first_sample, next);
        const double middle = next - 100 + 0.5 * instant.job.samples;
        EXPECT_NEAR(*instant.prepare.time, 0.1 * middle, 1e-15) << "each sample stands for 0.1 s";
        next += instant.job.samples;
    }
    EXPECT_EQ(next, 107);
    EXPECT_EQ(plan_frame(open_scene({0, 0.7, 3}), {}, job_of(2)).instants.size(), 2U) << "no more than samples";
}

TEST(PlanFrame, LeavesAFrameWithoutMotionAsItIs) {
    const auto is_whole = [](const Scene& scene, const PrepareOptions& options) {
        const FramePlan plan = plan_frame(scene, options, job_of(9));
        return !is_blurred(plan) && plan.instants.size() == 1 && plan.instants[0].job.samples == 9;
    };
    EXPECT_TRUE(is_whole(open_scene({0.5, 0.5}), {})) << "closed";
    EXPECT_TRUE(is_whole(open_scene({0, 0.1}), {.frame = 24 * 3})) << "at rest";
    EXPECT_FALSE(is_whole(open_scene({0, 0.1}), {}));
    PrepareOptions off;
    off.effects.off = Effect::motion_blur;
    EXPECT_TRUE(is_whole(open_scene({0, 0.1}), off)) << "forced off";
    PrepareOptions on;
    on.effects.on = Effect::motion_blur;
    EXPECT_TRUE(is_whole(open_scene({0, 0}), on)) << "forced on, and nothing to do";
    EXPECT_EQ(plan_frame(open_scene({0, 0}), on, job_of(9)).effects, EffectMask(Effect::motion_blur));
}

TEST(PlanFrame, RefusesWhatCannotBe) {
    EXPECT_THROW((void)plan_frame(open_scene({0, 1}), {}, job_of(0)), InputError);
    EXPECT_THROW((void)plan_frame(open_scene({0, 1}), {.camera = "nobody"}, job_of(1)), InputError);
    Scene broken = open_scene({0, 1});
    broken.animation[0].values.clear();
    EXPECT_THROW((void)plan_frame(broken, {}, job_of(1)), InputError);
}

TEST(FrameHash, IsThatOfTheSceneWithoutBlurAndElseOfItsInstants) {
    const auto hash = [](const Scene& scene, int samples = 8) {
        return frame_hash(scene, plan_frame(scene, {}, job_of(samples)));
    };
    EXPECT_EQ(hash(open_scene({0, 0})), scene_hash(prepare(small_scene())));
    const std::string blurred = hash(open_scene({0, 0.1, 4}));
    EXPECT_EQ(blurred, hash(open_scene({0, 0.1, 4})));
    EXPECT_NE(blurred, hash(open_scene({0, 0.1, 3})));
    EXPECT_NE(blurred, hash(open_scene({0, 0.2, 4})));
    EXPECT_NE(blurred, hash(open_scene({0.1, 0.2, 4})));
    Scene later = open_scene({0, 0.1, 4});
    later.animation[0].values[3] = 3;  // only the instants can tell
    EXPECT_NE(blurred, hash(later));
}

TEST(RenderFrame, AddsFilmsAndCounts) {
    test::GradientBackend backend;
    RenderJob job = job_of(8);
    job.frame = 2;
    const RenderedFrame frame = render_frame(backend, open_scene({0, 0.1, 4}), {}, job);
    EXPECT_EQ(backend.submitted, 4);
    EXPECT_EQ(backend.most_in_flight, 2);
    EXPECT_EQ(frame.result.film.samples(), 8);
    const Film expected = test::gradient_film(job);
    for (std::size_t i = 0; i < expected.pixel_count(); ++i) {
        EXPECT_NEAR(frame.result.film.sums()[i].x, expected.sums()[i].x, 1e-14);
    }
    EXPECT_EQ(frame.result.stats.counters.invalid_samples, 4U * 2);
    EXPECT_EQ(frame.result.stats.seconds.render, 2.0);
    EXPECT_EQ(frame.load.build, 1.0);
    EXPECT_EQ(frame.result.stats.variant, "gradient") << "named once";
    EXPECT_EQ(frame.result.stats.effects, EffectMask(Effect::motion_blur));
    const RenderedFrame still = render_frame(backend, small_scene(), {}, job);
    EXPECT_EQ(film_hash(still.result.film), film_hash(expected));
}

TEST(Prepare, AtAnInstantTheShutterIsClosed) {
    const Scene scene = open_scene({0, 0.1});
    const PreparedScene instant = prepare(scene, {.time = 0.25});
    EXPECT_EQ(world_from_render(instant, widen(instant.lights[0].position)), Vec3d(0.5, 1, 1.5));
    EXPECT_FALSE(is_open(instant.shutter));
    EXPECT_TRUE(is_open(prepare(scene).shutter));
}

}  // namespace
}  // namespace tandem
