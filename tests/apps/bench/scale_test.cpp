#include "scale.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <cmath>

#include "loop_backend.h"
#include "tandem/base/error.h"

namespace tandem::bench {
namespace {

const auto nothing = [](const std::string&, const BackendOptions&) { return false; };
const auto the_gpu = [](const std::string& name, const BackendOptions&) { return name == "cuda"; };

ScaleOptions small() {
    ScaleOptions options;
    options.kinds = {"spheres", "triangles"};
    options.least = 2;
    options.most = 25;
    options.ray_edge = 12;
    options.repetitions = 2;
    return options;
}

TEST(Scale, MeasuresEverySizeBackendThreadsAndSetOfRays) {
    ScaleOptions options = small();
    options.threads = {1, 2};
    Report report;
    EXPECT_TRUE(run_scale(options, loop_source(nothing), report)) << prose_of(report);
    // 2 kinds, 2 and 20 primitives, cpu with 1 and with 2 threads and cuda, 4 sets
    ASSERT_EQ(report.rows.size(), 2U * 2 * 3 * 4);
    for (const BenchmarkRow& row : report.rows) {
        EXPECT_EQ(row.seconds.size(), 2U) << row.label;
        EXPECT_EQ(row.rays, 144) << row.label;
    }
    EXPECT_EQ(report.rows.front().label, "named:spheres/2, cpu, 1 thread, coherent");
    EXPECT_NE(prose_of(report).find("All hits are equal"), std::string::npos) << prose_of(report);
}

TEST(Scale, CountsHitsThatDiffer) {
    Report report;
    EXPECT_FALSE(run_scale(small(), loop_source(the_gpu), report));
    EXPECT_NE(prose_of(report).find("hits differ between backends"), std::string::npos) << prose_of(report);
}

TEST(Scale, StepsThroughTheNumbersOfPrimitives) {
    ScaleOptions options = small();
    options.kinds = {"spheres"};
    options.rays = {"shadow"};
    options.backends = {"cpu"};
    options.least = 1;
    options.most = 10;
    options.steps = 2;
    Report report;
    EXPECT_TRUE(run_scale(options, loop_source(nothing), report));
    ASSERT_EQ(report.rows.size(), 3U);
    EXPECT_EQ(report.rows[1].scene, "named:spheres/3, shadow rays");
}

// Both are alive at once where several numbers of threads are measured.
TEST(Scale, ABackendWithOneThreadDoesNotLimitOthers) {
    const auto one = make_backend("cpu", {1, 16, {}});
    const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    EXPECT_GE(allowed, static_cast<std::size_t>(tbb::info::default_concurrency()));
    const auto many = make_backend("cpu", {tbb::info::default_concurrency() + 3, 16, {}});
    EXPECT_EQ(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism),
              static_cast<std::size_t>(tbb::info::default_concurrency()) + 3);
}

TEST(Scale, FitsExponents) {
    std::vector<Point> linear, logarithmic;
    for (const double n : {1e3, 1e4, 1e5, 1e6}) {
        linear.push_back({n, 2 * n});
        logarithmic.push_back({n, 3 * std::log(n)});
    }
    EXPECT_NEAR(fitted_exponent(linear), 1, 1e-12);
    EXPECT_NEAR(growth_over_log(linear), 500, 1e-9);
    EXPECT_NEAR(growth_over_log(logarithmic), 1, 1e-12);
    EXPECT_LT(fitted_exponent(logarithmic), 0.15);
}

TEST(Scale, RefusesWhatItCannotMeasure) {
    Report report;
    ScaleOptions options = small();
    options.rays = {"sideways"};
    EXPECT_THROW((void)run_scale(options, loop_source(nothing), report), InputError);
    options = small();
    options.most = 1;
    EXPECT_THROW((void)run_scale(options, loop_source(nothing), report), InputError);
    options = small();
    options.kinds = {"cones"};
    EXPECT_THROW((void)run_scale(options, loop_source(nothing), report), InputError);
}

}  // namespace
}  // namespace tandem::bench
