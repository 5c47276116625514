#include "tandem/accuracy/image_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "noisy_images.h"
#include "support/input_error.h"
#include "tandem/base/error.h"

namespace tandem {
namespace {

using test::constant_image;
using test::noisy_image;
using test::Random;

TEST(ImageErrors, OfAConstantDifferenceAreWhatTheDefinitionSays) {
    const Reference reference{constant_image(40, 25, {0.5F, 0.5F, 0.5F})};
    ErrorMeter meter(reference);
    const ImageErrors errors = meter.add(constant_image(40, 25, {0.75F, 0.5F, 0.25F}));
    EXPECT_DOUBLE_EQ(errors.squared, 2 * 0.0625 / 3);
    EXPECT_NEAR(errors.relative, 2 * 0.0625 / 3 / (0.25 + 0.01 * 0.25), 1e-12);
    EXPECT_NEAR(errors.trimmed, errors.relative, 1e-12);
    EXPECT_EQ(errors.broken, 0U);
    EXPECT_EQ(meter.reference_variance().squared, 0);
    EXPECT_EQ(reference.noise_floor(), 0);
}

TEST(ImageErrors, TrimmingLeavesOutTheBrightestPixelInAThousand) {
    const Reference reference{constant_image(50, 40, {1, 1, 1})};
    FloatImage image = constant_image(50, 40, {1.5F, 1.5F, 1.5F});
    image.pixels[7] = {100, 100, 100};
    image.pixels[1234] = {90, 90, 90};
    ErrorMeter meter(reference);
    const ImageErrors errors = meter.add(image);
    EXPECT_NEAR(errors.trimmed, 0.25 / 1.01, 1e-12) << "2 of 2000 pixels are left out";
    EXPECT_GT(errors.relative, 5);
    image.pixels[99] = {80, 80, 80};
    EXPECT_GT(meter.add(image).trimmed, 2) << "a third one is not";
}

TEST(ImageErrors, CountsPixelsThatAreNotFinite) {
    const Reference reference{constant_image(4, 3, {1, 1, 1})};
    FloatImage image = constant_image(4, 3, {2, 2, 2});
    image.pixels[0].x = std::numeric_limits<float>::quiet_NaN();
    image.pixels[5].z = std::numeric_limits<float>::infinity();
    ErrorMeter meter(reference);
    const ImageErrors errors = meter.add(image);
    EXPECT_EQ(errors.broken, 2U);
    EXPECT_DOUBLE_EQ(errors.squared, 1) << "the mean over the other pixels";
    EXPECT_EQ(meter.mean_image().pixels[0].x, 1.0F);
}

TEST(ImageErrors, OfABlackReferenceAreAbsolute) {
    const Reference reference{constant_image(4, 3, {0, 0, 0})};
    ErrorMeter meter(reference);
    EXPECT_DOUBLE_EQ(meter.add(constant_image(4, 3, {0.5F, 0.5F, 0.5F})).relative, 0.25);
}

// References as noisy as the image: against one of them the square of the error is twice what it is.
TEST(ImageErrors, TwoReferencesRemoveTheBiasOfTheirNoise) {
    constexpr std::uint64_t seed = 11;
    SCOPED_TRACE(seed);
    Random random(seed);
    const double noise = 0.1;
    double by_pair = 0, by_one = 0, floor = 0;
    constexpr int trials = 200;
    for (int trial = 0; trial < trials; ++trial) {
        const FloatImage a = noisy_image(random, 20, 20, 1, noise), b = noisy_image(random, 20, 20, 1, noise);
        const FloatImage x = noisy_image(random, 20, 20, 1, noise);
        const Reference pair{a, b}, one{a};
        by_pair += ErrorMeter(pair).add(x).squared / trials;
        by_one += ErrorMeter(one).add(x).squared / trials;
        floor += pair.noise_floor() / trials;
    }
    // 240,000 values: a standard deviation of less than 0.5 % of the square
    EXPECT_NEAR(by_pair, noise * noise, 0.02 * noise * noise);
    EXPECT_NEAR(by_one, 2 * noise * noise, 0.02 * noise * noise);
    EXPECT_NEAR(floor, noise, 0.01 * noise);
}

TEST(ImageErrors, VarianceOfReferencesIsThatOfTheEstimate) {
    constexpr std::uint64_t seed = 5;
    SCOPED_TRACE(seed);
    Random random(seed);
    constexpr double bias = 0.02, noise = 0.05;
    constexpr int trials = 1500;
    double sum = 0, squares = 0, estimated = 0;
    for (int trial = 0; trial < trials; ++trial) {
        const Reference pair{noisy_image(random, 12, 10, 1, noise), noisy_image(random, 12, 10, 1, noise)};
        ErrorMeter meter(pair);
        // no noise of its own: all variance is that of the references
        const double value = meter.add(constant_image(12, 10, {1.02F, 1.02F, 1.02F})).squared;
        sum += value / trials;
        squares += value * value / trials;
        estimated += meter.reference_variance().squared / trials;
    }
    EXPECT_NEAR(sum, bias * bias, 3e-5);
    const double observed = squares - sum * sum;
    EXPECT_NEAR(estimated / observed, 1, 0.15);
}

TEST(Reference, RefusesWhatItCannotCompare) {
    const auto of_size = [](int width, int height) { return constant_image(width, height, {1, 1, 1}); };
    EXPECT_TRUE(test::contains(test::input_error([&] { (void)Reference(of_size(2, 2), of_size(2, 3)); }), "2 x 3"));
    EXPECT_TRUE(test::contains(test::input_error([&] { (void)Reference(FloatImage{}); }), "0 x 0"));
    FloatImage broken = of_size(3, 2);
    broken.pixels[4].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(test::contains(test::input_error([&] { (void)Reference(of_size(3, 2), broken); }), "pixel (1, 1)"));
    const Reference reference{of_size(3, 2)};
    EXPECT_TRUE(test::contains(test::input_error([&] { (void)ErrorMeter(reference).add(of_size(2, 3)); }), "2 x 3"));
}

}  // namespace
}  // namespace tandem
