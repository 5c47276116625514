/// The blocks of a grid begin a stage together. Multiprocessors seem to share a cache of instructions, which large code
/// exceeds unless they all run the same stage (docs/performance/paths.md). Only for speed: a wait may end early.
/// Tested by tests/cuda/grid_pace_test.cpp.
#pragma once

#include <cstdint>

#include "tandem/math/host_device.h"

namespace tandem::cuda {

/// `Lanes`: cuda/block_lanes.h.
template <class Lanes>
class GridPace {
  public:
    /// `arrived`: a counter that all blocks share, 0 at first. `blocks`: how many wait for each other, or 0 if none
    /// does.
    TANDEM_HD GridPace(unsigned long long& arrived, std::uint32_t blocks) : arrived_(arrived), blocks_(blocks) {}

    /// Waits until all blocks have called this as often as this one. Only one thread of a block waits: a barrier has to
    /// follow.
    ///
    /// Blocks of a grid need not run at the same time: the GPU may be shared. So none waits for a block that has left,
    /// and if one does not come for `patience` cycles, no block waits any more.
    TANDEM_HD void wait() {
        if (blocks_ == 0 || Lanes::thread() != 0) return;
        expected_ += blocks_;
        Lanes::add(arrived_, 1ULL);
        const long long start = Lanes::cycles();
        while (Lanes::read(arrived_) < expected_) {
            if (Lanes::cycles() - start > patience) return leave();
            Lanes::pause();
        }
    }
    /// Every block calls this at its end.
    TANDEM_HD void leave() {
        if (blocks_ != 0 && Lanes::thread() == 0) Lanes::add(arrived_, left);
    }

    static constexpr long long patience = 1'000'000;  ///< about half a millisecond

  private:
    static constexpr unsigned long long left = 1ULL << 40;  // more than all arrivals

    unsigned long long& arrived_;
    unsigned long long expected_ = 0;
    std::uint32_t blocks_;
};

}  // namespace tandem::cuda
