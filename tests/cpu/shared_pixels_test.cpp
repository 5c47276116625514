// The order in which packets take the samples of a tile, and in which their radiances are added.
#include "cpu/shared_pixels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "support/random.h"

namespace tandem {
namespace {

using Real = Lanes<float, Sse4>;
constexpr std::uint32_t film_width = 16, film_height = 8;

// to round differently in another order, the summands need many sizes
Vec3d random_radiance(test::Random& random) {
    const auto channel = [&] { return std::ldexp(random.uniform(1.0, 2.0), static_cast<int>(random.below(60)) - 30); };
    return {channel(), channel(), channel()};
}

class SharedPixels : public testing::TestWithParam<std::tuple<Tile, std::uint32_t>> {
  protected:
    Tile tile_ = std::get<Tile>(GetParam());
    PixelJob job_ = [] {
        PixelJob job{};
        job.width = film_width;
        job.samples = std::get<std::uint32_t>(GetParam());
        job.first_sample = 1000;
        return job;
    }();

    [[nodiscard]] std::uint64_t sample_count() const {
        return std::uint64_t{tile_.x1 - tile_.x0} * (tile_.y1 - tile_.y0) * job_.samples;
    }
};

TEST_P(SharedPixels, TakeEachSampleOnceAndFillEachPacketButTheLast) {
    Vec3d sums[film_width * film_height] = {};
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
            ASSERT_TRUE(x >= tile_.x0 && x < tile_.x1 && y >= tile_.y0 && y < tile_.y1) << x << ", " << y;
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
    Vec3d sums[film_width * film_height] = {}, expected[film_width * film_height] = {};
    SampleSequence<Real> samples(job_, tile_, sums);
    while (samples.next()) {
        Vec3<Wide<Real>> radiances;
        for (int i = 0; i < Real::size; ++i) {
            const Vec3d radiance = random_radiance(random);  // of an idle lane too: it must not be added
            radiances.x.set(i, radiance.x);
            radiances.y.set(i, radiance.y);
            radiances.z.set(i, radiance.z);
            Vec3d& sum = expected[samples.y()[i] * film_width + samples.x()[i]];
            if (samples.used()[i]) sum = sum + radiance;
        }
        samples.add(radiances);
    }
    for (std::size_t i = 0; i < std::size(sums); ++i) {
        EXPECT_TRUE(sums[i] == expected[i]) << "pixel " << i << ", " << job_.samples << " samples";
    }
}

INSTANTIATE_TEST_SUITE_P(OfAnyTile, SharedPixels,
                         testing::Combine(testing::Values(Tile{0, 16, 0, 8}, Tile{3, 4, 5, 6}, Tile{1, 6, 2, 5}),
                                          testing::Values(1U, 2U, 3U, 4U, 5U, 7U, 8U, 10U, 64U)));

}  // namespace
}  // namespace tandem
