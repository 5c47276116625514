/// Maps from two uniform numbers in [0, 1) to points of a disk or polygon and to directions. They preserve
/// stratification: neighbours stay neighbours.
///
/// Tested by tests/kernel/sampler/warp_test.cpp.
#pragma once

#include "tandem/math/frame.h"
#include "tandem/math/turns.h"

namespace tandem {

/// A sampled direction and its density.
template <class Real>
struct DirectionSample {
    Vec3<Double<Real>> direction;  ///< unit
    Double<Real> pdf;              ///< with respect to solid angle, 1/sr
};

/// Uniform in the unit disk, density 1/pi; |(x, y)| <= 1 + 2^-52.
/// Source: P. Shirley, K. Chiu, "A Low Distortion Map Between Disk and Square", JGT 2(3), 1997: maps squares around the
/// centre to circles.
template <class Real>
TANDEM_HD_INLINE Vec2<Double<Real>> sample_disk(const Double<Real>& u, const Double<Real>& v) {
    using D = Double<Real>;
    const D one(1.0F);
    const D x = u + u - one;
    const D y = v + v - one;
    const Mask<Real> wide = absolute(x) > absolute(y);
    const D radius = select(wide, x, y);
    const D ratio = select(wide, y, x) / select(radius == D(0.0F), one, radius);
    const SineCosine<Real> angle = sin_cos_turns<Real>(ratio * D(0.125F));
    return {radius * select(wide, angle.cosine, angle.sine), radius * select(wide, angle.sine, angle.cosine)};
}

/// Uniform in the regular polygon whose corners lie on the unit circle, the first one `rotation` turns from +x towards
/// +y. sides >= 3. Density 2 / (n sin(2 pi / n)).
/// Method: u chooses one of the triangles around the centre, and its remainder the distance from the centre.
template <class Real>
TANDEM_HD_INLINE Vec2<Double<Real>> sample_regular_polygon(int sides, const Double<Real>& rotation,
                                                           const Double<Real>& u, const Double<Real>& v) {
    using D = Double<Real>;
    const D zero(0.0F);
    const D one(1.0F);
    const D half(0.5F);
    const D count(static_cast<Scalar<D>>(sides));
    const D scaled = u * count;
    // at an edge rounding may choose either triangle; `rest` is then 1 in one and 0 in the other
    const D sector = greater(lesser(round_to_int(scaled - half), count - one), zero);
    const D rest = greater(lesser(scaled - sector, one), zero);
    const SineCosine<Real> half_angle = sin_cos_turns<Real>(half / count);
    const D along = square_root(rest);
    const D x = along * half_angle.cosine;
    const D y = along * (v + v - one) * half_angle.sine;
    const SineCosine<Real> turn = sin_cos_turns<Real>((sector + half) / count + rotation);
    return {turn.cosine * x - turn.sine * y, turn.sine * x + turn.cosine * y};
}

/// Uniform in the aperture of a thin lens of radius 1: a polygon with `blades` corners, or a disk for 0. `rotation`: of
/// the first corner, in turns.
template <class Real>
TANDEM_HD_INLINE Vec2<Double<Real>> sample_aperture(int blades, const Double<Real>& rotation, const Double<Real>& u,
                                                    const Double<Real>& v) {
    if (blades == 0) return sample_disk<Real>(u, v);
    return sample_regular_polygon<Real>(blades, rotation, u, v);
}

/// Density of sample_cosine_hemisphere() for the cosine of the angle to the normal.
template <class D>
TANDEM_HD_INLINE D cosine_hemisphere_pdf(const D& cosine) {
    return greater(cosine, D(0.0F)) * constant<D>(inverse_pi);
}

/// A direction around a unit normal with density cos / pi, which is above 0, so never below the horizon.
/// Source: N. Malley's method (P. Shirley, C. Wang, K. Zimmerman, "Monte Carlo Techniques for Direct Lighting
/// Calculations", ACM TOG 15(1), 1996): points of a disk, lifted to the hemisphere. The height is computed from the
/// radius before the concentric map, so that it does not cancel at the horizon.
template <class Real>
TANDEM_HD_INLINE DirectionSample<Real> sample_cosine_hemisphere(const Vec3<Double<Real>>& normal, const Double<Real>& u,
                                                                const Double<Real>& v) {
    using D = Double<Real>;
    const D one(1.0F);
    const Vec2<D> point = sample_disk<Real>(u, v);
    const D radius = greater(absolute(u + u - one), absolute(v + v - one));
    // a cosine of 0 would have density 0; with 2^-30 the vector is still a unit vector
    const D cosine = greater(square_root((one - radius) * (one + radius)), D(0x1p-30F));
    return {from_frame(frame_around(normal), point.x, point.y, cosine), cosine_hemisphere_pdf(cosine)};
}

/// Density of sample_sphere(), 1/sr.
inline constexpr double uniform_sphere_pdf = inverse_pi / 4;

/// Uniform over all directions.
template <class Real>
TANDEM_HD_INLINE DirectionSample<Real> sample_sphere(const Double<Real>& u, const Double<Real>& v) {
    using D = Double<Real>;
    const D one(1.0F);
    const D radius = square_root(u * (one - u));
    const SineCosine<Real> angle = sin_cos_turns<Real>(v);
    return {{(radius + radius) * angle.cosine, (radius + radius) * angle.sine, one - (u + u)},
            constant<D>(uniform_sphere_pdf)};
}

}  // namespace tandem
