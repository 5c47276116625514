/// What the tests of all lights estimate from samples.
#pragma once

#include <string>

#include "support/estimate.h"
#include "support/random.h"
#include "tandem/kernel/sampler/warp.h"

namespace tandem::test {

/// The largest double below 1.
inline constexpr double below_one = 1 - 0x1p-53;

/// Irradiance under a light of radiance 1 onto a surface with the normal +z.
template <class View>
Estimate irradiance(const View& view, std::uint64_t seed) {
    Random random(seed);
    Estimate estimate;
    for (int i = 0; i < 100'000; ++i) {
        const auto s = sample_light(view, random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
        estimate.add(s.direction.z / s.pdf);
    }
    return estimate;
}

/// Integral of the density that pdf_of() gives over all directions: 1.
template <class View>
Estimate whole_density(const View& view, std::uint64_t seed) {
    Random random(seed);
    Estimate estimate;
    for (int i = 0; i < 200'000; ++i) {
        const auto any = sample_sphere<float>(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
        estimate.add(pdf_of(view, any.direction) / any.pdf);
    }
    return estimate;
}

}  // namespace tandem::test
