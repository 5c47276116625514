/// Samples one of several lights for a shadow ray.
#pragma once

#include "tandem/kernel/incident_light.h"
#include "tandem/kernel/sampler/dimensions.h"
#include "tandem/kernel/sampler/short_sequence.h"

namespace tandem {

/// Chooses one of several lights with a probability in proportion to its contribution if nothing blocks it. So a vertex
/// needs one shadow ray, and without shadows the choice adds no noise.
///
/// Gives: every light with the right probability, within 2^-52 of it and 2^-72 of the total, for any number of lights
///        and however weak one is. Lights that contribute nothing change no bit.
/// Method: a light replaces the chosen one with the probability weight / (sum of the weights so far). Each light takes
///         its own random number, because one number reused for all lights would run out of bits. It takes 24 bits, and
///         48 more where these do not decide.
/// Source: P. Shirley, C. Wang, K. Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations", ACM TOG 15(1),
///         1996; for weights that arrive one by one, M. T. Chao, "A general purpose unequal probability sampling plan",
///         Biometrika 69(3), 1982. Tested by tests/kernel/light_reservoir_test.cpp.
template <class Real>
class LightReservoir {
  public:
    using D = Double<Real>;

    TANDEM_HD explicit LightReservoir(const PhiloxBlock<UInt<Real>>& random) : numbers_(random) {}

    TANDEM_HD void offer(const IncidentLight<Real>& light) {
        const D zero(0.0);
        const Real contribution = norm1(light.reflected);
        const D weight = widen(contribution);
        const Mask<Real> contributes = weight > zero;
        if (!any(contributes || !(weight == zero))) return;  // a NaN counts
        const Mask<Real> others = total_ > zero;
        total_ = total_ + weight;
        const Mask<Real> draws = contributes && others;
        Mask<Real> taken = contributes && !others;
        if (any(draws)) taken = taken || (draws && is_taken(weight, draws));
        chosen_ = select(taken, light, chosen_);
        weight_ = select(taken, contribution, weight_);
    }

    /// The chosen light, divided by its probability: its mean is the sum over all lights.
    [[nodiscard]] TANDEM_HD IncidentLight<Real> chosen() const {
        IncidentLight<Real> light = chosen_;
        light.reflected = chosen_.reflected * to_real<Real>(total_ / widen(weight_));
        return light;
    }

  private:
    /// Whether the last light, of `weight`, replaces the chosen one, at random.
    TANDEM_HD Mask<Real> is_taken(const D& weight, const Mask<Real>& draws) {
        const auto number = [&](const Mask<Real>& takes) {
            return widen(to_unit_interval<Real>(numbers_.next(takes)));
        };
        const D step = total_ * constant<D>(0x1p-24);
        const D from = number(draws) * total_;  // the bits that are still missing add less than a step
        Mask<Real> taken = from + step <= weight;
        const Mask<Real> open = draws && !taken && from < weight;
        if (any(open)) [[unlikely]] {
            const D higher = number(open);
            const D lower = number(open);
            taken = taken || (open && from + (higher + lower * constant<D>(0x1p-24)) * step < weight);
        }
        return taken;
    }

    ShortSequence<Real> numbers_;
    D total_ = D(0.0);
    Real weight_ = Real(1.0F);
    IncidentLight<Real> chosen_ = {{Real(0.0F), Real(0.0F), Real(0.0F)}, {Real(0.0F), Real(0.0F), Real(1.0F)}};
};

/// The random numbers for LightReservoir. The number of draws varies, so only the first can come from a sequence of
/// samples.
template <class Real>
TANDEM_HD PhiloxBlock<UInt<Real>> light_choice(const SampleId<Real>& sample, const UInt<Real>& vertex) {
    const auto random = sample.random_block_at_vertex(Dimension::light, vertex);
    if (sample.is_random()) return random;
    return start_with(sample.block(Dimension::light_order, vertex).word[0], random);
}

}  // namespace tandem
