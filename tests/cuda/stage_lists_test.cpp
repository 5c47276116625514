// Which paths of a block wait. Needs no GPU.
#include "cuda/stage_lists.h"

#include <gtest/gtest.h>

namespace tandem::cuda {
namespace {

struct Warp {
    static constexpr std::uint32_t count = 32;
};
using Threads = ListThreads<Warp>;

TEST(HitsThatWait, AreLessThanHalfAWarp) {
    for (std::uint32_t count = 0; count < 100; ++count) {
        const std::uint32_t waiting = Threads::too_few_of(count);
        EXPECT_LT(waiting, 16U) << count;
        const std::uint32_t last = (count - waiting) % 32;
        EXPECT_TRUE(last == 0 || last >= 16) << count << ": the last warp has " << last;
    }
    EXPECT_EQ(Threads::too_few_of(15), 15U);
    EXPECT_EQ(Threads::too_few_of(16), 0U);
    EXPECT_EQ(Threads::too_few_of(64 + 3), 3U);
}

}  // namespace
}  // namespace tandem::cuda
