#include "ray_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tandem/base/error.h"
#include "tandem/base/sha256.h"

namespace tandem::bench {
namespace {

TEST(RaySets, CoherentRaysCoverTheViewRowByRow) {
    const auto rays = make_rays(RaySet::coherent, 4);
    ASSERT_EQ(rays.size(), 16U);
    for (const Ray<float>& ray : rays) {
        EXPECT_EQ(ray.origin, Vec3f(0, 0, 3.2F));
        EXPECT_EQ(ray.direction.z, -1);
    }
    // Centres of four pixels over a width of 2 / 1.5.
    EXPECT_FLOAT_EQ(rays[0].direction.x, -0.5F);
    EXPECT_FLOAT_EQ(rays[0].direction.y, 0.5F);
    EXPECT_FLOAT_EQ(rays[1].direction.x, -1.0F / 6);
    EXPECT_FLOAT_EQ(rays[15].direction.x, 0.5F);
    EXPECT_FLOAT_EQ(rays[15].direction.y, -0.5F);
}

TEST(RaySets, RandomRaysAreUniformAndOfUnitLength) {
    const auto rays = make_rays(RaySet::random, 200);  // 40,000: a mean of uniform numbers is within 0.015 (5 sigma)
    Vec3d origin{0, 0, 0}, direction{0, 0, 0}, squares{0, 0, 0};
    for (const Ray<float>& ray : rays) {
        const Vec3d o = widen(ray.origin), d = widen(ray.direction);
        ASSERT_LE(std::max({std::abs(o.x), std::abs(o.y), std::abs(o.z)}), 1);
        ASSERT_NEAR(dot(d, d), 1, 1e-6);
        origin = origin + o;
        direction = direction + d;
        squares = squares + d * d;
    }
    const auto count = static_cast<double>(rays.size());
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(origin[axis] / count, 0, 0.015);
        EXPECT_NEAR(direction[axis] / count, 0, 0.015);
        EXPECT_NEAR(squares[axis] / count, 1.0 / 3, 0.01);
    }
}

TEST(RaySets, AreTheSameBitsEverywhere) {
    const auto hash_of = [](RaySet set) {
        const auto rays = make_rays(set, 64);
        Sha256 hash;
        hash.update(rays.data(), rays.size() * sizeof(rays[0]));
        return hash.hex();
    };
    EXPECT_EQ(hash_of(RaySet::coherent), "2af47f4876f5dfba34ffea44271893202853acd964997fb8e7472b63f9100870");
    EXPECT_EQ(hash_of(RaySet::random), "29dc43110c8756d36b77d0b7b514e05835a471b38a1225dcd41f830059bd424b");
}

TEST(RaySets, NamesGoForthAndBack) {
    for (const RaySet set : {RaySet::coherent, RaySet::random}) EXPECT_EQ(parse_ray_set(to_string(set)), set);
    EXPECT_THROW((void)parse_ray_set("parallel"), InputError);
}

}  // namespace
}  // namespace tandem::bench
