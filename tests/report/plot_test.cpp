#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tandem/report/plot_axis.h"
#include "tandem/report/svg_plot.h"

namespace tandem {
namespace {

std::vector<std::string> labels(const AxisScale& scale) {
    std::vector<std::string> texts;
    for (const Tick& tick : scale.ticks()) texts.push_back(tick.label);
    return texts;
}

TEST(PlotAxis, LinearAxesBeginAtZeroAndEndOnATick) {
    const AxisScale scale(std::vector<double>{3, 8.2}, false, 100);
    EXPECT_EQ(labels(scale), (std::vector<std::string>{"0", "2", "4", "6", "8", "10"}));
    EXPECT_DOUBLE_EQ(scale.position(0), 0);
    EXPECT_DOUBLE_EQ(scale.position(5), 50);
    EXPECT_DOUBLE_EQ(scale.position(10), 100);
}

TEST(PlotAxis, LogarithmicAxesCoverDecades) {
    const AxisScale scale(std::vector<double>{0.02, 35}, true, 100);
    EXPECT_EQ(labels(scale), (std::vector<std::string>{"0.01", "0.1", "1", "10", "100"}));
    EXPECT_NEAR(scale.position(1), 50, 1e-9);
}

TEST(PlotAxis, ANarrowLogarithmicAxisHasTicksToReadFrom) {
    const AxisScale scale(std::vector<double>{1.2, 1.3}, true, 100);
    EXPECT_GE(scale.ticks().size(), 2U);
    EXPECT_LE(scale.ticks().front().value, 1.2);
    EXPECT_GE(scale.ticks().back().value, 1.3);
}

TEST(PlotAxis, ZeroHasAPlaceOnALogarithmicAxis) {
    const AxisScale scale(std::vector<double>{0, 0.05, 1e-4}, true, 100);
    EXPECT_EQ(scale.ticks().front().label, "0");
    EXPECT_EQ(scale.position(0), 0);
    EXPECT_GT(scale.position(1e-4), 5);
}

TEST(PlotAxis, EveryValueStandsWithinTheAxis) {
    const double infinity = std::numeric_limits<double>::infinity();
    for (const bool logarithmic : {false, true}) {
        for (const std::vector<double>& values : std::vector<std::vector<double>>{
                 {}, {0}, {1}, {0.1, 0.1}, {1e-300, 1e300}, {5, infinity}, {-3, 7}, {2, 20}, {9.9999, 10}, {1e-9}}) {
            const AxisScale scale(values, logarithmic, 100);
            ASSERT_GE(scale.ticks().size(), 1U);
            for (const double value : values) {
                EXPECT_GE(scale.position(value), 0);
                EXPECT_LE(scale.position(value), 100);
            }
            for (const Tick& tick : scale.ticks()) {
                EXPECT_GE(scale.position(tick.value), 0);
                EXPECT_LE(scale.position(tick.value), 100);
            }
        }
    }
}

TEST(SvgPlot, DrawsEveryLineAndEscapesItsLabel) {
    LinePlot plot{"Time <per> frame", {"frame", false}, {"ms", true}, {}, {{"the paper: 4.72 ms", 4.72}}};
    plot.lines.push_back({"CPU & co", {{0, 1}, {1, 2}, {2, 4}}});
    plot.lines.push_back({"GPU", {{0, 0}, {1, std::numeric_limits<double>::quiet_NaN()}, {2, 0.5}}});
    const std::string svg = to_svg(plot);
    EXPECT_NE(svg.find("CPU &amp; co"), std::string::npos);
    EXPECT_NE(svg.find("Time &lt;per&gt; frame"), std::string::npos);
    EXPECT_NE(svg.find("the paper: 4.72 ms"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos) << svg;
    std::size_t dots = 0;
    for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) ++dots;
    EXPECT_EQ(dots, 5U) << "a point for every finite value";
}

TEST(SvgPlot, BarsCarryTheirIntervals) {
    BarPlot plot{"Throughput", {"samples/s", true}, {}, {}};
    plot.bars = {{"naive", 1e6, Interval{0.9e6, 1.2e6}, "1 M"}, {"ours", 1e9, std::nullopt, "1 G"}};
    const std::string svg = to_svg(plot);
    EXPECT_NE(svg.find("whisker"), std::string::npos);
    EXPECT_NE(svg.find(">naive<"), std::string::npos);
    EXPECT_NE(svg.find(">1 G<"), std::string::npos);
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST(SvgPlot, ScatterDrawsBoxesFrontAndFailures) {
    ScatterPlot plot{"Error <against> time", {"s", true}, {"RMSE", true}, {"samples", "tier"}, {}, {{"noise", 0.1}}};
    const auto point = [](double x, double y, const std::string& label, bool faded, bool failed) {
        return ScatterPoint{{x, y}, {x / 2, x * 2}, {y / 2, y * 2}, label, faded ? "7" : "", 1, faded, failed};
    };
    plot.series.push_back({"CPU & co",
                           {point(4, 1, "slow", false, false), point(1, 4, "fast", false, false),
                            point(5, 5, "grey <one>", true, false), point(2, 1e9, "NaN", false, true)}});
    const std::string svg = to_svg(plot);
    EXPECT_EQ(count_of(svg, "class=\"box\""), 3U) << "one for each point that did not fail";
    for (const char* part :
         {"CPU &amp; co", "grey &lt;one&gt;", ">7</text>", "<title>NaN</title>", ">failed<", ">noise<"}) {
        EXPECT_NE(svg.find(part), std::string::npos) << part;
    }
    EXPECT_EQ(svg.find("nan"), std::string::npos) << svg;
    EXPECT_EQ(svg.find("1e+09"), std::string::npos) << "what failed has no place on the axis";
    const std::size_t front = svg.find("class=\"line front");
    const std::string path = svg.substr(svg.rfind("<path", front), front - svg.rfind("<path", front));
    EXPECT_EQ(count_of(path, "L"), 1U) << "two points, from left to right: " << path;
}

}  // namespace
}  // namespace tandem
