#include "tandem/render/ray_coherence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/random.h"

namespace tandem {
namespace {

constexpr float scene_size = 10;

/// Of a pinhole camera, row by row.
std::vector<Ray<float>> camera_rays() {
    std::vector<Ray<float>> rays;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            rays.push_back({{1, 2, 9}, {static_cast<float>(x - 32) / 64, static_cast<float>(y - 32) / 64, -1}});
        }
    }
    return rays;
}

TEST(AreCoherent, HoldsForCamerasAndTheirShadowRays) {
    EXPECT_TRUE(are_coherent(camera_rays(), scene_size));
    std::vector<Ray<float>> shadows;  // from a floor to a lamp
    for (const Ray<float>& ray : camera_rays()) {
        const Vec3f on_floor = {ray.direction.x, -1, ray.direction.y};
        shadows.push_back({on_floor, Vec3f{0, 8, 0} - on_floor});
    }
    EXPECT_TRUE(are_coherent(shadows, scene_size));
    EXPECT_TRUE(are_coherent(std::vector<Ray<float>>(5), scene_size)) << "fewer than a group";
}

TEST(AreCoherent, DoesNotHoldForRaysInAllDirectionsOrFromEverywhere) {
    test::Random random(5);
    const auto anywhere = [&] {
        return Vec3f{random.uniform(-9.0F, 9.0F), random.uniform(-9.0F, 9.0F), random.uniform(-9.0F, 9.0F)};
    };
    std::vector<Ray<float>> scattered, parallel;
    for (int i = 0; i < 4096; ++i) {
        scattered.push_back({{1, 2, 9}, anywhere()});
        parallel.push_back({anywhere(), {0, 0, -1}});
    }
    EXPECT_FALSE(are_coherent(scattered, scene_size));
    EXPECT_FALSE(are_coherent(parallel, scene_size));
    // most groups decide
    std::vector<Ray<float>> mostly = camera_rays();
    std::copy(scattered.begin(), scattered.begin() + 1024, mostly.begin());
    EXPECT_TRUE(are_coherent(mostly, scene_size));
}

}  // namespace
}  // namespace tandem
