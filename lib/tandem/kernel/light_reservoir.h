/// Samples one of several lights for a shadow ray.
#pragma once

#include "tandem/kernel/incident_light.h"
#include "tandem/kernel/sampler/dimensions.h"
#include "tandem/kernel/sampler/short_sequence.h"

namespace tandem {

/// One of several lights, chosen with a probability in proportion to what each would contribute if nothing blocked it.
/// So a vertex needs one shadow ray, and the choice adds no noise but that of the shadows.
///
/// Gives: every light its share on average, within 2^-52 of the share and 2^-72 of the total, however many lights there
///        are and however weak one is beside the others. Lights that contribute nothing change no bit.
/// Method: a light replaces the chosen one with the probability weight / (sum of the weights so far). Each light draws
///         a number of its own, because a single number that is reused for each light runs out of bits. It draws 24
///         bits, and 48 more where these do not decide.
/// Source: P. Shirley, C. Wang, K. Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations", ACM TOG 15(1),
///         1996; for weights that come one after the other, M. T. Chao, "A general purpose unequal probability sampling
///         plan", Biometrika 69(3), 1982. Tested by tests/kernel/light_reservoir_test.cpp.
template <class Real>
class LightReservoir {
  public:
    using D = Double<Real>;

    TANDEM_HD explicit LightReservoir(const PhiloxBlock<UInt<Real>>& random) : numbers_(random) {}

    TANDEM_HD void offer(const IncidentLight<Real>& light) {
        const D zero(0.0);
        const Real brought = norm1(light.reflected);
        const D weight = widen(brought);
        const Mask<Real> brings = weight > zero;
        if (!any(brings || !(weight == zero))) return;  // a NaN counts
        const Mask<Real> others = total_ > zero;
        total_ = total_ + weight;
        const Mask<Real> draws = brings && others;
        Mask<Real> taken = brings && !others;
        if (any(draws)) taken = taken || (draws && is_taken(weight, draws));
        chosen_ = select(taken, light, chosen_);
        weight_ = select(taken, brought, weight_);
    }

    /// The chosen light, divided by its probability: on average it contributes what all lights do.
    [[nodiscard]] TANDEM_HD IncidentLight<Real> chosen() const {
        IncidentLight<Real> light = chosen_;
        light.reflected = chosen_.reflected * to_real<Real>(total_ / widen(weight_));
        return light;
    }

  private:
    /// Does the last light, of `weight`, replace the chosen one? At random.
    TANDEM_HD Mask<Real> is_taken(const D& weight, const Mask<Real>& draws) {
        const auto number = [&](const Mask<Real>& takes)
                                TANDEM_INLINE_LAMBDA { return widen(to_unit_interval<Real>(numbers_.next(takes))); };
        const D step = total_ * constant<D>(0x1p-24);
        const D from = number(draws) * total_;  // the bits that are not drawn yet add less than a step
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

/// The numbers for LightReservoir.
template <class Real>
TANDEM_HD PhiloxBlock<UInt<Real>> light_choice(const SampleId<Real>& sample, const UInt<Real>& vertex) {
    return sample.block_at_vertex(Dimension::light, vertex);
}

}  // namespace tandem
