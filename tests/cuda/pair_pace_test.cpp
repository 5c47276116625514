// Blocks that begin a stage together, with threads of the host in place of blocks. Needs no GPU.
#include "cuda/pair_pace.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "cuda/host_lane.h"

namespace tandem::cuda {
namespace {

/// Each thread of the host is a block of one thread, on a multiprocessor of its own.
struct HostBlock : HostLane {
    static std::uint32_t multiprocessor() { return number; }
    static std::uint32_t read(std::uint32_t& from) { return std::atomic_ref(from).load(); }
    static void write(std::uint32_t& to, std::uint32_t value) { std::atomic_ref(to).store(value); }
    static void pause() {
        ++pauses;
        std::this_thread::yield();
    }

    static thread_local std::uint32_t number;
    static thread_local int pauses;
};
thread_local std::uint32_t HostBlock::number = 0;
thread_local int HostBlock::pauses = 0;

using Pace = PairPace<HostBlock>;

class PairPaceOf : public ::testing::Test {
  protected:
    Pace pace_on(std::uint32_t multiprocessor) {
        HostBlock::number = multiprocessor;
        return Pace(stages_.data());
    }
    void SetUp() override { HostBlock::pauses = 0; }

    std::array<std::uint32_t, most_paced_multiprocessors> stages_ = {};
};

// Blocks on neighbouring multiprocessors are at most one stage apart: one may be past its wait while the other is in
// it.
TEST_F(PairPaceOf, LetsNoBlockPassBeforeTheOtherHasArrived) {
    constexpr std::uint32_t blocks = 4, stages = 500;
    std::array<std::atomic<std::uint32_t>, blocks> begun = {};
    std::atomic<std::uint32_t> here = 0;
    std::atomic<int> early = 0;
    std::vector<std::jthread> threads;
    for (std::uint32_t i = 0; i < blocks; ++i) {
        threads.emplace_back([&, i] {
            Pace pace = pace_on(i);
            pace.begin();
            ++here;
            while (here.load() < blocks) std::this_thread::yield();
            for (std::uint32_t stage = 1; stage <= stages; ++stage) {
                begun[i].store(stage);
                pace.wait();
                if (begun[i ^ 1U].load() < stage) ++early;
            }
            pace.leave();
        });
    }
    threads.clear();
    EXPECT_EQ(early.load(), 0);
    for (const auto& stage : begun) EXPECT_EQ(stage.load(), stages);
}

TEST_F(PairPaceOf, WaitsForNoBlockThatHasNotBegunOrHasLeft) {
    Pace pace = pace_on(2), other = pace_on(3), of_another_pair = pace_on(4);
    of_another_pair.begin();
    pace.begin();
    for (int stage = 0; stage < 5; ++stage) pace.wait();
    other.begin();
    other.leave();
    for (int stage = 0; stage < 5; ++stage) pace.wait();  // does not end if it waits
    EXPECT_EQ(HostBlock::pauses, 0);
}

TEST_F(PairPaceOf, LetsABlockJoinLate) {
    Pace pace = pace_on(7), late = pace_on(6);
    pace.begin();
    for (int stage = 0; stage < 100; ++stage) pace.wait();
    late.begin();
    std::jthread next([&] { pace.wait(); });  // waits for one call, not for a hundred
    late.wait();
    next.join();
    late.leave();
    pace.wait();
    pace.leave();
}

TEST_F(PairPaceOf, DoesNothingBeyondTheMultiprocessorsThatItKnows) {
    Pace pace = pace_on(most_paced_multiprocessors);
    pace.begin();
    pace.wait();
    pace.leave();
    for (const std::uint32_t stage : stages_) EXPECT_EQ(stage, 0U);
}

}  // namespace
}  // namespace tandem::cuda
