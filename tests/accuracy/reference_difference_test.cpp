#include "tandem/accuracy/reference_difference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "noisy_images.h"
#include "support/input_error.h"

namespace tandem {
namespace {

using test::constant_image;
using test::noisy_image;
using test::Random;

TEST(ReferenceDifference, OfExactReferencesIsExact) {
    const Reference white{constant_image(4, 3, {1, 1, 1})}, dark{constant_image(4, 3, {0.5F, 0.5F, 0.5F})};
    const ErrorEstimate error = difference_of(white, dark);
    EXPECT_TRUE(error.resolved);
    EXPECT_DOUBLE_EQ(error.value, 0.5);
    EXPECT_DOUBLE_EQ(error.interval.low, 0.5);
    EXPECT_DOUBLE_EQ(error.interval.high, 0.5);
    const ErrorEstimate none = difference_of(white, white);
    EXPECT_FALSE(none.resolved);
    EXPECT_EQ(none.interval.high, 0);
}

TEST(ReferenceDifference, OfNoisyOnesCoversTheTruth) {
    constexpr int trials = 400;
    for (const double truth : {0.0, 0.02, 0.3}) {
        int covered = 0, resolved = 0;
        double squares = 0;
        Random random(7);  // one for all: those of neighbouring seeds share most of their numbers
        for (int trial = 0; trial < trials; ++trial) {
            const auto image = [&](double mean) { return noisy_image(random, 20, 15, mean, 0.1); };
            const Reference a{image(0.5), image(0.5)}, b{image(0.5 + truth), image(0.5 + truth)};
            const ErrorEstimate error = difference_of(a, b);
            covered += error.interval.low <= truth && truth <= error.interval.high ? 1 : 0;
            resolved += error.resolved ? 1 : 0;
            squares += error.value * error.value / trials;
        }
        EXPECT_GE(covered, trials * 0.92) << truth;
        EXPECT_NEAR(squares, truth * truth, 0.001) << truth;
        EXPECT_LE(resolved, truth == 0 ? trials * 0.06 : trials) << truth;
        EXPECT_GE(resolved, truth == 0.3 ? trials : 0) << truth;
    }
}

TEST(ReferenceDifference, NeedsOneSize) {
    const Reference a{constant_image(4, 3, {1, 1, 1})}, b{constant_image(3, 4, {1, 1, 1})};
    EXPECT_TRUE(test::contains(test::input_error([&] { (void)difference_of(a, b); }), "4 x 3 and 3 x 4"));
}

}  // namespace
}  // namespace tandem
