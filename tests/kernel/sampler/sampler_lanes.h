/// The samplers compiled for several instruction sets. The files that implement this hold nothing that another could
/// share: see tests/math/lane_operations.h.
#pragma once

#include <cstdint>

namespace tandem::test {

/// What a block of numbers depends on, for one lane.
struct SamplerInput {
    std::uint64_t seed;
    std::uint32_t kind, frame, dimension, filter;  ///< the same in all lanes
    std::uint32_t x, y, sample, vertex;
};

struct SamplerRunner {
    int lanes;
    /// Four numbers for each lane, its light_choice(), and the bits of its sample_filter().
    void (*run)(const SamplerInput* in, std::uint32_t (*numbers)[10]);
};

SamplerRunner sampler_runner_v2();
SamplerRunner sampler_runner_v3();
SamplerRunner sampler_runner_v4();

}  // namespace tandem::test
