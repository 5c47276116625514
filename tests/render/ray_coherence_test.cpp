#include "tandem/render/ray_coherence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

TEST(PacketWidth, IsThatOfSixteenRays) {
    const Aabb bounds = {{-3, -4, -12}, {3, 4, 12}};  // half its size: 13
    std::vector<Ray<float>> parallel;
    for (int i = 0; i < 4096; ++i) parallel.push_back({{static_cast<float>(i) * 0.25F, 0, 50}, {0, 0, -1}});
    EXPECT_DOUBLE_EQ(packet_width(parallel, bounds), 15 * 0.25);

    const auto turning = [](const Vec3f& origin) {
        std::vector<Ray<float>> rays;
        for (int i = 0; i < 160; ++i) rays.push_back({origin, i % 16 < 8 ? Vec3f{3, 0, 0} : Vec3f{0, 0, 5}});
        return rays;
    };
    EXPECT_DOUBLE_EQ(packet_width(turning({0, 0, 20}), bounds), 20 * std::sqrt(2.0));
    EXPECT_DOUBLE_EQ(packet_width(turning({0, 1, 0}), bounds), 13 * std::sqrt(2.0)) << "from within";
}

TEST(PacketWidth, IsThatOfMostPackets) {
    const Aabb bounds = {{-1, -1, -1}, {1, 1, 1}};
    std::vector<Ray<float>> rays(64, {{0, 0, 9}, {0, 0, -1}});
    rays[15].origin.x = 5;
    EXPECT_EQ(packet_width(rays, bounds), 0);
    rays[31].origin.x = rays[47].origin.x = 7;
    EXPECT_DOUBLE_EQ(packet_width(rays, bounds), 7);
}

TEST(PacketWidth, IsNoneForRaysThatCannotBeTracedOrTooFew) {
    const Aabb bounds = {{-1, -1, -1}, {1, 1, 1}};
    EXPECT_EQ(packet_width(std::vector<Ray<float>>(64), bounds), 0);
    EXPECT_EQ(packet_width(std::vector<Ray<float>>(15, {{1, 2, 3}, {1, 0, 0}}), bounds), 0);
    EXPECT_EQ(packet_width({}, bounds), 0);
}

TEST(RowLength, IsThatOfImages) {
    EXPECT_EQ(row_length(camera_rays(), scene_size), 64U);
    std::vector<Ray<float>> wide, shadows, blurred;
    test::Random random(6);
    for (int y = 0; y < 90; ++y) {
        for (int x = 0; x < 160; ++x) {
            const auto jitter = [&] { return random.uniform(0.0F, 1.0F); };
            wide.push_back({{1, 2, 9}, {static_cast<float>(x - 80) / 80, static_cast<float>(y - 45) / 80, -1}});
            blurred.push_back(
                {{1, 2, 9},
                 {(static_cast<float>(x - 80) + jitter()) / 80, (static_cast<float>(y - 45) + jitter()) / 80, -1}});
            const Vec3f point = {static_cast<float>(x - 80) / 80, static_cast<float>(y - 45) / 80, -0.1F * jitter()};
            shadows.push_back({point, Vec3f{0, 8, 0} - point});
        }
    }
    EXPECT_EQ(row_length(wide, scene_size), 160U);
    EXPECT_EQ(row_length(blurred, scene_size), 160U);
    EXPECT_EQ(row_length(shadows, 1), 160U);
}

TEST(RowLength, IsNoneForOtherRays) {
    EXPECT_EQ(row_length({}, scene_size), 0U);
    EXPECT_EQ(row_length(std::vector<Ray<float>>(5), scene_size), 0U);
    EXPECT_EQ(row_length(std::vector<Ray<float>>(4096), scene_size), 0U) << "they cannot be traced";
    EXPECT_EQ(row_length(std::vector<Ray<float>>(4096, {{0, 0, 0}, {1, 2, 3}}), scene_size), 0U) << "they are equal";
    test::Random random(7);
    const auto anywhere = [&] {
        return Vec3f{random.uniform(-9.0F, 9.0F), random.uniform(-9.0F, 9.0F), random.uniform(-9.0F, 9.0F)};
    };
    std::vector<Ray<float>> scattered, line;
    for (int i = 0; i < 4096; ++i) {
        scattered.push_back({anywhere(), anywhere()});
        line.push_back({{static_cast<float>(i) / 4096, 0, 0}, {0, 0, -1}});
    }
    EXPECT_EQ(row_length(scattered, scene_size), 0U);
    EXPECT_EQ(row_length(line, scene_size), 0U) << "one row";
    // rows of other lengths than tiles can have
    std::vector<Ray<float>> odd;
    odd.reserve(3600);
    for (int i = 0; i < 60 * 60; ++i) {
        odd.push_back({{0, 0, 0}, {static_cast<float>(i % 60) / 60, static_cast<float>(i / 60) / 60, -1}});
    }
    EXPECT_EQ(row_length(odd, scene_size) % 60, 0U);
}

}  // namespace
}  // namespace tandem
