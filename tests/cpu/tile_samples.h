/// What the tests of samples in a tile share: tiles, numbers of samples, and radiances whose sums depend on their
/// order.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <tuple>

#include "cpu/kernels.h"
#include "support/random.h"
#include "tandem/math/lanes.h"

namespace tandem::test {

inline constexpr std::uint32_t tile_film_width = 16, tile_film_height = 8;

/// To round differently in another order, the summands need many sizes.
inline Vec3d random_radiance(Random& random) {
    const auto channel = [&] { return std::ldexp(random.uniform(1.0, 2.0), static_cast<int>(random.below(60)) - 30); };
    return {channel(), channel(), channel()};
}

template <class Real>
void set_lane(Vec3<Wide<Real>>& radiances, int lane, const Vec3d& radiance) {
    radiances.x.set(lane, radiance.x);
    radiances.y.set(lane, radiance.y);
    radiances.z.set(lane, radiance.z);
}

class TileSamples : public testing::TestWithParam<std::tuple<Tile, std::uint32_t>> {
  protected:
    Tile tile_ = std::get<Tile>(GetParam());
    PixelJob job_ = [] {
        PixelJob job{};
        job.width = tile_film_width;
        job.samples = std::get<std::uint32_t>(GetParam());
        job.first_sample = 1000;
        return job;
    }();

    [[nodiscard]] std::uint64_t sample_count() const {
        return std::uint64_t{tile_.x1 - tile_.x0} * (tile_.y1 - tile_.y0) * job_.samples;
    }
    [[nodiscard]] bool is_in_tile(std::uint32_t x, std::uint32_t y) const {
        return x >= tile_.x0 && x < tile_.x1 && y >= tile_.y0 && y < tile_.y1;
    }
};

inline auto any_tile_samples() {
    return testing::Combine(testing::Values(Tile{0, 16, 0, 8}, Tile{3, 4, 5, 6}, Tile{1, 6, 2, 5}),
                            testing::Values(1U, 2U, 3U, 4U, 5U, 7U, 8U, 10U, 64U));
}

/// Compares the sums of a film with those expected.
inline void expect_equal_sums(const Vec3d* sums, const Vec3d* expected) {
    for (std::uint32_t i = 0; i < tile_film_width * tile_film_height; ++i) {
        EXPECT_TRUE(sums[i] == expected[i]) << "pixel " << i;
    }
}

}  // namespace tandem::test
