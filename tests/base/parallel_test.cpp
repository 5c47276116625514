#include "tandem/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/thread_limit.h"
#include "support/thrown_message.h"
#include "tandem/base/large_array.h"

namespace tandem {
namespace {

using test::ThreadLimit;

TEST(Parallel, ChunksCoverEveryNumberOnce) {
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        for (const std::size_t count : {0, 1, 9, 10, 11, 1000}) {
            std::vector<int> visits(count, 0);
            std::vector<std::size_t> lengths(chunk_count(count, 10), 0);
            for_each_chunk(count, 10, [&](const Chunk& chunk) {
                lengths[chunk.number] = chunk.end - chunk.begin;
                for (std::size_t i = chunk.begin; i < chunk.end; ++i) ++visits[i];
            });
            EXPECT_EQ(visits, std::vector<int>(count, 1)) << count;
            for (std::size_t i = 0; i + 1 < lengths.size(); ++i) EXPECT_EQ(lengths[i], 10U);
            EXPECT_EQ(std::accumulate(lengths.begin(), lengths.end(), std::size_t{0}), count);
        }
    }
}

TEST(Parallel, TakesNoMoreThreadsThanTheLimit) {
    const ThreadLimit limit(3);
    EXPECT_EQ(thread_limit(), 3);
    std::atomic<int> running = 0, most = 0;
    run_parallel(64, [&](std::size_t) {
        const int now = ++running;
        for (int before = most; before < now && !most.compare_exchange_weak(before, now);) {
        }
        std::this_thread::yield();
        --running;
    });
    EXPECT_LE(most, 3);
    const std::thread::id caller = std::this_thread::get_id();
    run_parallel(1, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), caller) << "no thread for one part"; });
}

TEST(Parallel, PassesOnTheErrorOfTheLowestNumber) {
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        for (int round = 0; round < 50; ++round) {
            std::atomic<int> done_below = 0;
            const auto message = test::thrown_message<std::runtime_error>([&] {
                run_parallel(100, [&](std::size_t i) {
                    if (i % 10 == 7 && i >= 17) throw std::runtime_error(std::to_string(i));
                    if (i < 17) ++done_below;
                });
            });
            EXPECT_EQ(message, "17");
            EXPECT_EQ(done_below, 17) << "those before the first error are done";
        }
    }
}

TEST(Parallel, ALoopWithinALoopTakesNoThreads) {
    const ThreadLimit limit(4);
    run_parallel(8, [&](std::size_t) {
        const std::thread::id outer = std::this_thread::get_id();
        run_parallel(8, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), outer); });
    });
}

TEST(Parallel, LargeArraysAreClearedAndKeepTheirMemory) {
    std::vector<std::uint32_t> array;
    make_large(array, 3'000'000, 4'000'000);
    EXPECT_EQ(array, std::vector<std::uint32_t>(3'000'000, 0));
    const std::uint32_t* const data = array.data();
    array.resize(4'000'000);
    EXPECT_EQ(array.data(), data);
    std::vector<double> empty;
    make_large(empty, 0, 0);
    EXPECT_TRUE(empty.empty());
}

TEST(Parallel, ThreadsHaveTheCallersRounding) {
    const ThreadLimit limit(4);
    const int before = std::fegetround();
    std::fesetround(FE_UPWARD);
    std::atomic<int> upward = 0;
    run_parallel(100, [&](std::size_t) { upward += std::fegetround() == FE_UPWARD ? 1 : 0; });
    std::fesetround(before);
    EXPECT_EQ(upward, 100);
}

}  // namespace
}  // namespace tandem
