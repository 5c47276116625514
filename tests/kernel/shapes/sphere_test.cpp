// cross_sphere against exact arithmetic on the same floats.
#include "tandem/kernel/shapes/sphere.h"

#include <gtest/gtest.h>

#include "support/adversarial_rays.h"
#include "support/case_name.h"
#include "support/exact_geometry.h"
#include "tandem/kernel/shapes/crossing.h"

namespace tandem {
namespace {

using test::Big;
using test::SphereCase;

std::string describe(int kind, std::uint64_t number, const SphereCase& c) {
    char sphere[120];
    std::snprintf(sphere, sizeof sphere, "Sphere{{%aF, %aF, %aF}, %aF}", static_cast<double>(c.sphere.centre.x),
                  static_cast<double>(c.sphere.centre.y), static_cast<double>(c.sphere.centre.z),
                  static_cast<double>(c.sphere.radius));
    return "sphere_case(" + std::to_string(kind) + ", " + std::to_string(number) + ") \"" + test::sphere_kinds[kind] +
           "\": " + sphere + ", " + test::reproducer(c.ray);
}

class SphereAgainstOracle : public testing::TestWithParam<int> {};

TEST_P(SphereAgainstOracle, DecidesRightAndIsWithinOneUlp) {
    const int kind = GetParam();
    int hits = 0, wrong = 0, coarse = 0;
    double worst = 0;
    constexpr std::uint64_t count = 20000;
    for (std::uint64_t number = 0; number < count; ++number) {
        const SphereCase c = test::sphere_case(kind, number);
        if (!is_traceable(c.ray)) continue;
        double t = 0;
        const bool hit = first_hit(c.sphere, c.ray, t);
        // the roots and both crossings say the same as this short cut
        double t_of_roots = 0, t_of_both = 0;
        ASSERT_EQ(first_hit(sphere_roots(c.sphere, c.ray), t_of_roots), hit) << describe(kind, number, c);
        ASSERT_EQ(first_hit(cross_sphere(c.sphere, c.ray), t_of_both), hit) << describe(kind, number, c);
        if (hit) {
            ASSERT_EQ(t_of_roots, t) << describe(kind, number, c);
            ASSERT_EQ(t_of_both, t) << describe(kind, number, c);
        }
        const auto exact = test::hit_ball(test::big(c.ray.origin) - test::big(c.sphere.centre),
                                          test::big(c.ray.direction), Big(c.sphere.radius));
        if (hit != exact.has_value()) {
            if (++wrong <= 3) ADD_FAILURE() << (hit ? "false hit: " : "missed: ") << describe(kind, number, c);
            continue;
        }
        if (!hit) continue;
        ++hits;
        const double error = test::error_in_ulps(narrow(t), *exact);
        worst = std::max(worst, error);
        if (error > 1 && ++coarse <= 3) ADD_FAILURE() << error << " ulp: " << describe(kind, number, c);
    }
    EXPECT_EQ(wrong, 0) << "wrong decisions of " << count;
    EXPECT_EQ(coarse, 0) << "of " << hits << " hits; worst " << worst << " ulp";
    EXPECT_GT(hits, 100) << "the generator has lost its aim";
    RecordProperty("worst_ulp", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(Kinds, SphereAgainstOracle, testing::Range(0, static_cast<int>(std::size(test::sphere_kinds))),
                         [](const auto& info) { return test::case_name(test::sphere_kinds[info.param]); });

TEST(Sphere, TangentLineHitsOnceAtTheTouchingPoint) {
    const Sphere unit = {{0, 0, 0}, 1};
    double t = 0;
    const auto crossing = cross_sphere(unit, Ray<float>{{1, 0, -5}, {0, 0, 1}});
    ASSERT_TRUE(first_hit(crossing, t));
    EXPECT_EQ(crossing.t_near, 5.0);
    EXPECT_EQ(crossing.t_far, 5.0);
}

TEST(Sphere, OriginOnTheSurface) {
    const Sphere unit = {{0, 0, 0}, 1};
    double t = 0;
    EXPECT_FALSE(first_hit(cross_sphere(unit, Ray<float>{{1, 0, 0}, {1, 0.5F, 0}}), t)) << "outward";
    EXPECT_FALSE(first_hit(cross_sphere(unit, Ray<float>{{1, 0, 0}, {0, 1, 0}}), t)) << "along";
    ASSERT_TRUE(first_hit(cross_sphere(unit, Ray<float>{{1, 0, 0}, {-1, 0, 0}}), t)) << "inward";
    EXPECT_EQ(t, 2.0);
}

TEST(Sphere, OriginInsideReportsTheExit) {
    double t = 0;
    ASSERT_TRUE(first_hit(cross_sphere(Sphere{{0, 0, 0}, 1e7F}, Ray<float>{{0, 0, 0}, {0, -2, 0}}), t));
    EXPECT_EQ(t, 5e6);
}

TEST(Sphere, NanAndInfinityMiss) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const Sphere unit = {{0, 0, 0}, 1};
    for (const float bad : {nan, infinity, -infinity}) {
        for (int i = 0; i < 6; ++i) {
            Ray<float> ray = {{0, 0, -3}, {0, 0, 1}};
            (i < 3 ? ray.origin : ray.direction)[i % 3] = bad;
            EXPECT_FALSE(is_traceable(ray));
            double t = 0;
            EXPECT_FALSE(first_hit(unit, ray, t)) << "component " << i << " is " << bad;
        }
        double t = 0;
        EXPECT_FALSE(first_hit(cross_sphere(Sphere{{nan, 0, 0}, 1}, Ray<float>{{0, 0, -3}, {0, 0, 1}}), t));
    }
    EXPECT_FALSE(is_traceable(Ray<float>{{0, 0, 0}, {0, -0.0F, 0}}));
    EXPECT_FALSE(is_traceable(Ray<float>{{1.01e18F, 0, 0}, {0, 1, 0}}));
}

// The normal is that of the exact hit point; |n| = 1. 2^-30 leaves room for the rounding of t at 2^20 radii.
TEST(Sphere, NormalIsUnitAndRight) {
    for (const int kind : {0, 1, 4, 5, 9, 10, 11, 12}) {
        for (std::uint64_t number = 0; number < 2000; ++number) {
            const SphereCase c = test::sphere_case(kind, number);
            double t = 0;
            if (!first_hit(cross_sphere(c.sphere, c.ray), t)) continue;
            const test::BigVector offset = test::big(c.ray.origin) - test::big(c.sphere.centre);
            const test::BigVector direction = test::big(c.ray.direction);
            const auto exact = test::hit_ball(offset, direction, Big(c.sphere.radius));
            if (!exact) continue;
            const test::BigVector point = test::along(offset, direction, *exact);
            const Vec3d normal = sphere_normal(c.sphere, c.ray, t);
            ASSERT_NEAR(dot(normal, normal), 1, 1e-15) << describe(kind, number, c);
            const Big radius(c.sphere.radius);
            const test::BigVector error =
                test::big(normal) - test::BigVector{point.x / radius, point.y / radius, point.z / radius};
            ASSERT_LE(static_cast<double>(sqrt(test::dot(error, error))), 0x1p-24) << describe(kind, number, c);
        }
    }
}

TEST(Sphere, BoundsContainTheSphere) {
    test::Random random(9);
    for (int i = 0; i < 10000; ++i) {
        const Sphere s = {{random.log_uniform(-40, 40), random.log_uniform(-40, 40), random.log_uniform(-40, 40)},
                          std::abs(random.log_uniform(-40, 40))};
        const Aabb box = bounds(s);
        for (int k = 0; k < 3; ++k) {
            ASSERT_LE(Big(box.lower[k]), Big(s.centre[k]) - Big(s.radius));
            ASSERT_GE(Big(box.upper[k]), Big(s.centre[k]) + Big(s.radius));
        }
    }
}

}  // namespace
}  // namespace tandem
