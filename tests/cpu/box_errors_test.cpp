#include "cpu/box_errors.h"

#include <gtest/gtest.h>

#include <vector>

namespace tandem {
namespace {

/// As many spheres of radius 1 as `small`, then as many of radius 1e6 as `large`.
BoxErrors errors_of(std::size_t small, std::size_t large) {
    std::vector<Sphere> spheres(small, {{0, 0, 0}, 1});
    spheres.insert(spheres.end(), large, {{0, 0, 0}, 1e6F});
    SceneView scene{};
    scene.spheres = spheres.data();
    scene.sphere_count = static_cast<std::uint32_t>(spheres.size());
    return box_errors_for(scene, {{-1e6F, -1e6F, -1e6F}, {1e6F, 1e6F, 1e6F}});
}

TEST(BoxErrors, AreThoseOfTheDistanceIfManyPrimitivesAreTinyBesideTheScene) {
    // the usual tests would need a padding of 1.9 m
    EXPECT_EQ(errors_of(100, 1), BoxErrors::of_distance);
    EXPECT_EQ(errors_of(1, 63), BoxErrors::of_distance);
    EXPECT_EQ(errors_of(1'000, 20'000), BoxErrors::of_distance);
    EXPECT_EQ(errors_of(1, 64), BoxErrors::of_scene);
    EXPECT_EQ(errors_of(0, 50), BoxErrors::of_scene);
}

}  // namespace
}  // namespace tandem
