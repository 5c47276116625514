// Phong's lobe against the model as kernel/bsdf/phong.h has it, and against closed forms.
#include "tandem/kernel/bsdf/phong_lobe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/bsdf/lobe_checks.h"
#include "support/estimate.h"

namespace tandem {
namespace {

using namespace test;

// f |cos| pi is the highlight that a light of intensity 1 gives.
TEST(PhongLobe, IsTheHighlightOfPhongsModel) {
    for (std::uint64_t number = 0; number < 100'000; ++number) {
        Random random(number);
        const auto shininess = static_cast<float>(std::exp2(random.uniform(-1.0, 16.0)));
        const PhongLobe<float> lobe{{1, 0.5F, 0.25F}, shininess};
        const Vec3d wo = direction(random.uniform(1e-3, 1.0), random.uniform(0.0, 1.0));
        const auto drawn = lobe.sample(wo, random_numbers(random));
        if (!drawn.valid) continue;
        const Vec3f highlight = lobe.reflected_about(1, {0, 0, 1}, drawn.wi, wo);
        const Vec3f f = lobe.f(wo, drawn.wi);
        for (int k = 0; k < 3; ++k) {
            ASSERT_NEAR(f[k] * drawn.wi.z * pi, highlight[k], 1e-6 * highlight[k]) << "case " << number;
        }
    }
}

TEST(PhongLobe, HasTheDensityOfItsPower) {
    for (std::uint64_t number = 0; number < 100'000; ++number) {
        Random random(number);
        const double shininess = std::exp2(random.uniform(-1.0, 20.0));
        const PhongLobe<double> lobe{{1, 1, 1}, shininess};
        const Vec3d wo = direction(random.uniform(0.5, 1.0), random.uniform(0.0, 1.0));
        const double angle = std::sqrt(random.uniform(0.0, 8.0) / shininess);
        const Vec3d wi = from_frame(frame_around(Vec3d{-wo.x, -wo.y, wo.z}), std::sin(angle), 0.0, std::cos(angle));
        if (wi.z <= 0 || angle > 1.5) continue;
        // cos^n by a series that does not cancel: log(cos) = log1p(-2 sin^2(angle / 2))
        const double half = std::sin(angle / 2);
        const double power = std::exp(shininess * std::log1p(-2 * half * half));
        const double expected = (shininess + 1) / (2 * pi) * power;
        ASSERT_NEAR(lobe.pdf(wo, wi), expected, expected * (shininess * 0x1p-49 + 0x1p-47)) << "case " << number;
    }
}

// All of the lobe is above the horizon head-on: 2 specular / (n + 1) comes back. At the horizon half of it is, and the
// rest is lost.
TEST(PhongLobe, ReflectsWhatItSays) {
    for (const double shininess : {0.0, 1.0, 10.0, 1000.0}) {
        const PhongLobe<double> lobe{{1, 1, 1}, shininess};
        Random random(static_cast<std::uint64_t>(shininess));
        Estimate head_on, grazing;
        for (int i = 0; i < 50'000; ++i) {
            head_on.add(lobe.sample({0, 0, 1}, random_numbers(random)).weight.x);
            grazing.add(lobe.sample(direction(1e-9, 0.2), random_numbers(random)).valid ? 1 : 0);
        }
        EXPECT_NEAR(head_on.mean(), 2 / (shininess + 1), 1e-12) << shininess;
        EXPECT_NEAR(head_on.variance_of_mean(), 0, 1e-20) << shininess;
        expect_mean(grazing, 0.5, "share above the horizon, shininess " + std::to_string(shininess));
    }
}

}  // namespace
}  // namespace tandem
