/// How many threads of a GPU, or lanes of a packet, share a pixel: each computes some of its samples.
#pragma once

#include <cstdint>

#include "tandem/math/host_device.h"

namespace tandem {

/// The largest power of two, up to `most`, with which at most every fifth is idle when the samples do not divide
/// evenly. `most`: a power of two.
[[nodiscard]] TANDEM_HD constexpr std::uint32_t sharing_of(std::uint32_t samples, std::uint32_t most) {
    std::uint32_t sharing = most;
    while (std::uint64_t{(samples - 1) / sharing + 1} * sharing * 4 > std::uint64_t{samples} * 5) sharing /= 2;
    return sharing;
}

}  // namespace tandem
