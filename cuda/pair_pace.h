/// Two multiprocessors begin a stage together: those that share a cache of instructions, which large code exceeds
/// unless both run the same stage. On an H200 they are those with the numbers 2 i and 2 i + 1
/// (docs/performance/paths.md). Only for speed: no result depends on it. Tested by tests/cuda/pair_pace_test.cpp.
#pragma once

#include <cstdint>

#include "tandem/math/host_device.h"

namespace tandem::cuda {

/// Multiprocessors with higher numbers do not wait.
inline constexpr std::uint32_t most_paced_multiprocessors = 512;

/// Of a block that has its multiprocessor to itself. All its threads call the functions; one of them waits, so a
/// barrier of the block has to follow. `Lanes`: cuda/block_lanes.h.
///
/// Blocks of a grid need not run at the same time: the GPU may be shared. So none waits for a block that has not begun
/// or has left. Of two blocks, the one that is behind does not wait, so they never wait for each other.
template <class Lanes>
class PairPace {
  public:
    /// `stages`: most_paced_multiprocessors words in device memory, 0 at first, which the blocks of a grid share.
    TANDEM_HD explicit PairPace(std::uint32_t* stages)
        : stages_(stages),
          number_(Lanes::multiprocessor()),
          waits_(Lanes::thread() == 0 && number_ < most_paced_multiprocessors) {}

    /// Joins the other block at its stage.
    TANDEM_HD void begin() {
        if (!waits_) return;
        const std::uint32_t other = other_stage();
        enter(other == not_here ? first_stage : other);
    }
    /// Waits until the other block has called this as often.
    TANDEM_HD void wait() {
        if (!waits_) return;
        enter(stage_ + 1);
        while (is_behind(other_stage())) Lanes::pause();
    }
    TANDEM_HD void leave() {
        if (waits_) enter(not_here);
    }

  private:
    static constexpr std::uint32_t not_here = 0, first_stage = 1;

    TANDEM_HD void enter(std::uint32_t stage) {
        stage_ = stage;
        Lanes::write(stages_[number_], stage);
    }
    [[nodiscard]] TANDEM_HD std::uint32_t other_stage() const { return Lanes::read(stages_[number_ ^ 1U]); }
    [[nodiscard]] TANDEM_HD bool is_behind(std::uint32_t other) const {
        return other != not_here && other != stage_ && stage_ - other < UINT32_MAX / 2;
    }

    std::uint32_t* stages_;
    std::uint32_t number_;
    std::uint32_t stage_ = not_here;
    bool waits_;
};

}  // namespace tandem::cuda
