#include "tandem/scene/animation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/scenes.h"

namespace tandem {
namespace {

/// A scene whose node 0 has one channel.
Scene driven(AnimatedPath path, Interpolation interpolation, std::vector<float> times, std::vector<float> values) {
    Scene scene;
    scene.nodes.resize(1);
    AnimationChannel channel;
    channel.path = path;
    channel.interpolation = interpolation;
    channel.times = std::move(times);
    channel.values = std::move(values);
    scene.animation = {channel};
    EXPECT_TRUE(validate(scene).empty());
    return scene;
}

Transform at(const Scene& scene, double time) { return parents_from_nodes(scene, time).front(); }

/// The angle in degrees by which a rotation about z turns x.
double z_angle(const Transform& t) { return std::atan2(t.linear.row[1].x, t.linear.row[0].x) * 180 / std::numbers::pi; }

std::vector<float> about_z(double degrees, double sign = 1) {
    const double half = degrees * std::numbers::pi / 360;
    return {0, 0, static_cast<float>(sign * std::sin(half)), static_cast<float>(sign * std::cos(half))};
}

std::vector<float> joined(const std::vector<std::vector<float>>& parts) {
    std::vector<float> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

TEST(Animation, StepHoldsTheKeyBefore) {
    const Scene scene = driven(AnimatedPath::translation, Interpolation::step, {1, 2}, {1, 2, 3, 4, 5, 6});
    EXPECT_EQ(at(scene, 0).translation, Vec3d(1, 2, 3));
    EXPECT_EQ(at(scene, 1).translation, Vec3d(1, 2, 3));
    EXPECT_EQ(at(scene, 1.999).translation, Vec3d(1, 2, 3));
    EXPECT_EQ(at(scene, 2).translation, Vec3d(4, 5, 6));
    EXPECT_EQ(at(scene, 9).translation, Vec3d(4, 5, 6));
}

TEST(Animation, LinearMixesTwoKeys) {
    const Scene scene = driven(AnimatedPath::scale, Interpolation::linear, {0, 4}, {1, 2, 4, 5, 2, 8});
    EXPECT_EQ(at(scene, 1).linear.row[0], Vec3d(2, 0, 0));
    EXPECT_EQ(at(scene, 1).linear.row[1], Vec3d(0, 2, 0));
    EXPECT_EQ(at(scene, 1).linear.row[2], Vec3d(0, 0, 5));
}

/// Hermite's basis at 1/2 is 1/2, 1/8, 1/2, -1/8; the tangents count by the seconds between the keys.
TEST(Animation, CubicIsHermitesSpline) {
    const Scene scene = driven(AnimatedPath::translation, Interpolation::cubic, {0, 2},
                               {9, 9, 9, 1, 2, 3, 4, 0, 0, 8, 0, 0, 5, 6, 7, 9, 9, 9});
    EXPECT_EQ(at(scene, 1).translation, Vec3d(3 + 2 * (4 - 8) / 8.0, 4, 5));
    EXPECT_EQ(at(scene, 0).translation, Vec3d(1, 2, 3));
    EXPECT_EQ(at(scene, 2).translation, Vec3d(5, 6, 7));
    EXPECT_EQ(at(scene, -1).translation, Vec3d(1, 2, 3));
    EXPECT_EQ(at(scene, 3).translation, Vec3d(5, 6, 7));
}

TEST(Animation, RotationsTakeTheShorterArcAtConstantSpeed) {
    // 20 and 200 degrees from there: the second key is given as -q, which is the same rotation
    for (const double sign : {1.0, -1.0}) {
        const Scene scene =
            driven(AnimatedPath::rotation, Interpolation::linear, {0, 1}, joined({about_z(20), about_z(140, sign)}));
        EXPECT_NEAR(z_angle(at(scene, 0.25)), 50, 1e-5);
        EXPECT_NEAR(z_angle(at(scene, 0.5)), 80, 1e-5);
    }
    const Scene back =
        driven(AnimatedPath::rotation, Interpolation::linear, {0, 1}, joined({about_z(0), about_z(270)}));
    EXPECT_NEAR(z_angle(at(back, 0.5)), -45, 1e-5);
}

TEST(Animation, EqualRotationsStay) {
    const Scene scene =
        driven(AnimatedPath::rotation, Interpolation::linear, {0, 1}, joined({about_z(33), about_z(33)}));
    EXPECT_NEAR(z_angle(at(scene, 0.7)), 33, 1e-5);
}

TEST(Animation, CubicRotationsAreNormalised) {
    const Scene scene =
        driven(AnimatedPath::rotation, Interpolation::cubic, {0, 1},
               joined({{0, 0, 0, 0}, about_z(0), {0, 0, 0, 0}, {0, 0, 0, 0}, about_z(90), {0, 0, 0, 0}}));
    const Transform half = at(scene, 0.5);
    EXPECT_NEAR(z_angle(half), 45, 1e-5);
    EXPECT_NEAR(determinant(half.linear), 1, 1e-12);
}

/// A key that was written for a frame is hit to the last bit, at any frame rate.
TEST(Animation, FramesHitTheirKeysExactly) {
    for (const double rate : {24.0, 25.0, 30.0, 29.97, 60.0, 7.0}) {
        std::vector<float> times;
        std::vector<float> values;
        for (int frame = 0; frame < 240; ++frame) {
            times.push_back(static_cast<float>(frame / rate));
            const float value = 1.0F / static_cast<float>(frame + 3);
            for (int i = 0; i < 3; ++i) values.push_back(value);
        }
        for (const Interpolation kind : {Interpolation::step, Interpolation::linear}) {
            Scene scene = driven(AnimatedPath::translation, kind, times, values);
            scene.frames_per_second = rate;
            for (int frame = 0; frame < 240; ++frame) {
                ASSERT_EQ(at(scene, time_of_frame(scene, frame)).translation.x,
                          double{values[static_cast<std::size_t>(frame) * 3]})
                    << "frame " << frame << " at " << rate << " a second";
            }
        }
    }
}

TEST(Animation, LeavesOtherPathsAndNodesAlone) {
    Scene scene = driven(AnimatedPath::translation, Interpolation::step, {0}, {1, 1, 1});
    scene.nodes.resize(2);
    scene.nodes[0].trs.scale = {2, 3, 4};
    scene.nodes[1].trs.translation = {7, 8, 9};
    const auto placed = parents_from_nodes(scene, 0);
    EXPECT_EQ(placed[0].linear.row[1], Vec3d(0, 3, 0));
    EXPECT_EQ(placed[0].translation, Vec3d(1, 1, 1));
    EXPECT_EQ(placed[1].translation, Vec3d(7, 8, 9));
}

}  // namespace
}  // namespace tandem
