/// Angles in turns: sine and cosine of a fraction of a full turn, and the angle of a point. Sampling of directions uses
/// these: no argument is out of range, and a quarter of a turn is exact.
#pragma once

#include "tandem/math/exact_math.h"
#include "tandem/math/fast_math.h"

namespace tandem {

inline constexpr double pi = 0x1.921fb54442d18p+1;
inline constexpr double inverse_pi = 0x1.45f306dc9c883p-2;

template <class Real>
struct SineCosine {
    Double<Real> sine;
    Double<Real> cosine;
};

namespace turns_detail {

/// sin and cos of f quarters of a turn, |f| <= 1/2.
template <class Real>
TANDEM_HD_INLINE SineCosine<Real> sine_cosine_of_quarter(const Double<Real>& f) {
    using D = Double<Real>;
    if constexpr (is_fast<Real>) {
        const D r = f * constant<D>(exact_detail::half_pi_high);
        return {fast_detail::sine(r), fast_detail::cosine(r)};
    } else {
        const Pair<D> r = two_product(f, D(exact_detail::half_pi_high));
        const D r_low = multiply_add(f, D(exact_detail::half_pi_low), r.low);
        const Pair<D> s = exact_detail::sine(r.high, r_low);
        const Pair<D> c = exact_detail::cosine(r.high, r_low);
        return {s.high + s.low, c.high + c.low};
    }
}

/// atan(t) for |t| <= tan(pi/8), relative error below 2^-52; coefficients: tests/math/minimax.py.
template <class D>
TANDEM_HD_INLINE D arctangent(const D& t) {
    if constexpr (is_fast<D>) {
        return fast_detail::arctangent(t);
    } else {
        const D z = t * t;
        const D tail = exact_detail::horner(z, -0x1.555555555553dp-2, 0x1.9999999995898p-3, -0x1.24924922aef6bp-3,
                                            0x1.c71c70e6c0640p-4, -0x1.745cf8eb2a278p-4, 0x1.3b1119589eb88p-4,
                                            -0x1.10ebaeab7d4edp-4, 0x1.df0df0786051ap-5, -0x1.9cc8c533c0df3p-5,
                                            0x1.37b27762f3d2cp-5, -0x1.25088b53c6228p-6);
        return multiply_add(t * z, tail, t);
    }
}

}  // namespace turns_detail

/// sin(2 pi u) and cos(2 pi u) for |u| < 2^48; meant for u in [0, 1). Relative error below 2^-52; in the tier fast
/// absolute error below 2^-22, and |u| < 2^19.
/// Method: 4u is exact, and so is its distance from the nearest integer, which leaves at most an eighth of a turn.
/// Tested by tests/math/turns_test.cpp.
template <class Real>
TANDEM_HD_INLINE SineCosine<Real> sin_cos_turns(const Double<Real>& u) {
    using D = Double<Real>;
    using Word = std::conditional_t<is_fast<Real>, UInt<Real>, UInt64<Real>>;
    constexpr auto to_low_bits = static_cast<Scalar<D>>(is_fast<Real> ? 0x1.8p23 : exact_detail::to_low_bits);
    const D quarters = u * D(4.0F);
    const D near = quarters + D(to_low_bits);
    const SineCosine<Real> rest = turns_detail::sine_cosine_of_quarter<Real>(quarters - (near - D(to_low_bits)));
    const Word quadrant = bits_of(near);
    const Mask<Real> odd = (quadrant & Word(1U)) == Word(1U);
    const Mask<Real> sine_below = (quadrant & Word(2U)) == Word(2U);
    const Mask<Real> cosine_below = sine_below != odd;
    const D sine = select(odd, rest.cosine, rest.sine);
    const D cosine = select(odd, rest.sine, rest.cosine);
    return {select(sine_below, -sine, sine), select(cosine_below, -cosine, cosine)};
}

/// The angle from +x to the point (x, y), in turns, in [-1/2, 1/2]: atan2(y, x) / (2 pi). 0 at the origin. Needs
/// magnitudes whose sum is finite and which are not subnormal. Relative error below 2^-50; in the tier fast 2^-21.
/// Method: reflections into the first octant, then a rotation by an eighth of a turn if the tangent is above tan(pi/8).
/// Tested by tests/math/turns_test.cpp.
template <class Real>
TANDEM_HD_INLINE Double<Real> atan2_turns(const Double<Real>& y, const Double<Real>& x) {
    using D = Double<Real>;
    const D zero(0.0F);
    const D width = absolute(x);
    const D height = absolute(y);
    const Mask<Real> steep = width < height;
    const D small = select(steep, width, height);
    const D large = select(steep, height, width);
    const Mask<Real> rotated = small > large * constant<D>(0x1.a827999fcef32p-2);
    const D divisor = select(rotated, small + large, large);
    const D tangent = select(rotated, small - large, small) / select(divisor == zero, D(1.0F), divisor);
    const D from_base = turns_detail::arctangent(tangent) * constant<D>(inverse_pi / 2);
    D turns = select(rotated, D(0.125F) + from_base, from_base);
    turns = select(steep, D(0.25F) - turns, turns);
    turns = select(x < zero, D(0.5F) - turns, turns);
    return select(y < zero, -turns, turns);
}

}  // namespace tandem
