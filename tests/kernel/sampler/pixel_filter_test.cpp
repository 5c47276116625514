// Where filters put samples, against their definitions.
#include "tandem/kernel/sampler/pixel_filter.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/estimate.h"
#include "support/filter_forms.h"
#include "support/input_error.h"
#include "support/pixel_index.h"
#include "support/random.h"
#include "tandem/kernel/pixel.h"
#include "tandem/math/fast_float.h"
#include "tandem/render/pixel_filter_names.h"

namespace tandem {
namespace {

using test::Estimate;
using test::expect_mean;
using test::radius_of;
using test::weight_below;

constexpr std::uint32_t numbers = 1U << 24;  ///< of to_unit_interval()

/// The distance of a sample from the middle of its pixel.
template <class Real>
double distance_of(PixelFilter filter, double u) {
    const Real x = sample_filter<Real>(filter, Real(static_cast<Scalar<Real>>(u)), Real(0.5F)).x;
    return to_wide(x) - 0.5;
}

class EachFilter : public testing::TestWithParam<PixelFilterInfo> {
  protected:
    const PixelFilter filter = GetParam().filter;
};

// What reach_of() promises to those that bound camera rays.
TEST_P(EachFilter, StaysWithinItsRadius) {
    const double radius = radius_of(filter);
    EXPECT_EQ(radius, GetParam().radius);
    double widest = 0;
    for (std::uint32_t i = 0; i < numbers; ++i) {
        const double x = distance_of<float>(filter, i * 0x1p-24);
        if (std::abs(x) > radius) FAIL() << GetParam().name << " of " << i << " is " << x;
        widest = std::max(widest, std::abs(x));
        if (i % 64 != 0) continue;
        ASSERT_LE(std::abs(distance_of<double>(filter, i * 0x1p-24)), radius) << i;
        ASSERT_LE(std::abs(distance_of<FastFloat>(filter, i * 0x1p-24)), radius * (1 + 0x1p-20)) << i;
    }
    EXPECT_EQ(widest, radius);
    EXPECT_EQ(distance_of<float>(filter, 0), -radius);
    EXPECT_EQ(distance_of<float>(filter, 0.5), 0);
}

TEST_P(EachFilter, GrowsWithTheNumberAndIsSymmetric) {
    double last = -2;
    for (int i = 0; i < 4096; ++i) {
        const double u = i / 4096.0, x = distance_of<float>(filter, u);
        EXPECT_GT(x, last) << i;
        ASSERT_NEAR(i == 0 ? -x : distance_of<float>(filter, 1 - u), -x, 0x1p-23) << i;
        last = x;
    }
}

// The share of the filter's weight below the offset of u is u; and the shares between neighbours are equal, but for the
// total variation that pixel_filter.h states.
TEST_P(EachFilter, HasTheDensityOfItsDefinition) {
    const bool is_window = filter == PixelFilter::blackman_harris;
    constexpr int intervals = 1 << 16;
    double variation = 0, last = 0;
    for (int i = 1; i <= intervals; ++i) {
        const double u = static_cast<double>(i) / intervals;
        const double below = i == intervals ? 1 : weight_below(filter, distance_of<double>(filter, u));
        EXPECT_NEAR(below, u, is_window ? 1.2e-4 : 8e-6) << i;
        variation += std::abs(below - last - 1.0 / intervals) / 2;
        last = below;
    }
    EXPECT_LE(variation, is_window ? 4.2e-4 : filter == PixelFilter::gaussian ? 4.2e-5 : 1e-9);
    for (int i = 0; i < 1000; ++i) {  // strict and fast compute the same in float
        const double u = i / 1000.0, exact = distance_of<double>(filter, u);
        EXPECT_NEAR(distance_of<float>(filter, u), exact, 1e-5) << i;
        EXPECT_NEAR(distance_of<FastFloat>(filter, u), exact, 1e-5) << i;
    }
}

/// The chi-squared statistic of offsets against a filter, over cells of an eighth of a pixel that expect 20 or more,
/// and what independent samples of it exceed once in about a million times.
struct ChiSquared {
    double value = 0, bound = 0;
};
ChiSquared chi_squared(const std::vector<double>& offsets, PixelFilter filter) {
    constexpr int cells = 32;
    std::vector<double> counts(cells, 0);
    for (const double x : offsets) counts[static_cast<std::size_t>((x + 2) * 8)] += 1;
    double seen = 0, expected = 0, freedom = -1;
    ChiSquared result;
    for (int i = 0; i < cells; ++i) {
        seen += counts[static_cast<std::size_t>(i)];
        expected += static_cast<double>(offsets.size()) *
                    (weight_below(filter, (i + 1) / 8.0 - 2) - weight_below(filter, i / 8.0 - 2));
        if (expected < 20) continue;  // together with the next
        result.value += (seen - expected) * (seen - expected) / expected;
        freedom += 1;
        seen = expected = 0;
    }
    result.value += seen;  // beyond the last cell nothing is expected but a few
    result.bound = freedom + 5 * std::sqrt(2 * freedom) + 20;
    return result;
}

TEST_P(EachFilter, PassesTheTestOfChiSquaredWhichOtherFiltersFail) {
    PixelJob job{};
    job.keys = philox_keys(11);
    job.filter = filter;
    job.film_width = 512;
    PixelRays<float> rays{};  // so that the origin of a ray is its offset
    rays.dx = {1, 0, 0};
    rays.dy = {0, 1, 0};
    rays.orthographic = true;
    using NoEffects = EffectSet<0>;
    std::vector<double> across, down;
    Estimate x, y, x2, y2, xy;
    for (std::uint32_t i = 0; i < 512 * 512; ++i) {
        const auto id = sample_of<float>(job, i % 512, i / 512, i % 7);
        const Vec3f at = sample_ray<NoEffects>(job, rays, id).origin;
        across.push_back(double{at.x} - 0.5);
        down.push_back(double{at.y} - 0.5);
        x.add(across.back()), y.add(down.back()), xy.add(across.back() * down.back());
        x2.add(across.back() * across.back()), y2.add(down.back() * down.back());
    }
    for (const PixelFilterInfo& other : pixel_filter_infos()) {
        for (const auto& offsets : {across, down}) {
            const ChiSquared chi = chi_squared(offsets, other.filter);
            EXPECT_EQ(chi.value < chi.bound, other.filter == filter)
                << other.name << ": " << chi.value << " against " << chi.bound;
        }
    }
    // by Simpson's rule of 2 x (1 - share below x)
    double variance = 0;
    constexpr int steps = 3000;
    for (int i = 0; i <= steps; ++i) {
        const double at = radius_of(filter) * i / steps;
        const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
        variance += weight * 4 * at * (1 - weight_below(filter, at)) * radius_of(filter) / steps / 3;
    }
    expect_mean(x, 0, "x");
    expect_mean(y, 0, "y");
    expect_mean(xy, 0, "xy");
    expect_mean(x2, variance, "x^2");
    expect_mean(y2, variance, "y^2");
}

// Of 64 points of a (0, 2)-sequence each of 64 equally probable boxes of any shape gets one.
TEST_P(EachFilter, KeepsPointsStratified) {
    PixelJob job{};
    job.sampler = make_job_sampler(Sampler::sobol, 5, 0);
    job.film_width = 100;
    for (int columns = 1; columns <= 64; columns *= 2) {
        const int rows = 64 / columns;
        const auto end = [&](int k, int of) {
            return k == of ? 9.0 : distance_of<float>(filter, static_cast<double>(k) / of);
        };
        std::vector<int> counts(64, 0);
        for (std::uint32_t sample = 0; sample < 64; ++sample) {
            const auto random = sample_of<float>(job, 17U, 3U, sample).block(Dimension::film);
            const Vec2f at = sample_filter<float>(filter, to_unit_interval<float>(random.word[0]),
                                                  to_unit_interval<float>(random.word[1]));
            int column = 0, row = 0;
            while (double{at.x} - 0.5 >= end(column + 1, columns)) ++column;
            while (double{at.y} - 0.5 >= end(row + 1, rows)) ++row;
            ++counts[test::pixel_index(column, row, columns)];
        }
        EXPECT_EQ(counts, std::vector<int>(64, 1)) << columns << " x " << rows;
    }
}

INSTANTIATE_TEST_SUITE_P(Filters, EachFilter, testing::ValuesIn(pixel_filter_infos()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(PixelFilterNames, AreThoseOfTheTable) {
    for (const PixelFilterInfo& info : pixel_filter_infos()) {
        EXPECT_EQ(parse_pixel_filter(to_string(info.filter)), info.filter);
    }
    EXPECT_EQ(pixel_filter_infos().front().filter, PixelFilter::box);
    EXPECT_TRUE(test::contains(test::input_error([] { (void)parse_pixel_filter("sinc"); }),
                               "the filters are box, tent, gaussian, blackman_harris"));
}

}  // namespace
}  // namespace tandem
