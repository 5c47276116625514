// The Sobol samplers: direction numbers against the primitive polynomials; the elementary intervals of every pair; the
// scrambling of pixels and dimensions as if independent; the order of convergence; the order over pixels.
#include "tandem/kernel/sampler/sobol.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "support/random.h"
#include "tandem/kernel/light_reservoir.h"
#include "tandem/kernel/pixel.h"

namespace tandem {
namespace {

constexpr std::array low_discrepancy = {Sampler::sobol, Sampler::sobol_blue};

PixelJob job_of(Sampler kind, std::uint64_t seed = 1, std::uint32_t frame = 0) {
    PixelJob job{};
    job.keys = philox_keys(seed);
    job.sampler = make_job_sampler(kind, seed, frame);
    job.frame = frame;
    job.film_width = 1024;
    return job;
}

/// A pair of numbers of a dimension at a vertex.
struct Place {
    Dimension dimension;
    std::uint32_t vertex;
    int u, v;
};

const std::vector<Place> places = {
    {Dimension::film, 0, 0, 1},        {Dimension::lens, 0, 0, 1},        {Dimension::scatter, 0, 0, 1},
    {Dimension::scatter, 3, 2, 3},     {Dimension::area_light, 0, 1, 2},  {Dimension::area_light, 2, 3, 0},
    {Dimension::hemisphere, 1, 0, 1},  {Dimension::hemisphere, 1, 2, 3},  {Dimension::environment, 0, 0, 1},
    {Dimension::environment, 0, 2, 3}, {Dimension::microfacets, 5, 0, 1}, {Dimension::light_order, 2, 0, 1}};

SobolPair<std::uint32_t> point(const PixelJob& job, std::uint32_t x, std::uint32_t y, std::uint32_t sample,
                               const Place& place) {
    const auto block = sample_of<float>(job, x, y, sample).block(place.dimension, place.vertex);
    return {block.word[place.u], block.word[place.v]};
}

/// The Sobol sequence as the literature defines it, from a primitive polynomial and the first direction numbers.
/// Source: I. Sobol, 1967; in the form of P. Bratley, B. Fox, "Algorithm 659", ACM TOMS 14(1), 1988.
class SobolDimension {
  public:
    /// x^degree + a_1 x^(degree - 1) + ... + 1, with a_1 ... in the bits of `inner`, the first one highest.
    SobolDimension(unsigned degree, std::uint32_t inner, std::vector<std::uint64_t> m) {
        for (unsigned i = degree; i < 32; ++i) {
            std::uint64_t next = m[i - degree] ^ (m[i - degree] << degree);
            for (unsigned k = 1; k < degree; ++k) next ^= ((inner >> (degree - 1 - k)) & 1U) * (m[i - k] << k);
            m.push_back(next);
        }
        for (unsigned i = 0; i < 32; ++i) direction_[i] = static_cast<std::uint32_t>(m[i] << (31 - i));
    }
    [[nodiscard]] std::uint32_t operator()(std::uint32_t number) const {
        std::uint32_t result = 0;
        for (unsigned bit = 0; bit < 32; ++bit) result ^= (number >> bit & 1U) * direction_[bit];
        return result;
    }

  private:
    std::array<std::uint32_t, 32> direction_{};
};

TEST(Sobol, HasTheDirectionNumbersOfThePrimitivePolynomials) {
    const SobolDimension second(1, 0, {1});  // x + 1
    test::Random random(1);
    for (std::uint32_t i = 0; i < 100'000; ++i) {
        const std::uint32_t number = i < 50'000 ? i : static_cast<std::uint32_t>(random.bits());
        std::uint32_t radical_inverse = 0;  // the first dimension
        for (unsigned bit = 0; bit < 32; ++bit) radical_inverse |= (number >> bit & 1U) << (31 - bit);
        ASSERT_EQ(reversed_bits(number), radical_inverse) << number;
        ASSERT_EQ(sobol_detail::pascal(radical_inverse), second(number)) << number;
    }
}

TEST(Sobol, PascalsMatricesAreEachOthersTransposed) {
    for (unsigned i = 0; i < 32; ++i) {
        for (unsigned j = 0; j < 32; ++j) {
            const bool above = (sobol_detail::pascal(1U << i) >> j & 1U) != 0;
            EXPECT_EQ(above, (sobol_detail::pascal_transposed(1U << j) >> i & 1U) != 0) << i << " " << j;
        }
    }
}

/// Whether each of 2^a by 2^(k - a) boxes, for every a, has one of the points.
void expect_net(const std::vector<SobolPair<std::uint32_t>>& points, unsigned k, const char* what) {
    ASSERT_EQ(points.size(), std::size_t{1} << k);
    for (unsigned a = 0; a <= k; ++a) {
        std::vector<bool> has(points.size());
        for (const auto& p : points) {
            const std::uint64_t column = std::uint64_t{p.u} >> (32 - a), row = std::uint64_t{p.v} >> (32 - (k - a));
            has[static_cast<std::size_t>(column << (k - a) | row)] = true;
        }
        ASSERT_EQ(std::count(has.begin(), has.end(), true), static_cast<std::ptrdiff_t>(points.size()))
            << what << ": 2^" << k << " points, 2^" << a << " columns";
    }
}

TEST(Sobol, EveryPairHasAPointInEveryElementaryInterval) {
    for (const Sampler kind : low_discrepancy) {
        for (std::uint64_t seed = 0; seed < 8; ++seed) {
            test::Random random(seed);
            const PixelJob job = job_of(kind, random.bits(), random.below(100));
            const std::uint32_t x = random.below(1024), y = random.below(1024);
            for (const Place& place : places) {
                for (unsigned k = 0; k <= 10; ++k) {
                    const std::uint32_t first = random.below(1U << (24 - k)) << k;
                    std::vector<SobolPair<std::uint32_t>> points;
                    for (std::uint32_t i = 0; i < 1U << k; ++i) points.push_back(point(job, x, y, first + i, place));
                    expect_net(points, k, "samples of a pixel");
                    if (HasFatalFailure()) FAIL() << "seed " << seed << ", sample " << first;
                }
            }
        }
    }
}

TEST(Sobol, OfABlockOfPixelsTheSamplesFillTheIntervalsOfEachDimension) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        test::Random random(seed);
        const PixelJob job = job_of(Sampler::sobol_blue, random.bits());
        for (const Place& place : places) {
            for (unsigned k = 0; k <= 5; ++k) {
                for (unsigned j = 0; j <= 3; ++j) {
                    const std::uint32_t edge = 1U << j;
                    const std::uint32_t left = random.below(1024 / edge) * edge, top = random.below(1024 / edge) * edge;
                    const unsigned bits = k + 2 * j;
                    std::vector<bool> u(std::size_t{1} << bits), v = u;
                    std::vector<SobolPair<std::uint32_t>> firsts;
                    for (std::uint32_t pixel = 0; pixel < edge * edge; ++pixel) {
                        for (std::uint32_t sample = 0; sample < 1U << k; ++sample) {
                            const auto p = point(job, left + pixel % edge, top + pixel / edge, sample, place);
                            u[static_cast<std::size_t>(std::uint64_t{p.u} >> (32 - bits))] = true;
                            v[static_cast<std::size_t>(std::uint64_t{p.v} >> (32 - bits))] = true;
                            if (sample == 0) firsts.push_back(p);
                        }
                    }
                    ASSERT_EQ(std::count(u.begin(), u.end(), false), 0) << "2^" << k << " samples, edge " << edge;
                    ASSERT_EQ(std::count(v.begin(), v.end(), false), 0) << "2^" << k << " samples, edge " << edge;
                    expect_net(firsts, 2 * j, "first samples of a block");
                }
            }
        }
    }
}

/// Chi-squared of counts in `cells` cells that should be equal. 255 degrees of freedom: mean 255, standard deviation
/// 22.6; outside of 160 to 375 with probability 1e-6 each.
double chi_squared(const std::array<std::uint32_t, 256>& counts) {
    double total = 0, sum = 0;
    for (const std::uint32_t count : counts) total += count;
    for (const std::uint32_t count : counts) sum += (count - total / 256) * (count - total / 256) / (total / 256);
    return sum;
}
void expect_uniform(const std::array<std::uint32_t, 256>& counts, const std::string& what) {
    EXPECT_GT(chi_squared(counts), 150) << what;
    EXPECT_LT(chi_squared(counts), 390) << what;
}

std::string name_of(const Place& place) {
    return "dimension " + std::to_string(static_cast<unsigned>(place.dimension)) + " number " + std::to_string(place.u);
}

TEST(Sobol, OverPixelsEveryNumberOfASampleIsUniform) {
    const PixelJob job = job_of(Sampler::sobol);
    for (const Place& place : places) {
        for (const std::uint32_t sample : {0U, 1U, 77U}) {
            std::array<std::array<std::uint32_t, 256>, 4> counts{};
            for (std::uint32_t pixel = 0; pixel < 1U << 16; ++pixel) {
                const auto p = point(job, pixel % 256, pixel / 256, sample, place);
                ++counts[0][p.u >> 24];
                ++counts[1][p.u >> 16 & 0xFFU];
                ++counts[2][p.v >> 24];
                ++counts[3][p.v >> 16 & 0xFFU];
            }
            for (const auto& count : counts) expect_uniform(count, name_of(place));
        }
    }
}

/// The leading four bits of two numbers.
std::uint32_t cell(std::uint32_t a, std::uint32_t b) { return (a >> 28) << 4 | b >> 28; }

TEST(Sobol, OverPixelsTheNumbersOfASampleAreIndependent) {
    const PixelJob job = job_of(Sampler::sobol);
    for (std::size_t i = 0; i < places.size(); ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            std::array<std::array<std::uint32_t, 256>, 2> counts{};
            for (std::uint32_t pixel = 0; pixel < 1U << 15; ++pixel) {
                const std::uint32_t sample = pixel % 3;
                const auto a = point(job, pixel % 256, pixel / 256, sample, places[i]);
                const auto b = point(job, pixel % 256, pixel / 256, sample, places[j]);
                ++counts[0][cell(a.u, b.v)];
                if (i != j) ++counts[1][cell(a.u, b.u)];
            }
            expect_uniform(counts[0], name_of(places[i]) + " and " + name_of(places[j]));
            if (i != j) expect_uniform(counts[1], name_of(places[i]) + " and " + name_of(places[j]));
        }
    }
}

TEST(Sobol, NeighbouringPixelsFramesAndSeedsAreIndependent) {
    const PixelJob job = job_of(Sampler::sobol), other_frame = job_of(Sampler::sobol, 1, 1);
    const PixelJob other_seed = job_of(Sampler::sobol, 2), far_seed = job_of(Sampler::sobol, (1ULL << 32) + 1);
    for (const Place& place : places) {
        std::array<std::array<std::uint32_t, 256>, 5> counts{};
        for (std::uint32_t pixel = 0; pixel < 1U << 15; ++pixel) {
            const std::uint32_t x = pixel % 256, y = pixel / 256, sample = pixel % 5;
            const std::uint32_t here = point(job, x, y, sample, place).u;
            ++counts[0][cell(here, point(job, x + 1, y, sample, place).u)];
            ++counts[1][cell(here, point(job, x, y + 1, sample, place).u)];
            ++counts[2][cell(here, point(other_frame, x, y, sample, place).u)];
            ++counts[3][cell(here, point(other_seed, x, y, sample, place).u)];
            ++counts[4][cell(here, point(far_seed, x, y, sample, place).u)];
        }
        for (std::size_t i = 0; i < counts.size(); ++i)
            expect_uniform(counts[i], name_of(place) + " with " + std::to_string(i));
    }
}

// The samples of one pixel: two pairs of dimensions are combined as if at random, although each has its own order.
TEST(Sobol, WithinAPixelThePairsAreCombinedAsIfAtRandom) {
    const PixelJob job = job_of(Sampler::sobol);
    constexpr std::uint32_t samples = 16;  // one of each leading four bits
    for (std::size_t i = 1; i < places.size(); ++i) {
        std::array<std::uint32_t, 256> counts{};
        for (std::uint32_t pixel = 0; pixel < 1U << 11; ++pixel) {
            for (std::uint32_t sample = 0; sample < samples; ++sample) {
                const auto a = point(job, pixel % 64, pixel / 64, sample, places[i]);
                const auto b = point(job, pixel % 64, pixel / 64, sample, places[i - 1]);
                ++counts[cell(a.u, b.u)];
            }
        }
        // each row and column has the same sum in every pixel, which takes 30 degrees of freedom: mean 240 at most
        EXPECT_LT(chi_squared(counts), 375) << name_of(places[i]);
        EXPECT_GT(chi_squared(counts), 120) << name_of(places[i]);
    }
}

using Integrand = std::function<double(double, double)>;

double fraction(std::uint32_t word) { return static_cast<double>(to_unit_interval<float>(word)); }

/// The mean of an integrand over the samples of a pixel.
double estimate(const PixelJob& job, std::uint32_t x, std::uint32_t y, std::uint32_t samples, const Integrand& f) {
    double sum = 0;
    for (std::uint32_t i = 0; i < samples; ++i) {
        const auto p = point(job, x, y, i, places[4]);
        sum += f(fraction(p.u), fraction(p.v));
    }
    return sum / samples;
}

const Integrand smooth = [](double u, double v) { return std::exp(u * v) * (1 + u - v * v); };
const Integrand edge = [](double u, double v) { return u + 0.3 * v < 0.6 ? 1.0 : 0.0; };
const Integrand disk = [](double u, double v) { return std::hypot(u - 0.5, v - 0.5) < 0.387 ? 1.0 : 0.0; };

double integral_of(const Integrand& f) {
    constexpr int steps = 2000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) sum += f((i + 0.5) / steps, (j + 0.5) / steps);
    }
    return sum / steps / steps;
}

/// The exponent of the root mean square error over pixels against the samples, from 8 to 1024 of them.
double slope(Sampler kind, const Integrand& f) {
    const PixelJob job = job_of(kind);
    const double truth = integral_of(f);
    double xy = 0, xx = 0;
    for (int k = 3; k <= 10; ++k) {
        double squares = 0;
        constexpr std::uint32_t pixels = 400;
        for (std::uint32_t i = 0; i < pixels; ++i) {
            squares += std::pow(estimate(job, i * 37 % 1024, i * 101 % 1024, 1U << k, f) - truth, 2);
        }
        xy += (k - 6.5) * 0.5 * std::log2(squares / pixels);
        xx += (k - 6.5) * (k - 6.5);
    }
    return xy / xx;
}

TEST(Sobol, ConvergesWithTheOrderOfScrambledNets) {
    EXPECT_NEAR(slope(Sampler::random, smooth), -0.5, 0.04);
    for (const Sampler kind : low_discrepancy) {
        EXPECT_NEAR(slope(kind, smooth), -1.5, 0.12);  // A. Owen, 1997: N^-1.5 times a power of log N
        EXPECT_NEAR(slope(kind, disk), -0.75, 0.06);   // an edge along a curve
    }
}

/// The variance of the error's mean over aligned blocks of 4 x 4 pixels, over that of independent pixels.
double clumping(Sampler kind, std::uint32_t samples, const Integrand& f) {
    const PixelJob job = job_of(kind);
    const double truth = integral_of(f);
    double of_pixels = 0, of_blocks = 0;
    constexpr std::uint32_t blocks = 32, size = 4;
    for (std::uint32_t block = 0; block < blocks * blocks; ++block) {
        double sum = 0;
        for (std::uint32_t pixel = 0; pixel < size * size; ++pixel) {
            const double error =
                estimate(job, block % blocks * size + pixel % size, block / blocks * size + pixel / size, samples, f) -
                truth;
            sum += error;
            of_pixels += error * error;
        }
        of_blocks += sum * sum;
    }
    return of_blocks / of_pixels;
}

TEST(Sobol, BlueNoiseHasLittleErrorAtLowFrequencies) {
    for (const std::uint32_t samples : {1U, 2U, 4U}) {
        EXPECT_NEAR(clumping(Sampler::sobol, samples, smooth), 1, 0.2) << samples;
        EXPECT_LT(clumping(Sampler::sobol_blue, samples, smooth), 0.25) << samples;
        EXPECT_LT(clumping(Sampler::sobol_blue, samples, edge), 0.6) << samples;
    }
}

TEST(Sobol, TheFirstChoiceOfALightIsStratifiedAndTheOthersRandom) {
    for (const Sampler kind : low_discrepancy) {
        const PixelJob job = job_of(kind);
        std::array<bool, 256> has{};
        std::array<std::uint32_t, 256> second{};
        for (std::uint32_t i = 0; i < 256; ++i) {
            ShortSequence<float> numbers(light_choice(sample_of<float>(job, 5, 6, i), std::uint32_t{2}));
            has[numbers.next(true) >> 24] = true;
            ++second[numbers.next(true) >> 24];
        }
        EXPECT_EQ(std::count(has.begin(), has.end(), true), 256);
        EXPECT_LT(std::count(second.begin(), second.end(), 0U), 120) << "of 94, on average";
        EXPECT_GT(std::count(second.begin(), second.end(), 0U), 70);
    }
}

TEST(Sobol, MortonNumbersFollowSquares) {
    for (std::uint32_t y = 0; y < 64; ++y) {
        for (std::uint32_t x = 0; x < 64; ++x) {
            std::uint32_t want = 0;
            for (unsigned bit = 0; bit < 6; ++bit)
                want |= (x >> bit & 1U) << 2 * bit | (y >> bit & 1U) << (2 * bit + 1);
            EXPECT_EQ(morton(x, y), want);
        }
    }
    EXPECT_EQ(morton(65535U, 65535U), 0xFFFFFFFFU);
    EXPECT_EQ(morton(65535U, 0U), 0x55555555U);
}

}  // namespace
}  // namespace tandem
