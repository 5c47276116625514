// The sum of the lobes against the full code of glTF 2.0, appendix B, written here in double from the specification.
#include "tandem/kernel/bsdf/metallic_roughness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/bsdf/lobe_checks.h"

namespace tandem {
namespace {

using namespace test;

/// B.3.5: fresnel_w, dielectric and metal, mixed; isotropic.
Vec3d appendix_b(const Vec3d& base_colour, double metallic, double roughness, const Vec3d& view, const Vec3d& light) {
    const double alpha2 = std::pow(roughness, 4);
    const Vec3d half = normalize(view + light);
    const double fresnel_weight = std::pow(1 - std::abs(dot(view, half)), 5);
    const double spread = half.z * half.z * (alpha2 - 1) + 1;
    const double distribution = alpha2 / (pi * spread * spread);
    const auto root = [&](double cosine) { return std::sqrt(alpha2 + (1 - alpha2) * cosine * cosine); };
    const double visibility = 0.5 / (view.z * root(light.z) + light.z * root(view.z));
    const double specular = visibility * distribution;
    Vec3d result;
    for (int k = 0; k < 3; ++k) {
        const double dielectric_fresnel = 0.04 + (1 - 0.04) * fresnel_weight;
        const double dielectric = base_colour[k] / pi * (1 - dielectric_fresnel) + specular * dielectric_fresnel;
        const double metal = (base_colour[k] + (1 - base_colour[k]) * fresnel_weight) * specular;
        result[k] = dielectric * (1 - metallic) + metal * metallic;
    }
    return result;
}

TEST(MetallicRoughness, IsTheMaterialOfAppendixB) {
    for (std::uint64_t number = 0; number < 50'000; ++number) {
        Random random(number);
        const auto share = [&] {
            return static_cast<float>(random.below(5) == 0 ? random.coin() : random.uniform(0.0, 1.0));
        };
        const Vec3f base = {share(), share(), share()};
        const float metallic = share();
        const float roughness = random.uniform(0.1F, 1.0F);
        const Vec3d view = direction(random.uniform(0.01, 1.0), random.uniform(0.0, 1.0));
        const auto strict = lobes_of<float>({base, metallic, roughness});
        const auto precise = lobes_of<double>({{base.x, base.y, base.z}, metallic, roughness});
        auto drawn = precise.specular.sample(view, random_numbers(random));
        if (!drawn.valid || random.coin()) drawn = precise.diffuse.sample(view, random_numbers(random));
        const Vec3d expected = appendix_b({base.x, base.y, base.z}, metallic, roughness, view, drawn.wi);
        const Vec3f in_strict = strict.specular.f(view, drawn.wi) + strict.diffuse.f(view, drawn.wi);
        const Vec3d in_precise = precise.specular.f(view, drawn.wi) + precise.diffuse.f(view, drawn.wi);
        for (int k = 0; k < 3; ++k) {
            ASSERT_NEAR(in_precise[k], expected[k], 1e-9 * expected[k]) << "case " << number;
            ASSERT_NEAR(in_strict[k], expected[k], 2e-6 * expected[k]) << "case " << number;
        }
    }
}

TEST(MetallicRoughness, EndsAreMetalAndDielectric) {
    const auto metal = lobes_of<float>({{0.9F, 0.6F, 0.3F}, 1, 0.5F});
    EXPECT_EQ(metal.specular.f0, (Vec3f{0.9F, 0.6F, 0.3F}));
    EXPECT_EQ(metal.diffuse.base.reflectance, (Vec3f{0, 0, 0}));
    EXPECT_EQ(metal.specular.facets.alpha_x, 0.25);
    EXPECT_EQ(metal.specular.facets.alpha_y, 0.25);
    const auto plastic = lobes_of<float>({{0.9F, 0.6F, 0.3F}, 0, 1});
    EXPECT_FLOAT_EQ(plastic.specular.f0.y, 0.04F);
    EXPECT_FLOAT_EQ(plastic.diffuse.f0, 0.04F);
    EXPECT_EQ(plastic.diffuse.base.reflectance, (Vec3f{0.9F, 0.6F, 0.3F}));
    const auto water = lobes_of<float>({{1, 1, 1}, 0, 0, 1.33F});
    EXPECT_FLOAT_EQ(water.diffuse.f0, 0.33F * 0.33F / (2.33F * 2.33F));
    EXPECT_EQ(water.specular.facets.alpha_x, least_ggx_alpha);
}

TEST(MetallicRoughness, AnisotropyIsThatOfTheExtension) {
    const auto lobes = lobes_of<double>({{1, 1, 1}, 1, 0.5, 1.5, 0.5});
    EXPECT_DOUBLE_EQ(lobes.specular.facets.alpha_x, 0.25 + 0.75 * 0.25);
    EXPECT_DOUBLE_EQ(lobes.specular.facets.alpha_y, 0.25);
}

}  // namespace
}  // namespace tandem
