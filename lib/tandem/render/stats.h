/// Where the time of a render went.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tandem/effects/effects.h"

namespace tandem {

/// Seconds per phase. A phase that a backend does not have is zero; phases may overlap in time.
struct PhaseTimes {
    double build = 0;     ///< acceleration structure
    double compile = 0;   ///< the kernel for the scene; 0 if it was there
    double upload = 0;    ///< host to device
    double render = 0;    ///< kernel, or the parallel loop over tiles
    double download = 0;  ///< device to host
};

/// Things that must not happen but are survived: counted, never hidden. By the same names in every report
/// (render/counters.def).
struct RenderCounters {
#define TANDEM_COUNTER(name, words) std::uint64_t name = 0;
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER

    RenderCounters& operator+=(const RenderCounters& other) {
#define TANDEM_COUNTER(name, words) name += other.name;
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER
        return *this;
    }
    friend bool operator==(const RenderCounters&, const RenderCounters&) = default;
};

/// What was counted, in words: one clause per counter that is not zero; empty if all are.
[[nodiscard]] std::vector<std::string> in_words(const RenderCounters& counters);

struct RenderStats {
    PhaseTimes seconds;
    RenderCounters counters;
    /// That were traced: of cameras, of paths that go on, and shadow rays; by the oracle, of cameras.
    std::uint64_t rays = 0;
    std::size_t device_bytes = 0;
    int registers = 0;     ///< of the kernel, per thread; 0 on the CPU
    double occupancy = 0;  ///< resident warps over the most there can be; 0 on the CPU
    std::string variant;   ///< which compiled code ran, e.g. "x86-64-v3, loop, plain" or "sm_90, bvh, full"
    EffectMask effects;    ///< that were simulated: what the scene calls for, and what was forced on
    EffectMask carried;    ///< that the code can simulate beyond those, unused
    std::string warning;   ///< what did not go as it should, though the film is right; empty if all did
};

}  // namespace tandem
