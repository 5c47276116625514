// Mirror and dielectric: directions by the laws of reflection and refraction, shares by Fresnel's formulas written for
// angles, and their masks.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/bsdf/lobe_checks.h"
#include "support/estimate.h"

namespace tandem {
namespace {

using namespace test;

template <class L>
void expect_no_density(const L& lobe) {
    const Vec3d wo = direction(0.5, 0.1);
    for (const Vec3d& wi : {Vec3d{-wo.x, -wo.y, wo.z}, direction(0.5, 0.3), Vec3d{-wo.x, -wo.y, -wo.z}}) {
        EXPECT_EQ(lobe.pdf(wo, wi), 0);
        EXPECT_EQ(lobe.f(wo, wi), (Vec3f{0, 0, 0}));
    }
    const auto below = lobe.sample(direction(-0.5, 0.1), {0.5, 0.5, 0.5});
    EXPECT_FALSE(below.valid);
    EXPECT_FALSE(below.transmits);
    EXPECT_EQ(below.pdf, 0);
    EXPECT_EQ(below.weight, (Vec3f{0, 0, 0}));
}

TEST(Mirror, TurnsDirectionsAroundTheNormal) {
    const Mirror<float> lobe{{0.9F, 0.5F, 0.1F}};
    expect_no_density(lobe);
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d wo = direction(i == 0 ? 0.0 : random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
        const auto drawn = lobe.sample(wo, {0, 0, 0});
        ASSERT_TRUE(drawn.valid && !drawn.transmits && std::isinf(drawn.pdf));
        ASSERT_EQ(drawn.weight, lobe.reflectance);
        ASSERT_NEAR(drawn.wi.x, -wo.x, 0x1p-51);
        ASSERT_NEAR(drawn.wi.y, -wo.y, 0x1p-51);
        ASSERT_NEAR(drawn.wi.z, wo.z, 0x1p-51);
    }
}

TEST(Mirror, GivesTheBitsOfReflectInWorldSpace) {
    const Mirror<float> lobe{{1, 1, 1}};
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        Random random(number);
        const Vec3d normal = direction(random.uniform(-1.0, 1.0), random.uniform(0.0, 1.0));
        const Vec3d wo = direction(random.uniform(-1.0, 1.0), random.uniform(0.0, 1.0));
        const auto drawn = lobe.sample_about({normal, normal}, wo, {0, 0, 0});
        ASSERT_EQ(drawn.wi, reflect(-wo, normal)) << "case " << number;
    }
}

// A shading normal may be far from the geometric one.
TEST(Mirror, NeverLeadsThroughTheSurface) {
    const Mirror<float> lobe{{1, 1, 1}};
    int bent = 0;
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        Random random(number);
        const Vec3d geometric = direction(random.uniform(-1.0, 1.0), random.uniform(0.0, 1.0));
        const Vec3d shading = direction(random.uniform(-1.0, 1.0), random.uniform(0.0, 1.0));
        const Vec3d wo = direction(random.uniform(-1.0, 1.0), random.uniform(0.0, 1.0));
        if (dot(wo, geometric) <= 0) continue;
        const auto drawn = lobe.sample_about({shading, geometric}, wo, {0, 0, 0});
        ASSERT_GT(dot(drawn.wi, geometric), 0) << "case " << number;
        if (drawn.wi != reflect(-wo, shading)) ++bent;
    }
    EXPECT_GT(bent, 1000);
}

/// From n1 to n2 under an angle; nothing for total reflection.
double fresnel_of_angles(double n1, double n2, double angle) {
    const double sine = n1 / n2 * std::sin(angle);
    if (sine >= 1) return 1;
    const double behind = std::asin(sine);
    if (angle == 0) return std::pow((n1 - n2) / (n1 + n2), 2);
    const double s = std::sin(angle - behind) / std::sin(angle + behind);
    const double p = std::tan(angle - behind) / std::tan(angle + behind);
    return (s * s + p * p) / 2;
}

TEST(Dielectric, ChoosesByFresnelAndBendsBySnell) {
    const double glass = 1.5;
    for (const bool leaves : {false, true}) {
        const double n1 = leaves ? glass : 1, n2 = leaves ? 1 : glass;
        const Dielectric<float> lobe{1, n1 / n2};
        expect_no_density(lobe);
        for (const double degrees : {0.0, 20.0, 41.0, 42.0, 60.0, 85.0}) {
            const double angle = degrees * pi / 180;
            const Vec3d wo = {std::sin(angle), 0, std::cos(angle)};
            const double share = fresnel_of_angles(n1, n2, angle);
            Random random(static_cast<std::uint64_t>(degrees));
            Estimate reflected;
            for (int i = 0; i < 20'000; ++i) {
                const auto drawn = lobe.sample(wo, random_numbers(random));
                ASSERT_TRUE(drawn.valid && std::isinf(drawn.pdf));
                ASSERT_EQ(drawn.weight, (Vec3f{1, 1, 1}));
                reflected.add(drawn.transmits ? 0 : 1);
                ASSERT_NEAR(drawn.wi.x, -wo.x * (drawn.transmits ? n1 / n2 : 1), 1e-15);
                ASSERT_NEAR(drawn.wi.y, 0, 1e-15);
                ASSERT_EQ(drawn.wi.z < 0, drawn.transmits);
            }
            expect_mean(reflected, share, std::to_string(degrees) + (leaves ? " leaving" : " entering"));
        }
    }
}

TEST(Dielectric, EqualIndicesAreNotThere) {
    const Dielectric<float> lobe{1, 1.0};
    for (std::uint64_t number = 0; number < 1000; ++number) {
        Random random(number);
        const Vec3d wo = direction(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
        const auto drawn = lobe.sample(wo, random_numbers(random));
        ASSERT_TRUE(drawn.transmits) << "case " << number;
        ASSERT_EQ(drawn.wi, -wo) << "case " << number;
    }
}

}  // namespace
}  // namespace tandem
