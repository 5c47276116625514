// The levels that the GPU finds are those of tone_map(), for any sums.
#include "cuda/level_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "cuda/cuda_backend.h"
#include "cuda/memory.h"
#include "support/random.h"
#include "tandem/images/tone_curve.h"

namespace tandem::cuda {
namespace {

class LevelsOn : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!why_cuda_unavailable().empty()) GTEST_SKIP() << why_cuda_unavailable();
    }

    /// Compares the levels of a film from the GPU with the host's.
    void expect_same(const Film& film, const Display& display) {
        const LevelLayout layout{3 * film.pixel_count()};
        constexpr std::size_t guard = 16;  // behind the output, to stay as it is
        const std::size_t bytes = film.pixel_count() * sizeof(Vec3d);
        sums_.reserve(bytes);
        levels_.reserve(layout.bytes() + guard);
        check(cudaMemcpy(sums_.data(), film.sums().data(), bytes, cudaMemcpyHostToDevice), "uploading sums");
        check(cudaMemset(levels_.data(), 0x5A, layout.bytes() + guard), "filling memory");
        const SrgbLevels::Entries& table = srgb_level_entries();
        entries_.reserve(sizeof(table));
        check(cudaMemcpy(entries_.data(), table.data(), sizeof(table), cudaMemcpyHostToDevice), "uploading levels");
        const auto* entries = reinterpret_cast<const std::uint32_t*>(entries_.data());
        find_levels(reinterpret_cast<const Vec3d*>(sums_.data()), film.pixel_count(),
                    {static_cast<double>(film.samples()), exposure_factor(display),
                     display.transfer == TransferFunction::srgb ? entries : nullptr},
                    levels_.data(), nullptr);
        std::vector<std::uint8_t> found(layout.bytes() + guard);
        check(cudaMemcpy(found.data(), levels_.data(), found.size(), cudaMemcpyDeviceToHost), "downloading levels");
        const ToneMapped expected = tone_map(film, display);
        unsigned long long nan_values = 0;
        std::memcpy(&nan_values, &found[layout.nan_values()], sizeof(nan_values));
        EXPECT_EQ(nan_values, expected.nan_values);
        for (std::size_t i = 0; i < layout.values; ++i) {
            ASSERT_EQ(found[i], expected.image.values[i]) << in_words(display) << ", value " << i;
        }
        EXPECT_TRUE(std::ranges::all_of(std::span(found).last(guard), [](std::uint8_t b) { return b == 0x5A; }));
    }

    Buffer<DeviceMemory> sums_, levels_, entries_;
};

constexpr Display displays[] = {{TransferFunction::srgb, 0},      {TransferFunction::srgb, 0.3},
                                {TransferFunction::srgb, 100},    {TransferFunction::linear, 0},
                                {TransferFunction::linear, -0.7}, {TransferFunction::linear, -100}};

TEST_F(LevelsOn, TheGpuAreThoseOfTheHostForAnySums) {
    test::Random random(1);
    for (const int width : {1, 2, 3, 4, 5, 127, 400}) {
        Film film(width, width < 100 ? 1 : 50, 100);
        for (Vec3d& sum : film.sums()) {
            sum = {random.uniform(-1.0, 101.0), random.uniform(0.0, 30.0), widen(random.any_float())};
        }
        for (const Display& display : displays) expect_same(film, display);
    }
}

// The floats around every border between levels, and what is no number.
TEST_F(LevelsOn, TheGpuAreThoseOfTheHostAtTheBorders) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<float> values = {0.0F, -0.0F, -1.0F, 1.0F, infinity, -infinity, std::nanf(""), 1e-45F, 3e38F};
    for (std::uint32_t level = 1; level < 256; ++level) {
        for (const TransferFunction transfer : {TransferFunction::srgb, TransferFunction::linear}) {
            const auto is_below = [&](float x) { return to_level(x, transfer) < level; };
            float low = 0.0F, high = 1.0F;  // the least float of the level, by bisection
            while (std::nextafter(low, 1.0F) < high) {
                const float middle = low + (high - low) / 2;
                (is_below(middle) ? low : high) = middle;
            }
            for (const float x : {low, high, std::nextafter(low, 0.0F), std::nextafter(high, 1.0F)}) {
                values.push_back(x);
            }
        }
    }
    while (values.size() % 3 != 0) values.push_back(std::nanf(""));
    for (const int samples : {1, 3}) {
        Film film(static_cast<int>(values.size() / 3), 1, samples);
        for (std::size_t i = 0; i < values.size(); ++i) {
            reinterpret_cast<double*>(film.sums().data())[i] = static_cast<double>(values[i]) * samples;
        }
        for (const Display& display : displays) expect_same(film, display);
    }
}

}  // namespace
}  // namespace tandem::cuda
