// The lobe against formulas as the papers have them, in long double, and against closed forms.
#include "tandem/kernel/bsdf/ggx_reflection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/bsdf/lobe_checks.h"
#include "kernel/bsdf/textbook_ggx.h"
#include "support/estimate.h"

namespace tandem {
namespace {

using namespace test;

/// A pair of directions of which wi is where the lobe reflects to, or anywhere.
struct LobeCase {
    double alpha_x, alpha_y;
    Vec3d wo, wi;
};
LobeCase random_case(std::uint64_t number) {
    Random random(number);
    LobeCase c{std::exp2(random.uniform(-13.0, 0.0)), std::exp2(random.uniform(-13.0, 0.0)), {}, {}};
    if (random.coin()) c.alpha_y = c.alpha_x;
    for (;;) {
        c.wo = direction(std::exp2(random.uniform(-12.0, 0.0)), random.uniform(0.0, 1.0));
        const GgxReflection<double> lobe{{1, 1, 1}, 1, {c.alpha_x, c.alpha_y}};
        c.wi = random.below(4) == 0 ? direction(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0))
                                    : lobe.sample(c.wo, random_numbers(random)).wi;
        if (c.wi.z > 0x1p-20) return c;
    }
}

long double textbook_fresnel(long double f0, const LobeCase& c) {
    const LongVector o = unit(long_vector(c.wo)), h = unit(long_vector(c.wo) + long_vector(c.wi));
    return f0 + (1 - f0) * std::pow(1 - (o.x * h.x + o.y * h.y + o.z * h.z), 5.0L);
}

TEST(GgxReflection, IsThatOfTheTextbooks) {
    for (std::uint64_t number = 0; number < 100'000; ++number) {
        const LobeCase c = random_case(number);
        const TextbookGgx textbook{c.alpha_x, c.alpha_y};
        const long double f = textbook.reflection(long_vector(c.wo), long_vector(c.wi));
        const long double pdf = textbook.pdf(long_vector(c.wo), long_vector(c.wi));
        const GgxReflection<double> precise{{1, 0.04, 0}, 1, {c.alpha_x, c.alpha_y}};
        const GgxReflection<float> strict{{1, 0.04F, 0}, 1, {c.alpha_x, c.alpha_y}};
        const double f0[] = {1, 0.04, 0};
        for (int k = 0; k < 3; ++k) {
            const long double expected = f * textbook_fresnel(f0[k], c);
            // 1 - cosine cancels where there is no other term
            const double slack = f0[k] == 0 ? 1e-6 : 0x1p-36;
            ASSERT_NEAR(ratio(precise.f(c.wo, c.wi)[k], expected), 1, slack) << "case " << number << ", f0 " << f0[k];
            if (expected > 1e-30 && f0[k] > 0) {
                ASSERT_NEAR(ratio(strict.f(c.wo, c.wi)[k], expected), 1, 0x1p-21)
                    << "case " << number << ", f0 " << f0[k];
            }
        }
        ASSERT_NEAR(ratio(precise.pdf(c.wo, c.wi), pdf), 1, 0x1p-36) << "case " << number;
        ASSERT_NEAR(ratio(strict.pdf(c.wo, c.wi), pdf), 1, 0x1p-36) << "case " << number;
    }
}

TEST(GgxReflection, TheFastTierIsNear) {
    for (std::uint64_t number = 0; number < 100'000; ++number) {
        const LobeCase c = random_case(number);
        if (c.alpha_x < 0.01 || c.alpha_y < 0.01 || c.wo.z < 0.01 || c.wi.z < 0.01) continue;
        const GgxReflection<double> precise{{1, 0.5, 0.04}, 1, {c.alpha_x, c.alpha_y}};
        const GgxReflection<FastFloat> fast{{1, 0.5F, 0.04F}, 1, {FastFloat(c.alpha_x), FastFloat(c.alpha_y)}};
        const Vec3<FastFloat> wo = {c.wo.x, c.wo.y, c.wo.z}, wi = {c.wi.x, c.wi.y, c.wi.z};
        for (int k = 0; k < 3; ++k) {
            const double expected = precise.f(c.wo, c.wi)[k];
            ASSERT_NEAR(fast.f(wo, wi)[k].v, expected, 1e-3 * expected + 1e-30) << "case " << number;
        }
        const double pdf = precise.pdf(c.wo, c.wi);
        ASSERT_NEAR(fast.pdf(wo, wi).v, pdf, 1e-3 * pdf) << "case " << number;
    }
}

// Head-on and with alpha = 1 the density of wi is that of the whole sphere, and the weight 2 cos / (1 + cos).
TEST(GgxReflection, LosesHeadOnWhatAClosedFormSays) {
    const GgxReflection<double> lobe{{1, 1, 1}, 1, {1.0, 1.0}};
    const Vec3d up = {0, 0, 1};
    for (const double cosine : {1.0, 0.7, 0.1}) {
        EXPECT_NEAR(lobe.pdf(up, direction(cosine, 0.3)), 1 / (4 * pi), 1e-15);
        EXPECT_NEAR(lobe.f(up, direction(cosine, 0.3)).x * cosine, 2 * cosine / (1 + cosine) / (4 * pi), 1e-15);
    }
    Random random(1);
    Estimate reflected, valid;
    for (int i = 0; i < 200'000; ++i) {
        const auto drawn = lobe.sample(up, random_numbers(random));
        reflected.add(drawn.weight.x);
        valid.add(drawn.valid ? 1 : 0);
    }
    expect_mean(reflected, 1 - std::log(2.0), "white furnace");
    expect_mean(valid, 0.5, "above the horizon");
}

// What is said of the loss in the contract, and how good the estimate is that lobes are chosen by.
TEST(GgxReflection, AlbedoIsNearTheWhiteFurnace) {
    for (const double alpha : {0.0, 0.05, 0.1, 0.2, 0.5, 0.7, 1.0}) {
        for (const double cosine : {0.02, 0.1, 0.3, 0.7, 1.0}) {
            const GgxReflection<double> lobe{{1, 0.5, 0.04}, 1, {alpha, alpha}};
            const Vec3d wo = direction(cosine, 0.6);
            const Vec3d furnace = integrate(slope_chart(lobe.facets.alpha_x, lobe.facets.alpha_y), wo, 0, 1, 0, 1,
                                            100'000, [&](const Vec3d& wi) { return lobe.f(wo, wi) * wi.z; });
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(lobe.albedo(wo)[k], furnace[k], 0.13) << alpha << ", " << cosine;
                EXPECT_LT(lobe.albedo(wo)[k] / furnace[k], 1.4) << alpha << ", " << cosine;
                EXPECT_GT(lobe.albedo(wo)[k] / furnace[k], 0.7) << alpha << ", " << cosine;
            }
            const double white_head_on = alpha == 0 ? 1 : alpha == 0.2 ? 0.95 : alpha == 0.5 ? 0.69 : 0;
            if (cosine == 1 && white_head_on > 0) {
                EXPECT_NEAR(furnace.x, white_head_on, 0.005) << alpha;
            }
        }
    }
}

TEST(GgxReflection, TheSmoothestIsAMirrorToTheEye) {
    const GgxReflection<float> lobe{{1, 1, 1}, 1, {0.0, 0.0}};
    Random random(3);
    int far = 0;
    for (int i = 0; i < 10'000; ++i) {
        const Vec3d wo = direction(random.uniform(0.1, 1.0), random.uniform(0.0, 1.0));
        const auto drawn = lobe.sample(wo, random_numbers(random));
        const Vec3d offset = drawn.wi - Vec3d{-wo.x, -wo.y, wo.z};
        far += dot(offset, offset) > 1e-6 ? 1 : 0;
    }
    EXPECT_LT(far, 500) << "of 10 000 samples farther than 0.06 degrees from the mirror direction";
}

}  // namespace
}  // namespace tandem
