/// Statistics of a render.
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
    double compile = 0;   ///< linking the kernel for the scene; 0 if it was loaded already
    double upload = 0;    ///< host to device
    double render = 0;    ///< kernel, or the parallel loop over tiles
    double download = 0;  ///< device to host
};

/// Counts of events that should not happen, but do not stop a render. They have the same names in every report
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

/// The counters in words: one clause for each that is not zero.
[[nodiscard]] std::vector<std::string> in_words(const RenderCounters& counters);

struct RenderStats {
    PhaseTimes seconds;
    RenderCounters counters;
    /// All rays that were traced: camera rays, path continuations and shadow rays; of the oracle, camera rays only. A
    /// shadow ray counts once, however many alpha masks it passes.
    std::uint64_t rays = 0;
    std::size_t device_bytes = 0;
    int registers = 0;     ///< of the kernel, per thread; 0 on the CPU
    double occupancy = 0;  ///< resident warps over the most there can be; 0 on the CPU
    std::string variant;   ///< which compiled code ran, e.g. "x86-64-v3, loop, plain" or "sm_90, bvh, full"
    EffectMask effects;    ///< simulated: those that the scene needs, and those forced on
    EffectMask carried;    ///< beyond those, the effects that the code contains but does not use
    std::string warning;   ///< a problem that did not affect the film; empty if there was none
};

void add(PhaseTimes& total, const PhaseTimes& part);
/// Adds another part of the same frame: another instant, other pixels or later samples. Times, rays and events are
/// added; counts of the scene and the memory are the largest; each variant and each warning is named once.
void add(RenderStats& total, const RenderStats& part);

}  // namespace tandem
