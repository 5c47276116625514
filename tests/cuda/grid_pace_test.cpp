// Blocks that begin a stage together, with threads of the host in place of blocks. Needs no GPU.
#include "cuda/grid_pace.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "cuda/host_lane.h"

namespace tandem::cuda {
namespace {

/// Each thread of the host is a block of one thread. Its clock advances when it is read.
struct HostBlock : HostLane {
    template <class Number>
    static Number add(Number& to, Number value) {
        return std::atomic_ref(to).fetch_add(value);
    }
    static unsigned long long read(unsigned long long& from) { return std::atomic_ref(from).load(); }
    static long long cycles() { return clock += step; }
    static void pause() { std::this_thread::yield(); }

    static thread_local long long clock;
    static long long step;
};
thread_local long long HostBlock::clock = 0;
long long HostBlock::step = 0;

using Pace = GridPace<HostBlock>;

class GridPaceOf : public ::testing::Test {
  protected:
    void SetUp() override { HostBlock::step = 0; }
    unsigned long long arrived_ = 0;
};

TEST_F(GridPaceOf, LetsNoBlockPassBeforeAllHaveArrived) {
    constexpr std::uint32_t blocks = 4, stages = 200;
    std::atomic<std::uint32_t> begun = 0;
    std::atomic<int> early = 0;
    std::vector<std::jthread> threads;
    for (std::uint32_t i = 0; i < blocks; ++i) {
        threads.emplace_back([&] {
            Pace pace(arrived_, blocks);
            for (std::uint32_t stage = 1; stage <= stages; ++stage) {
                ++begun;
                pace.wait();
                if (begun.load() < stage * blocks) ++early;
            }
            pace.leave();
        });
    }
    threads.clear();
    EXPECT_EQ(early.load(), 0);
    EXPECT_EQ(begun.load(), stages * blocks);
}

TEST_F(GridPaceOf, WaitsForNoBlockOnceOneHasLeft) {
    Pace gone(arrived_, 2), other(arrived_, 2);
    gone.leave();
    for (int stage = 0; stage < 5; ++stage) other.wait();  // does not end otherwise: the clock stands still
    EXPECT_EQ(HostBlock::clock, 0);
}

TEST_F(GridPaceOf, WaitsOnceForABlockThatDoesNotRun) {
    HostBlock::step = Pace::patience / 4;
    Pace pace(arrived_, 2), other(arrived_, 2);
    const long long start = HostBlock::clock;
    pace.wait();
    EXPECT_GT(HostBlock::clock - start, Pace::patience);
    const long long ended = HostBlock::clock;
    pace.wait();
    other.wait();
    EXPECT_LT(HostBlock::clock - ended, Pace::patience) << "no block waits any more";
}

TEST_F(GridPaceOf, DoesNothingIfNoBlockWaits) {
    Pace pace(arrived_, 0);
    pace.wait();
    pace.leave();
    EXPECT_EQ(arrived_, 0U);
}

}  // namespace
}  // namespace tandem::cuda
