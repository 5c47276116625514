/// Phong's reflection model, exactly as in the paper.
#pragma once

#include "tandem/math/exact_math.h"
#include "tandem/math/fast_math.h"
#include "tandem/math/vec.h"

namespace tandem {

/// Reflectances per RGB channel, linear, each in [0, 1]; shininess >= 0.
struct PhongMaterial {
    Vec3f ambient{0.08F, 0.08F, 0.08F};  ///< ka
    Vec3f diffuse{0.8F, 0.8F, 0.8F};     ///< kd
    Vec3f specular{1.0F, 1.0F, 1.0F};    ///< ks
    float shininess = 32.0F;             ///< alpha
};

/// cos^shininess with cos clamped to [0, 1]; 0^0 is 1.
///
/// Gives: within 1 ulp of float for every shininess up to 1e8: the cosine stays double, since rounding it to float
///        first costs shininess * 2^-24, 45 % at 1e6 (docs/numerics.md).
template <class Real>
TANDEM_HD_SHARED Real specular_lobe(Double<Real> cosine, Real shininess) {
    using D = Double<Real>;
    const D one(1.0);
    const D clamped = select(cosine > one, one, cosine);
    return to_real<Real>(power<Real>(clamped, widen(shininess)));
}

/// Contribution of one light, without the ambient term: kd (L.N) id + ks (R.V)^alpha is, with R = 2 (L.N) N - L.
/// A term counts only where its dot product is positive.
///
/// `normal`, `to_light`, `to_viewer`: unit vectors, world space, double. `light`: intensity id = is, RGB.
/// Source: B. T. Phong, "Illumination for Computer Generated Pictures", CACM 18(6), 1975; docs/paper.md row 3.
template <class Real>
TANDEM_HD Vec3<Real> phong_light(const Vec3<Real>& diffuse, const Vec3<Real>& specular, const Real& shininess,
                                 const Vec3<Real>& light, const Vec3<Double<Real>>& normal,
                                 const Vec3<Double<Real>>& to_light, const Vec3<Double<Real>>& to_viewer) {
    using D = Double<Real>;
    const D zero(0.0);
    const D light_cosine = dot(to_light, normal);
    const Real diffuse_weight = to_real<Real>(select(light_cosine > zero, light_cosine, zero));
    const D twice = light_cosine + light_cosine;
    const Vec3<D> mirrored = {twice * normal.x - to_light.x, twice * normal.y - to_light.y,
                              twice * normal.z - to_light.z};
    const D mirror_cosine = dot(mirrored, to_viewer);
    Real specular_weight(0.0F);
    if (any(mirror_cosine > zero && norm1(specular) > Real(0.0F))) {
        const Real lobe = specular_lobe<Real>(select(mirror_cosine > zero, mirror_cosine, D(1.0)), shininess);
        specular_weight = select(mirror_cosine > zero, lobe, Real(0.0F));
    }
    return (diffuse * diffuse_weight + specular * specular_weight) * light;
}

}  // namespace tandem
