#include "tandem/render/ray_cost.h"

#include <gtest/gtest.h>

#include "support/crowded_scene.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

TEST(BoundsPerRay, AreFewInASceneOfManySmallBodies) {
    const double bounds = bounds_per_ray(prepare(named_scene("spheres/100000")), 100, 90);
    EXPECT_GT(bounds, 1);
    EXPECT_LT(bounds, most_bounds_per_ray / 10);
}

TEST(BoundsPerRay, AreAllWhereAllOverlap) {
    // the second is more than are looked at one by one
    for (const int count : {3, 70'000}) {
        EXPECT_EQ(bounds_per_ray(prepare(test::crowded_scene(count)), 20, 10), count);
    }
}

TEST(BoundsPerRay, BehindTheCameraDoNotCount) {
    Scene scene = test::crowded_scene(3);
    scene.nodes[0].trs.translation.z = -100;
    EXPECT_EQ(bounds_per_ray(prepare(scene), 20, 10), 0);
}

TEST(BoundsPerRay, AreNoneWithoutPrimitives) { EXPECT_EQ(bounds_per_ray(prepare(test::crowded_scene(0)), 20, 10), 0); }

TEST(AffordableSamples, AreInProportionToTheWorkAndOneAtLeast) {
    EXPECT_EQ(affordable_samples(100, most_bounds_per_ray), 100);
    EXPECT_EQ(affordable_samples(100, 2 * most_bounds_per_ray), 50);
    EXPECT_EQ(affordable_samples(100, 1e9), 1);
}

TEST(AffordableLimits, AreThoseOfShortPathsWhereOneSampleIsTooMuch) {
    EXPECT_EQ(affordable_limits({8, 16, 4}, 100, 100 * most_bounds_per_ray), (PathLimits{8, 16, 4}));
    EXPECT_EQ(affordable_limits({8, 16, 4}, 100, 101 * most_bounds_per_ray), (PathLimits{1, 1, 0}));
    EXPECT_EQ(affordable_limits({0, 16, 4}, 100, 1e9), (PathLimits{0, 1, 0}));
}

}  // namespace
}  // namespace tandem
