/// The sheen of cloth: light that fibres along the normal scatter back, most of it at grazing angles.
#pragma once

#include "tandem/effects/effects.h"
#include "tandem/kernel/bsdf/lambert.h"
#include "tandem/kernel/bsdf/material_point.h"
#include "tandem/kernel/bsdf/sheen.h"

namespace tandem {

/// f = colour D / (4 (1 + Lambda_o + Lambda_i) cos_o cos_i), with D = (2 + 1/a) sin^(1/a) / 2 pi of the half vector and
/// a = roughness^2: KHR_materials_sheen, "Sheen distribution" and "Sheen visibility".
///
/// Two bounds keep f and its noise finite: a roughness below 1/10 counts as 1/10, and cosines in the visibility below
/// 2^-6 as 2^-6. At grazing angles a white sheen of roughness 0.2 reflects 1.14, and one of 0.1 reflects 1.9 of the
/// light; with 0.4 and above it is less than 1. This is a property of the model.
///
/// Method: directions by the cosine alone, as Lambert. The weight is pi f.
/// Gives: f within a relative 1e-8 and 1e-12 of the formula in precise, and within 2e-4 / a in strict, the rounding of
///        the roughness to float included. The exponent 1/a magnifies the rounding of the half vector's sine.
/// Source: A. Conty Estevez, C. Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017 courses. Tested by
///         tests/kernel/bsdf/sheen_lobe_test.cpp and all_lobes_test.cpp.
template <class Real>
struct SheenLobe {
    using D = Double<Real>;
    static constexpr LobeFlags flags = LobeFlags::reflection | LobeFlags::diffuse;
    static constexpr int numbers = 2;
    static constexpr float least_roughness = 0.1F;
    static constexpr float least_cosine = 0x1p-6F;

    Vec3<Real> tint;  ///< RGB, each in [0, 1]
    Real roughness;   ///< in [0, 1]

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> colour() const { return tint; }
    [[nodiscard]] TANDEM_HD_INLINE Mask<Real> scatters() const { return norm1(tint) > Real(0.0F); }

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> f(const Vec3<D>& wo, const Vec3<D>& wi) const {
        return select(both_above<Real>(wo, wi), tint * to_real<Real>(white_f(wo, wi)), black<Real>());
    }

    [[nodiscard]] TANDEM_HD_INLINE D pdf(const Vec3<D>& wo, const Vec3<D>& wi) const { return base().pdf(wo, wi); }

    [[nodiscard]] TANDEM_HD_INLINE LobeSample<Real> sample(const Vec3<D>& wo, const Vec3<D>& u) const {
        LobeSample<Real> drawn = base().sample(wo, u);
        const Real weight = to_real<Real>(white_f(wo, drawn.wi) * constant<D>(pi));
        drawn.weight = select(drawn.valid, tint * weight, black<Real>());
        return drawn;
    }

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> albedo(const Vec3<D>& wo) const {
        return tint * (white_albedo(wo.z) + Real(0.01F));
    }

    /// The albedo of a white sheen for light that leaves at the angle with this cosine. A fit for cosines from 0.001 to
    /// 1: within 0.06 of the integral where that is below 1/2, and within 12.5 % elsewhere.
    [[nodiscard]] TANDEM_HD_INLINE Real white_albedo(const D& cosine) const {
        const D r = bounded_roughness();
        const auto polynomial = [&](double a4, double a3, double a2, double a1, double a0) {
            const D lead = (constant<D>(a4) * r + constant<D>(a3)) * r + constant<D>(a2);
            return (lead * r + constant<D>(a1)) * r + constant<D>(a0);
        };
        const D constant_part = polynomial(7.90600727, -23.81646999, 25.98875907, -11.71785086, 1.6465073);
        const D of_root = polynomial(-38.25664957, 91.6481803, -75.48039024, 23.63510204, -2.3073142);
        const D of_cosine = polynomial(-4.96021016, 39.77331823, -74.51157398, 54.47778922, -15.8187511);
        const D root = square_root(greater(cosine, D(0.0F)));
        return to_real<Real>(exponential<Real>(constant_part + root * (of_root + root * of_cosine)));
    }

    TANDEM_HD_INLINE friend SheenLobe select(const Mask<Real>& mask, const SheenLobe& a, const SheenLobe& b) {
        return {select(mask, a.tint, b.tint), select(mask, a.roughness, b.roughness)};
    }

  private:
    [[nodiscard]] TANDEM_HD_INLINE static Lambert<Real> base() { return {white<Real>()}; }

    [[nodiscard]] TANDEM_HD_INLINE D bounded_roughness() const {
        return greater(widen(roughness), widen(Real(least_roughness)));
    }

    /// Lambda of the visibility at the angle with this cosine: hidden fibres per visible one.
    [[nodiscard]] TANDEM_HD_INLINE static D hidden(const D& cosine, const D& mix) {
        const auto between = [&](double at_one, double at_zero) {
            return constant<D>(at_one) + constant<D>(at_zero - at_one) * mix;
        };
        const D a = between(21.5473, 25.3245), b = between(3.82987, 3.32435), c = between(0.19823, 0.16801);
        const D d = between(-1.97760, -1.27393), e = between(-4.32054, -4.85967);
        const auto exponent = [&](const D& x) { return a / (D(1.0F) + b * power<Real>(x, c)) + d * x + e; };
        const Mask<Real> grazes = cosine < D(0.5F);
        const D there = exponent(select(grazes, cosine, D(1.0F) - cosine));
        const D middle = exponent(D(0.5F));
        return exponential<Real>(select(grazes, there, middle + middle - there));
    }

    /// Of a white sheen, with both directions above the surface.
    [[nodiscard]] TANDEM_HD_INLINE D white_f(const Vec3<D>& wo, const Vec3<D>& wi) const {
        const D r = bounded_roughness();
        const D alpha = r * r;
        const D inverse = D(1.0F) / alpha;
        const Vec3<D> h = wo + wi;
        const D across = h.x * h.x + h.y * h.y;
        const D sine2 = greater(across / greater(across + h.z * h.z, D(0x1p-120F)), D(0x1p-100F));
        const D density = (D(2.0F) + inverse) * power<Real>(sine2, inverse * D(0.5F)) * constant<D>(inverse_pi / 2);
        const D straight = (D(1.0F) - alpha) * (D(1.0F) - alpha);
        const auto bounded = [](const D& cosine) { return lesser(greater(cosine, D(least_cosine)), D(1.0F)); };
        const D cos_o = bounded(wo.z), cos_i = bounded(wi.z);
        const D seen = D(1.0F) + (hidden(cos_o, straight) + hidden(cos_i, straight));
        return density / (seen * (D(4.0F) * (cos_o * cos_i)));
    }
};

/// Puts the sheen over the material, which keeps what the fibres do not reflect to the viewer: the simplified albedo
/// scaling of KHR_materials_sheen.
template <class Effects, class Real, class Reflectance>
TANDEM_HD void apply(const Sheen& sheen, const MaterialPoint<Real>& at, Reflectance& surface) {
    auto& lobes = surface.lobes;
    const Rgba<Real>& colour = at.texels.sheen_colour_texture;
    SheenLobe<Real>& fibres = lobes.sheen;
    fibres.tint = broadcast<Real>(sheen.colour) * Vec3<Real>{colour.r, colour.g, colour.b};
    fibres.roughness = Real(sheen.roughness) * at.texels.sheen_roughness_texture.a;
    const Real most = greater(greater(fibres.tint.x, fibres.tint.y), fibres.tint.z);
    const Real rest = greater(Real(1.0F) - most * fibres.white_albedo(at.view_cosine()), Real(0.0F));
    surface.ambient = surface.ambient * rest;
    lobes.diffuse.reflectance = lobes.diffuse.reflectance * rest;
    lobes.phong.specular = lobes.phong.specular * rest;
    if (Effects::has(Effect::microfacets) && lobes.used.has(Effect::microfacets)) {
        lobes.coated.base.reflectance = lobes.coated.base.reflectance * rest;
        lobes.microfacets.f0 = lobes.microfacets.f0 * rest;
        lobes.microfacets.f90 = lobes.microfacets.f90 * rest;
    }
}

}  // namespace tandem
