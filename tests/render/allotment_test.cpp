// Where the next samples go: the ends of parts, the best allotment, and what is refused to a last round.
#include "tandem/render/allotment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "support/random.h"

namespace tandem {
namespace {

TileErrors tile_of(double variance, int samples) {
    constexpr double pixels = 1000;
    const double error = variance / samples;
    return {{pixels, pixels * error, pixels * error * error}, 1, samples};
}

/// The mean error and the mean samples after the round.
struct RoundResult {
    double error = 0, samples = 0;
};
RoundResult after(const std::vector<TileErrors>& tiles, const std::vector<int>& ends) {
    ErrorSums sum;
    for (std::size_t i = 0; i < tiles.size(); ++i) sum += predicted(tiles[i], ends[i]);
    const double samples = std::accumulate(ends.begin(), ends.end(), 0.0);
    return {sum.sum / sum.pixels, samples / static_cast<double>(tiles.size())};
}

TEST(PartEnds, AreHalfOfAPowerOfTwoApart) {
    std::vector<int> ends;
    for (int samples = 0; samples < 300; samples = ends.back()) ends.push_back(next_part_end(samples, 300));
    EXPECT_EQ(ends, (std::vector<int>{8, 16, 24, 32, 48, 64, 96, 128, 192, 256, 300}));
    EXPECT_EQ(next_part_end(300, 300), 300);
    EXPECT_EQ(next_part_end(0, 15), 15);
    EXPECT_EQ(next_part_end(1 << 23, 1 << 24), 3 << 22);
}

TEST(Allotment, IsInProportionToTheStandardDeviation) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        test::Random random(seed);
        std::vector<TileErrors> tiles;
        double deviations = 0;
        for (int i = 0; i < 200; ++i) {
            const double deviation = std::exp2(random.uniform(0.0, 4.0));
            deviations += deviation / 200;
            tiles.push_back(tile_of(deviation * deviation, first_round_end));
        }
        // n = c * deviation has the error mean(deviations) / c with c * mean(deviations) samples, the fewest possible
        const double wanted = deviations / 100;
        Allotment round;
        while (true) {
            round = allot(tiles, {.error = std::sqrt(wanted)}, 1 << 20);
            if (round.is_last) break;
            for (std::size_t i = 0; i < tiles.size(); ++i) {
                EXPECT_LE(round.ends[i], 2 * tiles[i].samples);
                tiles[i].errors = predicted(tiles[i], round.ends[i]);
                tiles[i].samples = round.ends[i];
            }
        }
        const RoundResult film = after(tiles, round.ends);
        EXPECT_LE(film.error, wanted) << "seed " << seed;
        EXPECT_GE(film.error, 0.95 * wanted) << "seed " << seed;
        // parts are 1/3 or 1/2 apart, so the number is a little above the least
        EXPECT_LE(film.samples, 1.1 * 100 * deviations) << "seed " << seed;
    }
}

TEST(Allotment, TheLastRoundHasAPartForEveryTile) {
    const std::vector<TileErrors> tiles = {tile_of(0, 16), tile_of(1, 64), tile_of(4, 128)};
    const Allotment round = allot(tiles, {.error = 0.2}, 1 << 20);
    EXPECT_TRUE(round.is_last);
    EXPECT_EQ(round.ends[0], 24);
    for (std::size_t i = 0; i < tiles.size(); ++i) EXPECT_GT(round.ends[i], tiles[i].samples);
}

TEST(Allotment, BeforeItOnlyTilesThatNeedMoreGetSamples) {
    const std::vector<TileErrors> tiles = {tile_of(0, 16), tile_of(1e-6, 16), tile_of(100, 16)};
    const Allotment round = allot(tiles, {.error = 0.1}, 1 << 20);
    EXPECT_FALSE(round.is_last);
    EXPECT_EQ(round.ends, (std::vector<int>{16, 16, 32}));
}

TEST(LookAround, ATileWithoutNoiseAmongNoisyOnesGetsSamplesToo) {
    const TileGrid grid{40, 24, 8};  // 5 x 3 tiles
    std::vector<TileErrors> tiles(grid.count(), tile_of(4, 16));
    const std::size_t quiet = 7, corner = 14;
    tiles[quiet] = tile_of(0, 16);
    tiles[13] = tile_of(4, 64);  // likewise noisy, with more samples
    const Allotment alone = allot(tiles, {.error = 0.1}, 1 << 20);
    EXPECT_EQ(alone.ends[quiet], 16);
    look_around(tiles, grid);
    EXPECT_NEAR(*tiles[quiet].likely, 0.2 * 8 / 9 * 4 / 16 * 1000, 1e-9);
    EXPECT_NEAR(*tiles[corner].likely, (0.8 + 0.2) * 4 / 16 * 1000, 1e-9) << "as if all had its samples";
    const Allotment together = allot(tiles, {.error = 0.1}, 1 << 20);
    EXPECT_EQ(together.ends[quiet], 32);
    // what is predicted for the film is of the tiles' own errors, so nothing else gets more
    for (const std::size_t i : {std::size_t{0}, corner}) EXPECT_EQ(together.ends[i], alone.ends[i]) << i;
}

TEST(Allotment, EndsWhereNoPartHelps) {
    const std::vector<TileErrors> tiles = {tile_of(0, 24), tile_of(100, 100)};
    EXPECT_EQ(allot(tiles, {.error = 0.01}, 100).ends, (std::vector<int>{24, 100}));
    EXPECT_EQ(allot(tiles, {.error = 0, .seconds = 1}, 100).ends, (std::vector<int>{48, 100}));
}

TEST(Allotment, ErrorsThatFallSlowlyNeedMoreSamples) {
    TileErrors slow = tile_of(1, 64);
    slow.exponent = 0.5;
    EXPECT_NEAR(predicted(slow, 256).sum, 0.5 * slow.errors.sum, 1e-12);
    const Allotment round = allot(std::vector{slow, tile_of(1, 64)}, {.error = 0.1}, 1 << 20);
    EXPECT_TRUE(round.is_last);
    EXPECT_GE(round.ends[1], round.ends[0]);  // a sample helps more where errors fall fast
}

}  // namespace
}  // namespace tandem
