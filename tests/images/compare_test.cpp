#include "tandem/images/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tandem/base/error.h"

namespace tandem {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A film of one row and one sample per pixel, grey.
Film row(const std::vector<double>& values) {
    Film film(static_cast<int>(values.size()), 1, 1);
    for (std::size_t i = 0; i < values.size(); ++i) film.sums()[i] = {values[i], values[i], values[i]};
    return film;
}

/// Which tolerances a pixel of grey `a` against grey `b` is beyond, in their order.
std::string beyond(double a, double b) {
    const FilmDifference difference = compare(row({a}), row({b}));
    std::string result;
    for (const Tolerance tolerance : tolerances) result += difference.residual_rate(tolerance) == 1.0 ? '1' : '0';
    return result;
}

TEST(Compare, EqualFilmsDifferInNothing) {
    const FilmDifference difference = compare(row({0, 1, nan, infinity}), row({0, 1, nan, infinity}));
    EXPECT_EQ(difference.pixels, 4U);
    EXPECT_EQ(difference.differing_sums, 0U);
    for (const Tolerance tolerance : tolerances) EXPECT_EQ(difference.residual_rate(tolerance), 0.0);
    EXPECT_EQ(difference.largest, 0.0);
    EXPECT_EQ(difference.mean, 0.0);
    EXPECT_EQ(difference.rms, 0.0);
}

TEST(Compare, MeanAndRootMeanSquare) {
    const FilmDifference difference = compare(row({0, 1, 2, 3}), row({0, 1, 2, 7}));
    EXPECT_EQ(difference.mean, 1.0);
    EXPECT_EQ(difference.rms, 2.0);
    EXPECT_EQ(difference.largest, 4.0);
    EXPECT_EQ(compare(row({1, 2}), row({1, infinity})).rms, infinity);
}

TEST(Compare, TheCurveAtItsBorders) {
    EXPECT_EQ(beyond(0.0, -0.0), "1000");
    EXPECT_EQ(beyond(1, 1 - 0x1p-24), "1000");
    EXPECT_EQ(beyond(1, 1 - 0x1p-20), "1000") << "2^-20 itself is within";
    EXPECT_EQ(beyond(1, 1 - 0x1p-20 - 0x1p-23), "1100");
    EXPECT_EQ(beyond(0.5, 0.5 + 1 / 256.0), "1100") << "less than a level";
    EXPECT_EQ(beyond(0.5, 0.5 + 1 / 254.0), "1110");
    EXPECT_EQ(beyond(0.5, 0.5 + 1 / 32.0), "1111");
    EXPECT_EQ(beyond(1e-3, 2e-3), "1101") << "much of a little cannot be seen";
    EXPECT_EQ(beyond(20, 40), "1101") << "both are white";
    EXPECT_EQ(beyond(-3, -1), "1101") << "both are black";
    EXPECT_EQ(beyond(1e-30, -1e-30), "1101");
}

TEST(Compare, WhatIsNotFinite) {
    EXPECT_EQ(beyond(nan, 0), "1111");
    EXPECT_EQ(beyond(nan, infinity), "1111");
    EXPECT_EQ(beyond(nan, -nan), "1000") << "two NaN differ by their bits only";
    EXPECT_EQ(beyond(infinity, 1), "1101") << "infinitely far, and white as well";
    EXPECT_EQ(beyond(infinity, -infinity), "1111");
    EXPECT_EQ(beyond(infinity, infinity), "0000");
    EXPECT_EQ(compare(row({1, nan}), row({1, 1})).largest, infinity);
}

TEST(Compare, OneChannelMakesAPixelDiffer) {
    Film a = row({0.5, 0.5, 0.5}), b = row({0.5, 0.5, 0.5});
    a.sums()[0].x = 0.75;
    a.sums()[1].y = 0.75;
    a.sums()[2].z = 0.75;
    EXPECT_EQ(compare(a, b).residual_rate(Tolerance::relative_5_percent), 1.0);
}

TEST(Compare, SharesLargestAndMean) {
    const FilmDifference difference = compare(row({0, 0.25, 0.5, 1}), row({0, 0.25, 0.75, 0.875}));
    EXPECT_EQ(difference.differing_sums, 2U);
    EXPECT_EQ(difference.residual_rate(Tolerance::bits), 0.5);
    EXPECT_EQ(difference.largest, 0.25);
    EXPECT_EQ(difference.mean, 0.375 / 4);
}

TEST(Compare, SumsMayDifferWhereMeansDoNot) {
    Film a = row({1}), b(1, 1, 2);
    b.sums()[0] = {2, 2, 2};
    EXPECT_EQ(compare(a, b).differing_sums, 1U);
    EXPECT_EQ(compare(a, b).residual_rate(Tolerance::bits), 0.0);
    b = row({1 + 0x1p-40});
    EXPECT_EQ(compare(a, b).differing_sums, 1U);
    EXPECT_EQ(compare(a, b).residual_rate(Tolerance::bits), 0.0);
}

TEST(Compare, SizesMustBeEqual) {
    EXPECT_THROW((void)compare(Film(2, 1, 1), Film(1, 2, 1)), InputError);
    EXPECT_THROW((void)compare(Film(), Film()), InputError);
}

TEST(Compare, TolerancesHaveNames) { EXPECT_STREQ(to_string(Tolerance::relative_2_to_m20), "2^-20 relative"); }

}  // namespace
}  // namespace tandem
