#include "scale.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <cmath>

#include "gpu_scale.h"
#include "instance_rates.h"
#include "loop_backend.h"
#include "tandem/backends/make_backend.h"
#include "tandem/base/error.h"

namespace tandem::bench {
namespace {

ScaleOptions small_scale() {
    ScaleOptions options;
    options.kinds = {"spheres", "triangles"};
    options.least = 2;
    options.most = 25;
    options.ray_edge = 12;
    options.repetitions = 2;
    return options;
}

TEST(Scale, MeasuresEverySizeBackendThreadsAndSetOfRays) {
    ScaleOptions options = small_scale();
    options.threads = {1, 2};
    Report report;
    EXPECT_TRUE(run_scale(options, loop_source(spoil_nothing), report)) << prose_of(report);
    // 2 kinds, 2 and 20 primitives, cpu with 1 and with 2 threads and cuda, 4 sets
    ASSERT_EQ(report.rows.size(), 2U * 2 * 3 * 4);
    for (const BenchmarkRow& row : report.rows) {
        EXPECT_EQ(row.seconds.size(), 2U) << row.label;
        EXPECT_EQ(row.rays, 144) << row.label;
    }
    EXPECT_EQ(report.rows.front().label, "named:spheres/2, cpu, 1 thread, coherent");
    EXPECT_NE(prose_of(report).find("All hits are equal"), std::string::npos) << prose_of(report);
}

TEST(Scale, MeasuresInstancesBesideTheSameWrittenOut) {
    BackendSource source = loop_source(spoil_nothing);
    source.make = [](const std::string&, const BackendOptions&) { return make_backend("cpu", {}); };
    const InstanceRateOptions options{.block = 8, .city_edge = 2, .ray_edge = 32, .repetitions = 2};
    Report report;
    EXPECT_TRUE(run_instance_rates(options, source, report)) << prose_of(report);
    ASSERT_EQ(report.rows.size(), 2U * 3);
    EXPECT_EQ(report.rows[0].label, "named:block/8, written out, coherent");
    EXPECT_EQ(report.rows[1].label, "named:block/8, kept once, coherent");
    EXPECT_EQ(report.rows[5].label, "named:city/4, kept once, random");
    for (const BenchmarkRow& row : report.rows) {
        EXPECT_EQ(row.seconds.size(), 2U) << row.label;
        EXPECT_EQ(row.rays, 1024) << row.label;
        // a view at flat angles passes above so small a city
        const bool is_above = row.label == "named:city/4, kept once, coherent";
        EXPECT_EQ(row.figures.back().second > 0.1, !is_above) << row.label << ": hits";
    }
}

TEST(Scale, CountsHitsOfInstancesThatDiffer) {
    Report report;
    const InstanceRateOptions options{.block = 8, .city_edge = 2, .ray_edge = 6, .repetitions = 1};
    // this backend sees no instances
    EXPECT_FALSE(run_instance_rates(options, loop_source(spoil_nothing), report));
    EXPECT_NE(prose_of(report).find("hits differ from those of the faces written out"), std::string::npos);
}

TEST(Scale, CountsHitsThatDiffer) {
    Report report;
    EXPECT_FALSE(run_scale(small_scale(), loop_source(spoil_the_gpu), report));
    EXPECT_NE(prose_of(report).find("hits differ between backends"), std::string::npos) << prose_of(report);
}

TEST(Scale, StepsThroughTheNumbersOfPrimitives) {
    ScaleOptions options = small_scale();
    options.kinds = {"spheres"};
    options.rays = {"shadow"};
    options.backends = {"cpu"};
    options.least = 1;
    options.most = 10;
    options.steps = 2;
    Report report;
    EXPECT_TRUE(run_scale(options, loop_source(spoil_nothing), report));
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

TEST(Scale, MeasuresEveryNumberOfGpus) {
    ScaleOptions options = small_scale();
    options.parts = {"rays", "frames"};
    options.kinds = {"spheres"};
    options.rays = {"coherent"};
    options.backends = {"cuda"};
    options.gpus = {0};
    options.scenes = {"named:spheres/3", "named:paper"};
    options.size = {20, 16};
    options.samples = 2;
    BackendSource source = loop_source(spoil_nothing);
    source.gpu_count = [] { return 2; };
    Report report;
    EXPECT_TRUE(run_scale(options, source, report)) << prose_of(report);
    // 2 and 20 primitives on 1 and 2 GPUs; each scene on 1, 1 in bands and 2
    ASSERT_EQ(report.rows.size(), 2U * 2 + 2 * 3);
    EXPECT_EQ(report.rows[1].label, "named:spheres/2, cuda, 2 GPUs, coherent");
    EXPECT_EQ(report.rows[4].label, "named:spheres/3, 1 GPU in bands");
    EXPECT_EQ(report.rows[6].label, "named:spheres/3, 2 GPUs");
    EXPECT_EQ(report.rows[6].seconds.size(), 2U);
    EXPECT_EQ(report.rows[6].samples, 20 * 16 * 2);
    std::size_t plots = 0;
    for (const Block& block : report.blocks) {
        const auto* plot = std::get_if<LinePlot>(&block);
        plots += plot != nullptr && plot->title.find("by number of GPUs") != std::string::npos ? 1 : 0;
    }
    EXPECT_EQ(plots, 3U);
    EXPECT_NE(prose_of(report).find("All films are equal"), std::string::npos);
    EXPECT_EQ(property_of(report, "film named:paper").size(), 64U);
}

TEST(Scale, EfficiencyIsJudgedByTheFasterOneGpu) {
    GpuScaleOptions options{"named:paper", {2}, {20, 16}, 2, "strict", 5};
    BackendSource source = loop_source(spoil_nothing);
    Report report;
    const GpuScale scale = time_gpus(options, source, report);
    ASSERT_EQ(scale.steps.size(), 2U);
    EXPECT_TRUE(scale.are_equal);
    const double one = std::min(summarize(scale.steps[0].row.seconds).median, summarize(scale.in_bands.seconds).median);
    EXPECT_DOUBLE_EQ(scale.steps[1].efficiency.value, one / (2 * summarize(scale.steps[1].row.seconds).median));
    EXPECT_LE(scale.steps[0].efficiency.value, 1);
}

TEST(Scale, CountsFilmsThatDifferByTheNumberOfGpus) {
    GpuScaleOptions options{"named:paper", {2}, {20, 16}, 2, "strict", 1};
    const auto two_spoil = [](const std::string&, const BackendOptions& made) { return made.gpus.count == 2; };
    Report report;
    EXPECT_FALSE(run_gpu_scale(options, {"named:paper"}, loop_source(two_spoil), report));
    EXPECT_EQ(property_of(report, "film named:paper"), "differs");
    options.tier = "fast";
    EXPECT_TRUE(run_gpu_scale(options, {"named:paper"}, loop_source(two_spoil), report));
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
    ScaleOptions options = small_scale();
    options.rays = {"sideways"};
    EXPECT_THROW((void)run_scale(options, loop_source(spoil_nothing), report), InputError);
    options = small_scale();
    options.most = 1;
    EXPECT_THROW((void)run_scale(options, loop_source(spoil_nothing), report), InputError);
    options = small_scale();
    options.gpus = {-1};
    EXPECT_THROW((void)run_scale(options, loop_source(spoil_nothing), report), InputError);
    options = small_scale();
    options.parts = {"frames"};
    EXPECT_THROW((void)run_scale(options, loop_source(spoil_nothing, "cuda"), report), EnvironmentError);
    options = small_scale();
    options.kinds = {"cones"};
    EXPECT_THROW((void)run_scale(options, loop_source(spoil_nothing), report), InputError);
}

}  // namespace
}  // namespace tandem::bench
