/// Russian roulette: paths with a low throughput end early, and the survivors are weighted up.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// Probability with which a path continues: the largest component of its throughput, within [minimum, 1].
///
/// `throughput`: RGB, linear. `minimum` in (0, 1] bounds the weight of a survivor. A NaN counts as 0. The caller
/// divides the throughput of survivors by the probability.
/// Source: J. Arvo, D. Kirk, "Particle Transport and Image Synthesis", SIGGRAPH 1990, sec. 5.
template <class D>
TANDEM_HD D survival_probability(const Vec3<D>& throughput, const D& minimum) {
    D largest = greater(minimum, throughput.x);  // a NaN on the right is ignored
    largest = greater(largest, throughput.y);
    largest = greater(largest, throughput.z);
    return lesser(largest, D(1.0F));
}

/// Whether the path continues. `u`: uniform in [0, 1). A path with probability 1 always continues.
template <class Real>
TANDEM_HD Mask<Real> survives(const Double<Real>& probability, const Double<Real>& u) {
    return u < probability;
}

}  // namespace tandem
