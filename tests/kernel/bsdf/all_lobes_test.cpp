// What holds for every lobe that is not specular, over roughness, anisotropy, grazing directions and both exact tiers:
// samples follow their density; weight, f, pdf and albedo say the same; nothing passes the horizon; nothing is NaN.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/bsdf/lobe_checks.h"
#include "kernel/bsdf/lobe_examples.h"
#include "support/estimate.h"
#include "support/pixel_index.h"

namespace tandem {
namespace {

using namespace test;

/// The examples of one lobe; none of a specular one.
template <class Real, template <class> class Lobe>
void add_lobe(const std::string& name, std::vector<AnyLobe>& lobes) {
    if constexpr (!has(Lobe<Real>::flags, LobeFlags::specular)) {
        using Examples = LobeExamples<Lobe>;
        for (const auto& roughness : Examples::roughness) {
            const Vec3<Real> tint = {Real(0.9), Real(0.5), Real(0.1)};
            Lobe<Real> lobe;
            make<Real>({tint, {roughness[0], roughness[1]}, 1.5}, lobe);
            const LobeSpread spread = Examples::spread(roughness);
            lobes.push_back(any_lobe<Real>(
                name + "(" + std::to_string(roughness[0]) + ", " + std::to_string(roughness[1]) + ")",
                spread.of_slopes ? slope_chart(spread.x, spread.y) : polar_chart(spread.x), lobe,
                Examples::is_reciprocal, Examples::most_albedo(roughness), Examples::most_weight(roughness)));
        }
    }
}

template <class Real>
void add_lobes(std::vector<AnyLobe>& lobes) {
#define TANDEM_LOBE(Type, name, needs, follows, is) add_lobe<Real, Type>(#Type, lobes);
#include "tandem/kernel/bsdf/lobes.def"
}

std::vector<AnyLobe> all_lobes() {
    std::vector<AnyLobe> lobes;
    add_lobes<float>(lobes);
    add_lobes<double>(lobes);
    return lobes;
}

/// Directions and densities are the same double in both: one is enough for what takes long.
std::vector<AnyLobe> strict_lobes() {
    std::vector<AnyLobe> lobes;
    add_lobes<float>(lobes);
    return lobes;
}

std::vector<Vec3d> views() {
    return {{0, 0, 1}, direction(0.8, 0.1), direction(0.3, 0.35), direction(0.05, 0.8), direction(0.001, 0.55)};
}

/// What rounding may change f by, relative. Phong's shininess multiplies the error of R.V.
double slack(const AnyLobe& lobe) { return 8 * lobe.roundoff + 1e-9; }

std::string say(const AnyLobe& lobe, const Vec3d& wo) {
    return lobe.name + ", wo (" + std::to_string(wo.x) + ", " + std::to_string(wo.y) + ", " + std::to_string(wo.z) +
           ")";
}

/// Deviation of a chi-squared sum from its mean, in standard deviations: E. Wilson, M. Hilferty, 1931.
double normal_deviate(double chi2, double freedom) {
    const double width = 2 / (9 * freedom);
    return (std::cbrt(chi2 / freedom) - (1 - width)) / std::sqrt(width);
}

TEST(AllLobes, SamplesFollowTheirDensity) {
    constexpr int bins = 16, points = 600, samples = 60'000;
    std::uint64_t seed = 0;
    for (const AnyLobe& lobe : strict_lobes()) {
        for (const Vec3d& wo : views()) {
            Random random(++seed);
            std::vector<double> found(bins * bins, 0);
            double lost = 0;
            for (int i = 0; i < samples; ++i) {
                const LobeSample<double> drawn = lobe.sample(wo, random_numbers(random));
                if (!drawn.valid) {
                    ++lost;
                    continue;
                }
                const Vec2<double> at = lobe.chart.from(wo, drawn.wi);
                const auto bin = [](double x) { return std::min(bins - 1, static_cast<int>(x * bins)); };
                ++found[pixel_index(bin(at.y), bin(at.x), bins)];
            }
            double total = 0, chi2 = 0, freedom = 0, rare = 0, rare_found = 0;
            const auto add = [&](double expected, double number) {
                chi2 += (number - expected) * (number - expected) / expected;
                ++freedom;
            };
            for (int s = 0; s < bins; ++s) {
                for (int t = 0; t < bins; ++t) {
                    const double share =
                        integrate(lobe.chart, wo, s / double(bins), (s + 1) / double(bins), t / double(bins),
                                  (t + 1) / double(bins), points, [&](const Vec3d& wi) { return lobe.pdf(wo, wi); });
                    total += share;
                    const double number = found[pixel_index(t, s, bins)];
                    if (share * samples >= 10) {
                        add(share * samples, number);
                    } else {
                        rare += share * samples;
                        rare_found += number;
                    }
                }
            }
            if (rare >= 10) add(rare, rare_found);
            ASSERT_LT(total, 1 + 2e-3) << say(lobe, wo);
            const double outside = (1 - total) * samples;
            if (outside >= 10 && lost > 0) add(outside, lost);
            EXPECT_NEAR(lost / samples, 1 - total, 0.01) << say(lobe, wo);
            ASSERT_GE(freedom, 4) << say(lobe, wo);
            EXPECT_LT(normal_deviate(chi2, freedom - 1), 5)
                << say(lobe, wo) << ", seed " << seed << ", chi2 " << chi2 << " of " << freedom << " bins, lost "
                << lost / samples << " for " << 1 - total;
        }
    }
}

TEST(AllLobes, WeightIsFTimesCosineOverPdf) {
    std::uint64_t number = 0;
    for (const AnyLobe& lobe : all_lobes()) {
        for (int i = 0; i < 2000; ++i) {
            Random random(++number);
            const Vec3d wo = direction(std::pow(random.uniform(0.0, 1.0), 4), random.uniform(0.0, 1.0));
            const Vec3d u = random_numbers(random);
            const LobeSample<double> drawn = lobe.sample(wo, u);
            const std::string where = say(lobe, wo) + ", case " + std::to_string(number);
            ASSERT_FALSE(drawn.transmits) << where;
            ASSERT_NEAR(dot(drawn.wi, drawn.wi), 1, 1e-14) << where;
            if (!drawn.valid) {
                ASSERT_EQ(drawn.pdf, 0) << where;
                ASSERT_EQ(drawn.weight.x + drawn.weight.y + drawn.weight.z, 0) << where;
                continue;
            }
            ASSERT_GT(drawn.wi.z, 0) << where;
            const double pdf = lobe.pdf(wo, drawn.wi);
            // Phong's (R.V)^n has the error of R.V n times
            ASSERT_NEAR(drawn.pdf / pdf, 1, slack(lobe)) << where;
            const Vec3d f = lobe.f(wo, drawn.wi);
            for (int k = 0; k < 3; ++k) {
                ASSERT_NEAR(f[k] * drawn.wi.z / pdf, drawn.weight[k], slack(lobe) * std::max(1.0, drawn.weight[k]))
                    << where;
            }
        }
    }
}

TEST(AllLobes, AreReciprocal) {
    std::uint64_t number = 0;
    for (const AnyLobe& lobe : all_lobes()) {
        for (int i = 0; i < 2000; ++i) {
            Random random(++number);
            const Vec3d wo = direction(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
            const LobeSample<double> drawn = lobe.sample(wo, random_numbers(random));
            const Vec3d wi = drawn.valid ? drawn.wi : direction(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
            const Vec3d there = lobe.f(wo, wi) * (lobe.is_reciprocal ? 1.0 : wi.z);
            const Vec3d back = lobe.f(wi, wo) * (lobe.is_reciprocal ? 1.0 : wo.z);
            for (int k = 0; k < 3; ++k) {
                ASSERT_NEAR(there[k], back[k], slack(lobe) * there[k] + 1e-36) << say(lobe, wo) << ", case " << number;
            }
        }
    }
}

// A furnace of radiance 1: what leaves is the mean weight, and the integral of f cos. White lobes by themselves lose
// what their contracts say, and few give more than they get.
TEST(AllLobes, ReflectNoMoreThanTheirContractsSay) {
    std::uint64_t seed = 1000;
    for (const AnyLobe& lobe : strict_lobes()) {
        for (const Vec3d& wo : views()) {
            Random random(++seed);
            Estimate reflected[3];
            for (int i = 0; i < 20'000; ++i) {
                const LobeSample<double> drawn = lobe.sample(wo, random_numbers(random));
                for (int k = 0; k < 3; ++k) {
                    ASSERT_LE(drawn.weight[k], lobe.most_weight * (1 + 4 * lobe.roundoff))
                        << say(lobe, wo) << ", seed " << seed;
                    reflected[k].add(drawn.weight[k]);
                }
            }
            const Vec3d furnace =
                integrate(lobe.chart, wo, 0, 1, 0, 1, 80'000, [&](const Vec3d& wi) { return lobe.f(wo, wi) * wi.z; });
            for (int k = 0; k < 3; ++k) {
                const double expected = furnace[k];
                EXPECT_NEAR(reflected[k].mean(), expected, 4.5 * reflected[k].standard_error() + 2e-3)
                    << say(lobe, wo) << ", seed " << seed << ", channel " << k;
                EXPECT_LT(expected, lobe.most_albedo + 2e-3) << say(lobe, wo);
                // what a lobe is chosen by: never 0 where it reflects, and of the right size but for Phong at the
                // horizon
                EXPECT_GT(lobe.albedo(wo)[k], 0.7 * expected) << say(lobe, wo);
            }
        }
    }
}

TEST(AllLobes, AreBlackFromAndToBelowTheHorizon) {
    std::uint64_t number = 0;
    for (const AnyLobe& lobe : all_lobes()) {
        for (const double height : {0.0, -0.0, -1e-300, -1e-9, -0.5, -1.0}) {
            Random random(++number);
            const Vec3d above = direction(0.6, random.uniform(0.0, 1.0));
            const Vec3d below = direction(height, random.uniform(0.0, 1.0));
            for (const auto& [wo, wi] : {std::pair(above, below), {below, above}, {below, below}}) {
                const Vec3d f = lobe.f(wo, wi);
                EXPECT_EQ(f.x + f.y + f.z, 0) << say(lobe, wo) << ", case " << number;
                EXPECT_EQ(lobe.pdf(wo, wi), 0) << say(lobe, wo) << ", case " << number;
            }
            const LobeSample<double> drawn = lobe.sample(below, random_numbers(random));
            EXPECT_FALSE(drawn.valid) << say(lobe, below) << ", case " << number;
            EXPECT_EQ(drawn.pdf, 0) << say(lobe, below) << ", case " << number;
            EXPECT_EQ(drawn.weight.x, 0) << say(lobe, below) << ", case " << number;
        }
    }
}

TEST(AllLobes, GiveFiniteNumbersHoweverDirectionsGraze) {
    const auto is_finite = [](const Vec3d& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    std::uint64_t number = 0;
    constexpr double ends[] = {0, 0x1p-24, 0.5, 1 - 0x1p-24, 1 - 0x1p-53};
    for (const AnyLobe& lobe : all_lobes()) {
        for (int i = 0; i < 2000; ++i) {
            Random random(++number);
            const auto any_direction = [&] {
                return direction(std::exp2(-random.uniform(0.0, random.coin() ? 60.0 : 1000.0)),
                                 random.coin() ? random.below(8) / 8.0 : random.uniform(0.0, 1.0));
            };
            const Vec3d wo = any_direction();
            const Vec3d wi = random.coin() ? any_direction() : Vec3d{-wo.x, -wo.y, wo.z};
            const Vec3d u = {ends[random.below(5)], ends[random.below(5)], 0};
            const std::string where = say(lobe, wo) + ", case " + std::to_string(number);
            const Vec3d f = lobe.f(wo, wi);
            ASSERT_TRUE(is_finite(f) && f.x >= 0) << where;
            ASSERT_TRUE(std::isfinite(lobe.pdf(wo, wi)) && lobe.pdf(wo, wi) >= 0) << where;
            ASSERT_TRUE(is_finite(lobe.albedo(wo))) << where;
            const LobeSample<double> drawn = lobe.sample(wo, u);
            ASSERT_TRUE(is_finite(drawn.wi) && is_finite(drawn.weight) && std::isfinite(drawn.pdf)) << where;
            ASSERT_EQ(drawn.valid, drawn.pdf > 0) << where;
        }
    }
}

}  // namespace
}  // namespace tandem
