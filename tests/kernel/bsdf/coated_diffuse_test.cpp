// The diffuse base of a dielectric: what the border leaves of Lambert, and that base and border share the light.
#include "tandem/kernel/bsdf/coated_diffuse.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/bsdf/lobe_checks.h"
#include "tandem/kernel/bsdf/ggx_reflection.h"

namespace tandem {
namespace {

using namespace test;

TEST(CoatedDiffuse, IsLambertTimesWhatTheInterfaceTransmits) {
    const CoatedDiffuse<double> lobe{{{0.8, 0.5, 0}}, 0.04};
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        Random random(number);
        const Vec3d wo = direction(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
        const Vec3d wi = direction(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
        // half the angle between them
        const double cosine = std::cos(std::acos(std::min(1.0, dot(wo, wi))) / 2);
        const double through = 1 - (0.04 + 0.96 * std::pow(1 - cosine, 5));
        const Vec3d f = lobe.f(wo, wi);
        ASSERT_NEAR(f.x, 0.8 / pi * through, 1e-12) << "case " << number;
        ASSERT_NEAR(f.y, 0.5 / pi * through, 1e-12) << "case " << number;
        ASSERT_EQ(f.z, 0) << "case " << number;
    }
}

TEST(CoatedDiffuse, SharesTheLightWithTheInterface) {
    for (const double alpha : {0.0, 0.1, 0.5, 1.0}) {
        for (const double cosine : {0.05, 0.3, 0.7, 1.0}) {
            const CoatedDiffuse<double> base{{{1, 1, 1}}, 0.04};
            const GgxReflection<double> border{{0.04, 0.04, 0.04}, 1, {alpha, alpha}};
            const Vec3d wo = direction(cosine, 0.4);
            const double from_base = integrate(polar_chart(1e3), wo, 0, 1, 0, 1, 100'000,
                                               [&](const Vec3d& wi) { return base.f(wo, wi).x * wi.z; });
            const double from_border =
                integrate(slope_chart(border.facets.alpha_x, border.facets.alpha_y), wo, 0, 1, 0, 1, 100'000,
                          [&](const Vec3d& wi) { return border.f(wo, wi).x * wi.z; });
            EXPECT_NEAR(base.albedo(wo).x, from_base, 0.12) << cosine;
            const double sum = from_base + from_border;
            const double most = cosine >= 0.7 ? 1.002 : alpha >= 0.5 ? 1.05 : cosine == 0.3 ? 1.152 : 1.72;
            EXPECT_LT(sum, most) << alpha << ", " << cosine;
            EXPECT_GT(sum, alpha == 0 && cosine < 0.7 ? most - 0.005 : 0.97) << alpha << ", " << cosine;
        }
    }
}

}  // namespace
}  // namespace tandem
