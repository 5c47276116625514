/// Russian roulette: paths with a low throughput end early, and the survivors carry more.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// Probability with which a path continues: the largest component of its throughput, within [minimum, 1].
///
/// `throughput`: RGB, linear, what a unit of light at the path's end adds to the sample. `minimum` in (0, 1] bounds how
/// much a survivor can gain. A NaN counts as 0. What survives is to be divided by the probability.
/// Source: J. Arvo, D. Kirk, "Particle Transport and Image Synthesis", SIGGRAPH 1990, sec. 5.
template <class D>
TANDEM_HD D survival_probability(const Vec3<D>& throughput, const D& minimum) {
    D largest = greater(minimum, throughput.x);  // a NaN on the right is passed over
    largest = greater(largest, throughput.y);
    largest = greater(largest, throughput.z);
    return lesser(largest, D(1.0F));
}

/// Does the path go on? `u` uniform in [0, 1); with probability 1 it always does.
template <class Real>
TANDEM_HD Mask<Real> survives(const Double<Real>& probability, const Double<Real>& u) {
    return u < probability;
}

}  // namespace tandem
