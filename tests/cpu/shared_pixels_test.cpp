// The order in which packets take the samples of a tile, and in which their radiances are added.
#include "cpu/shared_pixels.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "cpu/tile_samples.h"

namespace tandem {
namespace {

using Real = Lanes<float, Sse4>;
using SharedPixels = test::TileSamples;

TEST_P(SharedPixels, TakeEachSampleOnceAndFillEachPacketButTheLast) {
    Vec3d sums[test::tile_film_width * test::tile_film_height] = {};
    SampleSequence<Real> samples(job_, tile_, sums);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> taken;  // by pixel
    std::uint64_t packets = 0, lanes = 0;
    std::uint32_t x = 0, y = 0;
    while (samples.next()) {
        ++packets;
        bool has_new_pixels = false;
        for (int i = 0; i < Real::size && samples.used()[i]; ++i, ++lanes) {
            const std::uint32_t of_pixel = taken[{samples.x()[i], samples.y()[i]}]++;
            ASSERT_EQ(samples.sample()[i], job_.first_sample + of_pixel);
            if (of_pixel != 0) {
                ASSERT_EQ(std::pair(samples.x()[i], samples.y()[i]), std::pair(x, y)) << "left before its last sample";
            }
            has_new_pixels = has_new_pixels || of_pixel == 0;
            x = samples.x()[i];
            y = samples.y()[i];
            ASSERT_TRUE(is_in_tile(x, y)) << x << ", " << y;
        }
        if (has_new_pixels) {
            ASSERT_TRUE(samples.has_new_pixels());
        }
    }
    EXPECT_EQ(lanes, sample_count());
    EXPECT_EQ(packets, (sample_count() + Real::size - 1) / Real::size);
    for (const auto& [pixel, count] : taken) EXPECT_EQ(count, job_.samples);
}

TEST_P(SharedPixels, AreSumsInTheOrderOfTheirSamples) {
    test::Random random(job_.samples);
    Vec3d sums[test::tile_film_width * test::tile_film_height] = {},
                                       expected[test::tile_film_width * test::tile_film_height] = {};
    SampleSequence<Real> samples(job_, tile_, sums);
    while (samples.next()) {
        Vec3<Wide<Real>> radiances;
        for (int i = 0; i < Real::size; ++i) {
            const Vec3d radiance = test::random_radiance(random);  // of an idle lane too: it must not be added
            test::set_lane<Real>(radiances, i, radiance);
            Vec3d& sum = expected[samples.y()[i] * test::tile_film_width + samples.x()[i]];
            if (samples.used()[i]) sum = sum + radiance;
        }
        samples.add(radiances);
    }
    test::expect_equal_sums(sums, expected);
}

INSTANTIATE_TEST_SUITE_P(OfAnyTile, SharedPixels, test::any_tile_samples());

}  // namespace
}  // namespace tandem
