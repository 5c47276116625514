// The layout of threads: every pixel is covered, and few threads are idle.
#include "cuda/block_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace tandem::cuda {
namespace {

struct Rule {
    std::uint32_t (*of)(std::uint32_t samples);
    std::uint32_t most;
    double idle_share;
};
constexpr std::size_t few_primitives = 41, many_primitives = 1000;
constexpr Rule rules[] = {
    {[](std::uint32_t samples) { return sharing_threads(samples, few_primitives); }, 4, 1.0 / 16},
    {[](std::uint32_t samples) { return sharing_threads(samples, many_primitives); }, 8, 1.0 / 8},
    {[](std::uint32_t samples) { return samples_in_set(samples); }, 8, 1.0 / 5},
};

TEST(SharedPixels, LeaveFewThreadsIdle) {
    const auto idle_share = [](double samples, std::uint32_t threads) {
        return 1 - samples / (std::ceil(samples / threads) * threads);
    };
    for (const Rule& rule : rules) {
        for (std::uint32_t samples = 1; samples <= 5000; ++samples) {
            const std::uint32_t threads = rule.of(samples);
            ASSERT_EQ(rule.most % threads, 0U) << samples << " samples";
            ASSERT_LE(idle_share(samples, threads), rule.idle_share) << samples << " samples";
            if (threads == rule.most) continue;
            ASSERT_GT(idle_share(samples, 2 * threads), rule.idle_share) << samples << " samples: more could share";
        }
        EXPECT_EQ(rule.of(1), 1U);
        EXPECT_EQ(rule.of(2), 2U);
        EXPECT_EQ(rule.of(64), rule.most);
        EXPECT_EQ(rule.of(0xFFFFFFFFU), rule.most);
    }
    EXPECT_EQ(sharing_threads(10, many_primitives), 2U);
    EXPECT_EQ(sharing_threads(7, many_primitives), 8U);
    EXPECT_EQ(sharing_threads(7, few_primitives), 1U);
    EXPECT_EQ(sharing_threads(64, std::size_t{1} << 32), 8U);
}

TEST(PathsInStages, AreSeveralForEachThreadOnlyWherePixelsAreMany) {
    constexpr std::uint32_t threads = 384, most = 1344;
    std::uint32_t before = 0;
    for (std::uint64_t pixels = 0; pixels < 10'000; ++pixels) {
        const std::uint32_t paths = staged_paths(pixels, threads, most);
        ASSERT_TRUE(paths % threads == 0 || paths == most) << pixels << " pixels";
        ASSERT_GE(paths, before) << pixels << " pixels";
        ASSERT_TRUE(paths == threads || pixels >= 3 * (paths - threads)) << pixels << " pixels: places stay empty";
        before = paths;
    }
    EXPECT_EQ(staged_paths(0, threads, most), threads);
    EXPECT_EQ(staged_paths(1'000'000'000'000, threads, most), most);
    EXPECT_EQ(staged_paths(1'000'000'000'000, threads, 100), 100U) << "fewer fit into the memory";
}

TEST(WarpTile, IsASquareOrTwo) {
    for (const unsigned int threads : {1U, 2U, 4U, 8U, 16U, 32U}) {
        const WarpTile tile = warp_tile(threads);
        EXPECT_EQ(tile.pixels() * threads, 32U);
        EXPECT_TRUE(tile.width() == tile.height() || tile.width() == 2 * tile.height()) << threads << " threads";
    }
}

TEST(WindowTiles, HaveEachPixelOnce) {
    for (const unsigned int threads : {1U, 2U, 8U, 32U}) {
        for (const auto& [width, height] :
             std::vector<std::pair<unsigned, unsigned>>{{1, 1}, {7, 3}, {8, 4}, {131, 9}}) {
            const WindowTiles tiles = tiles_of_window(width, height, warp_tile(threads));
            std::vector<int> counts(std::size_t{width} * height);
            for (std::uint32_t tile = 0; tile < tiles.count; ++tile) {
                EXPECT_LT(tiles.pixel(tile, 0).x, width) << "tile " << tile << " is beyond the window";
                EXPECT_LT(tiles.pixel(tile, 0).y, height) << "tile " << tile << " is beyond the window";
                for (std::uint32_t pixel = 0; pixel < tiles.tile.pixels(); ++pixel) {
                    const auto [x, y] = tiles.pixel(tile, pixel);
                    if (x < width && y < height) ++counts[std::size_t{y} * width + x];
                }
            }
            EXPECT_THAT(counts, testing::Each(1)) << width << " x " << height << ", " << threads << " threads";
        }
    }
}

TEST(SharedPixels, CoverTheWindow) {
    for (const std::uint32_t width : {1U, 7U, 8U, 9U, 131U}) {
        for (const std::uint32_t height : {1U, 3U, 97U}) {
            for (const unsigned int threads : {1U, 2U, 4U, 8U}) {
                const RenderGrid grid = shared_pixels(width, height, threads);
                const WarpTile tile = warp_tile(threads);
                EXPECT_EQ(grid.threads.x, threads);
                EXPECT_EQ(grid.threads.x * grid.threads.y, block_threads);
                EXPECT_GE(grid.blocks.x * 2 * tile.width(), width);
                EXPECT_LT((grid.blocks.x - 1) * 2 * tile.width(), width);
                EXPECT_GE(grid.blocks.y * 2 * tile.height(), height);
                EXPECT_LT((grid.blocks.y - 1) * 2 * tile.height(), height);
            }
        }
    }
}

}  // namespace
}  // namespace tandem::cuda
