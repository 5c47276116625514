// tandem-bench coverage on small scenes.
#include "coverage.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/input_error.h"

namespace tandem::bench {
namespace {

double figure(const BenchmarkRow& row, const std::string& name) {
    const auto found =
        std::find_if(row.figures.begin(), row.figures.end(), [&](const auto& entry) { return entry.first == name; });
    EXPECT_NE(found, row.figures.end()) << name;
    return found->second;
}

TEST(CoverageReport, HasEveryTrialOfEveryScene) {
    CoverageOptions options;
    options.size = {40, 30};
    options.trials = 12;
    options.reference_samples = 1024;
    for (const char* metric : {"rmse", "flip"}) {
        options.metric = metric;
        options.scenes = {"named:paper", options.metric == "rmse" ? "closed:furnace/50" : "named:mixed/8"};
        Report report;
        (void)run_coverage(options, {}, report);
        ASSERT_EQ(report.rows.size(), 2U);
        for (const BenchmarkRow& row : report.rows) {
            EXPECT_EQ(row.seconds.size(), 12U);
            for (const auto& [name, values] : row.series) EXPECT_EQ(values.size(), 12U) << name;
            EXPECT_EQ(figure(row, "reached"), 1);
            EXPECT_GE(figure(row, "covered"), 0.7);
            EXPECT_NEAR(figure(row, "covered") + figure(row, "below") + figure(row, "above"), 1, 1e-12);
            EXPECT_GE(figure(row, "error_over_target"), 0.7);
            EXPECT_LE(figure(row, "error_over_target"), 1.1);
        }
    }
}

TEST(CoverageReport, NeedsScenes) {
    Report report;
    EXPECT_TRUE(test::contains(test::input_error([&] { (void)run_coverage({}, {}, report); }), "name the scenes"));
}

}  // namespace
}  // namespace tandem::bench
