#include "tandem/accuracy/pareto.h"

#include <gtest/gtest.h>

namespace tandem {
namespace {

/// A point whose intervals reach `spread` to both sides.
PricedError point(double seconds, double error, double spread = 0.01) {
    return {seconds,
            {seconds * (1 - spread), seconds * (1 + spread)},
            {error, {error * (1 - spread), error * (1 + spread)}, true}};
}

TEST(Pareto, NamesWhatDominates) {
    const std::vector<PricedError> points = {point(1, 4), point(2, 2), point(4, 1), point(3, 3), point(5, 4)};
    const auto by = dominating(points);
    EXPECT_FALSE(by[0] || by[1] || by[2]) << "the front";
    EXPECT_EQ(by[3], 1U);
    EXPECT_EQ(by[4], 2U) << "the one with the least error of four";
}

TEST(Pareto, WhatCannotBeToldApartDoesNotDominate) {
    const std::vector<PricedError> points = {point(1, 1, 0.2), point(1.1, 1.1, 0.2), point(1.1, 2, 0.2)};
    const auto by = dominating(points);
    EXPECT_FALSE(by[1]) << "both intervals overlap";
    EXPECT_EQ(by[2], 0U) << "the errors do not";
    const std::vector<PricedError> equal = {point(1, 1, 0), point(1, 1, 0)};
    EXPECT_FALSE(dominating(equal)[0] || dominating(equal)[1]);
}

TEST(Pareto, FindsTheBestOfATimeAndTheFastestOfAnError) {
    const std::vector<PricedError> points = {point(1, 4), point(2, 2), point(4, 1)};
    EXPECT_EQ(best_within(points, 3), 1U);
    EXPECT_EQ(best_within(points, 0.5), std::nullopt);
    EXPECT_EQ(fastest_within(points, point(0, 2).error), 1U);
    EXPECT_EQ(fastest_within(points, point(0, 0.5).error), std::nullopt);
}

TEST(Pareto, PrefersTheFasterOfErrorsThatCannotBeToldApart) {
    const std::vector<PricedError> points = {point(3, 1), point(2, 1.005), point(1, 1.5)};
    EXPECT_EQ(best_within(points, 4), 1U);
    EXPECT_EQ(fastest_within(points, points[0].error), 1U);
}

}  // namespace
}  // namespace tandem
