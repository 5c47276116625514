// The distribution against formulas as the papers have them, in long double, and against what they must integrate to.
#include "tandem/kernel/bsdf/ggx.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/bsdf/lobe_checks.h"
#include "kernel/bsdf/textbook_ggx.h"

namespace tandem {
namespace {

using namespace test;

double random_alpha(Random& random) { return std::exp2(random.uniform(-13.0, 0.0)); }

TEST(Ggx, DensityAndMaskingAreThoseOfTheTextbooks) {
    for (std::uint64_t number = 0; number < 100'000; ++number) {
        Random random(number);
        const Ggx<double> facets(random_alpha(random), random.coin() ? random_alpha(random) : 0.3);
        // normals within the lobe, and anywhere
        const double radius = std::exp2(random.uniform(-10.0, 5.0));
        const double turns = random.uniform(0.0, 1.0);
        const Vec3d h = random.coin() ? Vec3d{radius * facets.alpha_x * std::cos(2 * pi * turns),
                                              radius * facets.alpha_y * std::sin(2 * pi * turns), 1}
                                      : direction(random.uniform(1e-3, 1.0), turns);
        const Vec3d w = direction(std::exp2(random.uniform(-20.0, 0.0)), random.uniform(0.0, 1.0));
        const TextbookGgx textbook{facets.alpha_x, facets.alpha_y};
        const long double density = textbook.density(long_vector(h));
        ASSERT_NEAR(ratio(facets.density(h), density), 1, 0x1p-49) << "case " << number;
        // the alphas and their squares are all that density rounds: the length of h is free
        ASSERT_NEAR(facets.density(h * 1024.0), facets.density(h), 0) << "case " << number;
        ASSERT_NEAR(ratio(facets.seen(w), textbook.masking(long_vector(w))), 1, 0x1p-49) << "case " << number;
    }
}

TEST(Ggx, NormalsCoverTheSurfaceOnce) {
    for (const auto& [x, y] : {Vec2<double>{0, 0}, {0.01, 0.01}, {0.1, 0.9}, {0.5, 0.5}, {1, 1}}) {
        const Ggx<double> facets(x, y);
        const Chart chart = slope_chart(facets.alpha_x, facets.alpha_y);
        // the chart's solid angle is that of wi, 4 (wo . h) times that of h
        const Vec3d up = {0, 0, 1};
        const double projected = integrate(chart, up, 0, 1, 0, 1, 200'000, [&](const Vec3d& wi) {
            const Vec3d h = normalize(up + wi);
            return facets.density(h) * h.z / (4 * h.z);
        });
        EXPECT_NEAR(projected, 1, 1e-3) << x << ", " << y;
        // what is seen from w has the area that w sees: E. Heitz, 2014, (14)
        for (const double cosine : {1.0, 0.7, 0.2, 0.01}) {
            const Vec3d w = direction(cosine, 0.15);
            const double visible = integrate(chart, w, 0, 1, 0, 1, 200'000, [&](const Vec3d& wi) {
                return facets.seen(w) * facets.density(w + wi) / (4 * w.z);
            });
            EXPECT_NEAR(visible, 1, 3e-3) << x << ", " << y << " from " << cosine;
        }
    }
}

TEST(Ggx, AlphasOutOfRangeCountAsTheNearestInIt) {
    const double least = least_ggx_alpha;
    for (const double alpha : {0.0, -1.0, 1e-30, std::nan("")}) EXPECT_EQ(Ggx<double>(alpha, 0.5).alpha_x, least);
    EXPECT_EQ(Ggx<double>(0.5, 7.0).alpha_y, 1);
    EXPECT_EQ(Ggx<double>(0.5, 0.25).alpha_x, 0.5);
    EXPECT_EQ(Ggx<double>(0.5, 0.25).alpha_y, 0.25);
}

TEST(Ggx, NormalsAreUnitVectorsThatTheViewerSees) {
    for (std::uint64_t number = 0; number < 100'000; ++number) {
        Random random(number);
        const Ggx<double> facets(random_alpha(random), random_alpha(random));
        const Vec3d w = direction(std::exp2(random.uniform(-40.0, 0.0)), random.uniform(0.0, 1.0));
        const double ends[] = {0, 1 - 0x1p-24, random.uniform(0.0, 1.0)};
        const Vec3d m = facets.sample_seen(w, ends[random.below(3)], ends[random.below(3)]);
        ASSERT_NEAR(dot(m, m), 1, 0x1p-49) << "case " << number;
        ASSERT_GT(m.z, 0) << "case " << number;
        ASSERT_GT(dot(m, w), -0x1p-50) << "case " << number;
    }
}

TEST(Ggx, TheMiddleOfTheNumbersIsTheMirrorsNormalHeadOn) {
    const Ggx<double> facets(0.3, 0.7);
    const Vec3d m = facets.sample_seen({0, 0, 1}, 0.5, 0.0);
    EXPECT_EQ(m.x, 0);
    EXPECT_EQ(m.y, 0);
    EXPECT_EQ(m.z, 1);
}

}  // namespace
}  // namespace tandem
