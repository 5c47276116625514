// The sheen of cloth: f by angles, as KHR_materials_sheen writes it, and the fit of its albedo.
#include "tandem/kernel/bsdf/sheen_lobe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/bsdf/lobe_checks.h"
#include "tandem/effects/effects.h"
#include "tandem/kernel/surface_lobes.h"

namespace tandem {
namespace {

using namespace test;

/// Conty and Kulla's Lambda; the parameters are those of roughness 1 and, with a share, 0.
double fibres_before(double cosine, double alpha) {
    const double share = (1 - alpha) * (1 - alpha);
    const auto mix = [&](double rough, double smooth) { return std::lerp(rough, smooth, share); };
    const auto fit = [&](double x) {
        return mix(21.5473, 25.3245) / (1 + mix(3.82987, 3.32435) * std::pow(x, mix(0.19823, 0.16801))) -
               mix(1.97760, 1.27393) * x - mix(4.32054, 4.85967);
    };
    return cosine < 0.5 ? std::exp(fit(cosine)) : std::exp(2 * fit(0.5) - fit(1 - cosine));
}

TEST(SheenLobe, IsTheFormulaOfTheExtension) {
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        Random random(number);
        const double roughness = random.uniform(0.1, 1.0), alpha = roughness * roughness;
        const Vec3d wo = direction(random.uniform(0.016, 1.0), random.uniform(0.0, 1.0));
        const Vec3d wi = direction(random.uniform(0.016, 1.0), random.uniform(0.0, 1.0));
        const SheenLobe<double> lobe{{0.8, 0.5, 0}, roughness};
        const double angle = std::acos(std::min(1.0, normalize(wo + wi).z));
        const double density = (2 + 1 / alpha) * std::pow(std::sin(angle), 1 / alpha) / (2 * pi);
        const double seen = 1 + fibres_before(wo.z, alpha) + fibres_before(wi.z, alpha);
        const double expected = density / (seen * 4 * wo.z * wi.z);
        const Vec3d f = lobe.f(wo, wi);
        const double slack = 1e-8 * expected + 1e-12;
        ASSERT_NEAR(f.x, 0.8 * expected, slack) << "case " << number;
        ASSERT_NEAR(f.y, 0.5 * expected, slack) << "case " << number;
        ASSERT_EQ(f.z, 0) << "case " << number;
        const SheenLobe<float> strict{{1, 1, 1}, static_cast<float>(roughness)};
        if (!(expected > 1e-30)) continue;  // less than a float holds
        ASSERT_NEAR(strict.f(wo, wi).x / expected, 1, 2e-4 / alpha) << "case " << number;
    }
}

TEST(SheenLobe, AlbedoIsNearTheIntegral) {
    for (const double roughness : {0.1, 0.13, 0.2, 0.35, 0.5, 0.75, 1.0}) {
        for (const double cosine : {0.001, 0.01, 0.03, 0.06, 0.15, 0.3, 0.5, 0.8, 1.0}) {
            const SheenLobe<double> lobe{{1, 1, 1}, roughness};
            const Vec3d wo = direction(cosine, 0.3);
            const double reflected = integrate(polar_chart(1e3), wo, 0, 1, 0, 1, 100'000,
                                               [&](const Vec3d& wi) { return lobe.f(wo, wi).x * wi.z; });
            EXPECT_NEAR(lobe.white_albedo(cosine), reflected, reflected < 0.5 ? 0.06 : 0.125 * reflected)
                << roughness << ", " << cosine;
        }
    }
}

struct Covered {
    SurfaceLobes<double> lobes;
    Vec3d ambient;
};

TEST(SheenLobe, TakesFromTheRestWhatItReflects) {
    const Optics optics;
    const Sheen sheen{{0.5F, 1, 0}, 0.6F};
    MaterialTexels<double> texels;
    const Vec3d normal = {0, 0, 5};
    for (const double height : {1.0, -0.6, 0.1}) {
        const Vec3d direction = {3 * std::sqrt(1 - height * height), 0, 3 * height};
        const auto cover = [&] {
            Covered covered{};
            covered.ambient = covered.lobes.diffuse.reflectance = covered.lobes.microfacets.f0 = {1, 1, 1};
            covered.lobes.phong.specular = covered.lobes.coated.base.reflectance = {1, 1, 1};
            covered.lobes.microfacets.f90 = 1;
            apply<EffectSet<all_effects.bits()>>(sheen, MaterialPoint<double>{optics, texels, normal, direction},
                                                 covered);
            return covered;
        };
        texels.sheen_colour_texture = {1, 0.5, 1, 1};
        texels.sheen_roughness_texture = {0, 0, 0, 0.5};
        const Covered covered = cover();
        EXPECT_EQ(covered.lobes.sheen.tint, Vec3d(0.5, 0.5, 0));
        EXPECT_NEAR(covered.lobes.sheen.roughness, 0.3, 1e-7);
        const double rest = 1 - 0.5 * covered.lobes.sheen.white_albedo(std::abs(height));
        for (const Vec3d& part : {covered.ambient, covered.lobes.diffuse.reflectance, covered.lobes.microfacets.f0,
                                  covered.lobes.phong.specular, covered.lobes.coated.base.reflectance,
                                  Vec3d(covered.lobes.microfacets.f90)}) {
            EXPECT_NEAR(part.x, rest, 1e-9) << height;
            EXPECT_EQ(part.x, part.z) << height;
        }
    }
}

}  // namespace
}  // namespace tandem
