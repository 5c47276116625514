#include "tandem/report/format_number.h"

#include <gtest/gtest.h>

#include <limits>

namespace tandem {
namespace {

TEST(FormatNumber, SecondsTakeTheUnitThatFits) {
    EXPECT_EQ(format_seconds(35.3294), "35.3 s");
    EXPECT_EQ(format_seconds(0.2256), "226 ms");
    EXPECT_EQ(format_seconds(0.00472), "4.72 ms");
    EXPECT_EQ(format_seconds(9.7e-7), "970 ns");
    EXPECT_EQ(format_seconds(0), "0");
}

TEST(FormatNumber, CountsTakeThousandsMillionsBillions) {
    EXPECT_EQ(format_count(92e9), "92 G");
    EXPECT_EQ(format_count(119.4e6), "119 M");
    EXPECT_EQ(format_count(12), "12");
    EXPECT_EQ(format_count(0), "0");
}

TEST(FormatNumber, LargeNumbersKeepEveryDigit) {
    EXPECT_EQ(format_number(35329.4), "35,329");
    EXPECT_EQ(format_number(-1234567), "-1,234,567");
    EXPECT_EQ(format_number(156.6), "157");
    EXPECT_EQ(format_number(std::numeric_limits<double>::infinity()), "inf");
}

TEST(FormatNumber, ASmallShareIsNotZero) {
    EXPECT_EQ(format_share(0), "0");
    EXPECT_EQ(format_share(1e-9), "1e-07 %");
    EXPECT_EQ(format_share(0.05), "5 %");
}

TEST(FormatNumber, SummariesAndRatiosSayWhatTheyLack) {
    EXPECT_EQ(format_summary({}), "not measured");
    EXPECT_EQ(format_summary({1, 2.0, 0, 2, 2}), "2 s");
    EXPECT_EQ(format_summary({5, 0.0132, 0.0001, 0.013, 0.014}), "13.2 ms ± 100 µs");
    EXPECT_EQ(format_ratio({12.9, std::nullopt, 2}), "12.9");
    EXPECT_EQ(format_ratio({12.9, Interval{12.5, 13.3}, 9}), "12.9 (12.5 to 13.3)");
}

}  // namespace
}  // namespace tandem
