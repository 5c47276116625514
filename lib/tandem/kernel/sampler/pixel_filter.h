/// Filters of the picture (pixel_filters.def). A pixel is the mean of the light that its samples find, all with weight
/// 1: their positions in the film have the density of the filter.
///
/// Source: M. Ernst, M. Stamminger, G. Greiner, "Filter Importance Sampling", IEEE Symposium on Interactive Ray Tracing
/// 2006. The filters are products of one function of x and of y: tent: 1 - |x|; gaussian: exp(-2 x^2) - exp(-2 1.5^2),
/// as M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 4th ed., sec. 8.8; blackman_harris: the window
/// of four terms of F. Harris, "On the Use of Windows for Harmonic Analysis with the Discrete Fourier Transform",
/// Proceedings of the IEEE 66(1), 1978, with a_k = 0.35875, 0.48829, 0.14128, 0.01168.
///
/// Tested by tests/kernel/sampler/pixel_filter_test.cpp.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

enum class PixelFilter : std::uint32_t {
#define TANDEM_PIXEL_FILTER(name, radius, help) name,
#include "tandem/kernel/sampler/pixel_filters.def"
#undef TANDEM_PIXEL_FILTER
};

/// The value of LinkedFacts::filter in a kernel for every filter.
inline constexpr std::uint32_t any_filter = ~0U;

/// The filter of a job: the constant of the kernel (cuda/linked_facts.h), if there is one.
TANDEM_HD_INLINE PixelFilter filter_of(PixelFilter job) {
#if defined(TANDEM_LINKED_FILTER) && TANDEM_ON_DEVICE
    if (TANDEM_LINKED_FILTER != any_filter) return static_cast<PixelFilter>(TANDEM_LINKED_FILTER);
#endif
    return job;
}

/// How far samples may lie outside their pixel, in pixels.
TANDEM_HD_INLINE constexpr double reach_of(PixelFilter filter) {
    switch (filter) {
#define TANDEM_PIXEL_FILTER(name, radius, help)                                        \
    case PixelFilter::name: /* NOLINT(bugprone-branch-clone): some have equal radii */ \
        return (radius)-0.5;
#include "tandem/kernel/sampler/pixel_filters.def"
#undef TANDEM_PIXEL_FILTER
    }
    return 0;
}

namespace filter_detail {

/// c0 + c1 z + ... + c6 z^6.
template <class Real>
TANDEM_HD_INLINE Real polynomial(const Real& z, double c0, double c1, double c2, double c3, double c4, double c5,
                                 double c6) {
    const auto c = [](double a) __attribute__((always_inline)) { return constant<Real>(a); };
    return c(c0) + z * (c(c1) + z * (c(c2) + z * (c(c3) + z * (c(c4) + z * (c(c5) + z * c(c6))))));
}

/// The distance from the middle of the pixel beyond which the filter has the share w of its weight, on both sides
/// together; filters other than box. At most the radius R, which w = 0 gives; 0 for w = 1.
/// Method: R (1 - sqrt(w)) is the tent's. The others add sqrt(w) (1 - t) p(t), t = w^(1/4), in which the tails are
///         smooth, with polynomials p by tests/kernel/sampler/pixel_filter_fit.py.
/// Error:  the total variation of the density from the filter's is at most 4e-5 (gaussian) and 4e-4
///         (blackman_harris); that is the share of the samples that are elsewhere.
template <class Real>
TANDEM_HD_INLINE Real distance_beyond(PixelFilter filter, const Real& w) {
    const Real one(1.0F), radius(1.5F);
    const Real root = square_root(w);
    if (filter == PixelFilter::tent) return one - root;
    const Real t = square_root(root);
    const Real z = t - Real(0.5F);
    const Real p = filter == PixelFilter::gaussian
                       ? polynomial(z, -1.85673, 3.03235, -1.56099, -0.70261, 7.64743, -13.4187, 14.0505)
                       : polynomial(z, -2.83677, 6.82827, -12.4624, 25.6076, -46.5276, 60.1484, -30.9285);
    return radius * (one - root) + root * (one - t) * p;
}

/// From a uniform number in [0, 1) to an offset from the corner of the pixel. Grows with the number.
template <class Real>
TANDEM_HD_INLINE Real offset(PixelFilter filter, const Real& u) {
    const Real zero(0.0F), half(0.5F), one(1.0F);
    const Real side = u + u - one;  // exact, and so is the share beyond
    const Real distance = distance_beyond(filter, one - absolute(side));
    return half + select(side < zero, zero - distance, distance);
}

/// Out of line, so that kernels for every filter are compiled as if they had only box.
template <class Real>
TANDEM_HD_CALL Vec2<Real> offsets_aside(PixelFilter filter, Real u, Real v) {
    return {offset(filter, u), offset(filter, v)};
}

}  // namespace filter_detail

/// The position of a sample in the film, relative to the corner of its pixel, in pixels, from two uniform numbers in
/// [0, 1). Each coordinate grows with its number, so stratified numbers give stratified positions.
template <class Real>
TANDEM_HD_INLINE Vec2<Real> sample_filter(PixelFilter of_job, const Real& u, const Real& v) {
    const PixelFilter filter = filter_of(of_job);
    if (filter == PixelFilter::box) [[likely]]
        return {u, v};
#if defined(TANDEM_LINKED_FILTER) && TANDEM_ON_DEVICE
    if (TANDEM_LINKED_FILTER != any_filter) return {filter_detail::offset(filter, u), filter_detail::offset(filter, v)};
#endif
    return filter_detail::offsets_aside<Real>(filter, u, v);
}

}  // namespace tandem
