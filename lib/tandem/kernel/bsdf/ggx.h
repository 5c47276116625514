/// The GGX distribution of microfacet normals, with Smith's masking, for rough reflection.
#pragma once

#include "tandem/kernel/bsdf/lobe.h"
#include "tandem/math/turns.h"

namespace tandem {

/// The least alpha; smaller ones are clamped. Its lobe is 0.01 degrees wide: too narrow to differ from a mirror in an
/// image, and wide enough for directions rounded to float.
inline constexpr float least_ggx_alpha = 0x1p-13F;

/// `alpha_x` and `alpha_y` are the widths of the distribution of slopes along x and y.
///
/// Needs: unit vectors in the local frame; those called w with w.z > 0.
/// Method: formulas in coordinates and their squares. The usual forms with 1 - cos^2 and tangents cancel or overflow on
///         smooth surfaces and at grazing angles.
/// Source: B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007; anisotropy and
///         height-correlated masking after E. Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based
///         BRDFs", JCGT 3(2), 2014, (85), (86) and (99). Tested by tests/kernel/bsdf/ggx_test.cpp.
template <class Real>
struct Ggx {
    using D = Double<Real>;
    D alpha_x = D(1.0F), alpha_y = D(1.0F);

    Ggx() = default;
    /// Clamps alphas to [least_ggx_alpha, 1]; NaN becomes the lower end.
    TANDEM_HD_INLINE Ggx(const D& x, const D& y) : alpha_x(in_range(x)), alpha_y(in_range(y)) {}

    /// D of the normal h / |h|, 1/sr. h need not be a unit vector; h.z >= 0.
    [[nodiscard]] TANDEM_HD_INLINE D density(const Vec3<D>& h) const {
        const D x = h.x / alpha_x;
        const D y = h.y / alpha_y;
        // not 0 / 0 for h = 0
        const D ratio = dot(h, h) / greater((x * x + y * y) + h.z * h.z, D(0x1p-126F));
        return ratio * ratio * constant<D>(inverse_pi) / (alpha_x * alpha_y);
    }

    /// |(alpha_x x, alpha_y y, z)|: Smith's Lambda is (extent - z) / (2 z).
    [[nodiscard]] TANDEM_HD_INLINE D extent(const Vec3<D>& w) const {
        const D x = alpha_x * w.x;
        const D y = alpha_y * w.y;
        return square_root((x * x + y * y) + w.z * w.z);
    }

    /// The fraction of the microfacets facing w that are visible from w: G1 = 2 z / (z + extent).
    [[nodiscard]] TANDEM_HD_INLINE D seen(const Vec3<D>& w) const { return (w.z + w.z) / (w.z + extent(w)); }

    /// wo.z extent(wi) + wi.z extent(wo): the fraction that is visible from both, G2, is 2 wo.z wi.z over this.
    [[nodiscard]] TANDEM_HD_INLINE D mutual_extent(const Vec3<D>& wo, const Vec3<D>& wi) const {
        return wo.z * extent(wi) + wi.z * extent(wo);
    }

    /// Samples a normal visible from w, with the density seen(w) (w . m) density(m) / w.z; m.z > 0.
    /// Method: stretched to alpha = 1, the visible normals are those of a hemisphere, and w reflected at them is
    ///         uniform in a spherical cap. So a uniform direction of the cap gives the normal. Heights are measured
    ///         from the top or the bottom of the sphere, whichever does not cancel.
    /// Source: J. Dupuy, A. Benyoub, "Sampling Visible GGX Normals with Spherical Caps", CGF 42(8), 2023; E. Heitz,
    ///         "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018.
    [[nodiscard]] TANDEM_HD_INLINE Vec3<D> sample_seen(const Vec3<D>& w, const D& u, const D& v) const {
        const D one(1.0F);
        const Vec3<D> stretched = normalize(Vec3<D>{alpha_x * w.x, alpha_y * w.y, w.z});
        const D height = one + stretched.z;
        // uniform in (-stretched.z, 1]: from the top, and from -1
        const D below_top = v * height;
        const D sine2 = stretched.x * stretched.x + stretched.y * stretched.y;
        const D above_bottom = (one - v) * height;
        const D radius = square_root(below_top * (above_bottom + sine2 / height));
        const SineCosine<Real> turn = sin_cos_turns<Real>(u);
        return normalize(Vec3<D>{alpha_x * (radius * turn.cosine + stretched.x),
                                 alpha_y * (radius * turn.sine + stretched.y), above_bottom});
    }

  private:
    TANDEM_HD_INLINE static D in_range(const D& alpha) { return lesser(greater(D(least_ggx_alpha), alpha), D(1.0F)); }
};

}  // namespace tandem
