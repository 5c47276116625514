// tandem-bench coverage on small scenes.
#include "coverage.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "loop_backend.h"
#include "support/input_error.h"

namespace tandem::bench {
namespace {

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

TEST(CoverageReport, HasARowForEachTarget) {
    CoverageOptions options;
    options.size = {24, 16};
    options.trials = 3;
    options.reference_samples = 64;
    options.reference_factor = 4;
    options.equal_samples = {32, 128};
    options.plans = false;
    options.scenes = {"named:paper"};
    Report report;
    (void)run_coverage(options, {}, report);
    ASSERT_EQ(report.rows.size(), 2U);
    EXPECT_NEAR(figure(report.rows[0], "target") / figure(report.rows[1], "target"), 2, 0.5);
    EXPECT_LT(figure(report.rows[0], "samples"), figure(report.rows[1], "samples"));
    for (const BenchmarkRow& row : report.rows) {
        for (const auto& [name, values] : row.series) EXPECT_FALSE(name.starts_with("planned")) << name;
    }
    options.plans = true;
    Report planned;
    (void)run_coverage(options, {}, planned);
    EXPECT_EQ(figure(planned.rows[1], "samples"), figure(report.rows[1], "samples")) << "a forecast changes nothing";
    EXPECT_LT(figure(planned.rows[1], "planned_samples_low"), 0);
    EXPECT_GT(figure(planned.rows[1], "planned_samples_high"), 0);
}

TEST(CoverageReport, NeedsScenes) {
    Report report;
    EXPECT_TRUE(test::contains(test::input_error([&] { (void)run_coverage({}, {}, report); }), "name the scenes"));
}

}  // namespace
}  // namespace tandem::bench
