/// Weights of multiple importance sampling for two techniques.
#pragma once

#include "tandem/math/real.h"

namespace tandem {

namespace mis_detail {

/// pdf / other or its reciprocal, whichever is smaller; 1 for equal densities, infinite ones included.
template <class D>
TANDEM_HD_INLINE D smaller_ratio(const D& pdf, const D& other) {
    const D larger = greater(pdf, other);
    const D ratio = lesser(pdf, other) / select(larger > D(0.0F), larger, D(1.0F));
    return select(pdf == other, D(1.0F), ratio);
}

/// 1 / (1 + ratio) for the larger of two densities, ratio / (1 + ratio) for the smaller; 0 for the density 0.
template <class D>
TANDEM_HD_INLINE D weight(const D& pdf, const D& other, const D& ratio) {
    const D share = select(pdf < other, ratio, D(1.0F)) / (D(1.0F) + ratio);
    return select(pdf > D(0.0F), share, D(0.0F));
}

}  // namespace mis_detail

/// The weight of a sample from one technique, with density `pdf` there and density `other` in a second technique. Both
/// are in the same measure and multiplied by the technique's number of samples.
///
/// Needs: densities >= 0. An infinite one is that of a Dirac delta function and gets all the weight, unless both are
///        infinite.
/// Gives: weights in [0, 1] that sum to 1; 0 for an impossible sample (pdf = 0). No finite density overflows.
/// Source: E. Veach, L. Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995,
///         sec. 3.2: the balance heuristic.
template <class D>
TANDEM_HD_INLINE D balance_heuristic(const D& pdf, const D& other) {
    return mis_detail::weight(pdf, other, mis_detail::smaller_ratio(pdf, other));
}

/// The same with the power heuristic of exponent 2, which is better where one of the densities is far too small.
/// Source: as above, sec. 3.3.
template <class D>
TANDEM_HD_INLINE D power_heuristic(const D& pdf, const D& other) {
    const D ratio = mis_detail::smaller_ratio(pdf, other);
    return mis_detail::weight(pdf, other, ratio * ratio);
}

}  // namespace tandem
