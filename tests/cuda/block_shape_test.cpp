// The layout of threads: every pixel is covered, and few threads are idle.
#include "cuda/block_shape.h"

#include <gtest/gtest.h>

namespace tandem::cuda {
namespace {

TEST(SharedPixels, HaveThreadsThatAreRarelyIdle) {
    EXPECT_EQ(sharing_threads(1), 1U);
    EXPECT_EQ(sharing_threads(2), 2U);
    EXPECT_EQ(sharing_threads(3), 1U);
    EXPECT_EQ(sharing_threads(7), 8U);
    EXPECT_EQ(sharing_threads(12), 4U);
    EXPECT_EQ(sharing_threads(64), most_sharing_threads);
    EXPECT_EQ(sharing_threads(0xFFFFFFFFU), most_sharing_threads);
    for (std::uint32_t samples = 1; samples <= 5000; ++samples) {
        const unsigned int threads = sharing_threads(samples);
        const unsigned int turns = (samples + threads - 1) / threads;
        ASSERT_LE(turns * threads * 4, samples * 5) << samples << " samples: more than a fifth of the threads are idle";
        ASSERT_EQ(most_sharing_threads % threads, 0U) << samples << " samples";
    }
}

TEST(SharedPixels, OfAWarpAreATile) {
    for (const unsigned int threads : {1U, 2U, 4U, 8U, 16U, 32U}) {
        const SharedTile tile = shared_tile(threads);
        EXPECT_EQ(tile.width * tile.height * threads, 32U);
        EXPECT_LE(tile.width, 2 * tile.height) << threads << " threads";
        EXPECT_LE(tile.height, tile.width) << threads << " threads";
    }
    EXPECT_EQ(shared_tile(1).width, warp_width);
    EXPECT_EQ(shared_tile(1).height, warp_height);
}

TEST(SharedPixels, CoverTheWindow) {
    for (const std::uint32_t width : {1U, 7U, 8U, 9U, 131U}) {
        for (const std::uint32_t height : {1U, 3U, 97U}) {
            for (const std::uint32_t samples : {1U, 2U, 4U, 8U}) {
                const RenderGrid grid = shared_pixels(width, height, samples);
                const SharedTile tile = shared_tile(grid.threads.x);
                EXPECT_EQ(grid.threads.x * grid.threads.y, block_threads);
                EXPECT_GE(grid.blocks.x * 2 * tile.width, width);
                EXPECT_LT((grid.blocks.x - 1) * 2 * tile.width, width);
                EXPECT_GE(grid.blocks.y * 2 * tile.height, height);
                EXPECT_LT((grid.blocks.y - 1) * 2 * tile.height, height);
            }
        }
    }
}

}  // namespace
}  // namespace tandem::cuda
