#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "accuracy/accuracy_report.h"
#include "accuracy/report_blocks.h"
#include "accuracy/report_words.h"
#include "loop_backend.h"
#include "support/input_error.h"
#include "tandem/backends/make_backend.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/report/csv_writer.h"
#include "tandem/report/html_writer.h"
#include "tandem/report/json_writer.h"
#include "tandem/scene/named_scenes.h"

namespace tandem::bench {
namespace {

using test::contains;
using test::input_error;

SweepOptions small_sweep() {
    SweepOptions options;
    options.tiers = {"strict"};
    options.axes = {"samples", "tessellation"};
    options.levels = {0};
    options.samples = {4, 1};
    options.size = {16, 14};
    options.seeds = 8;
    return options;
}

template <class Kind>
std::vector<Kind> blocks_of(const Report& report) {
    std::vector<Kind> found;
    for (const Block& block : report.blocks) {
        if (const auto* one = std::get_if<Kind>(&block)) found.push_back(*one);
    }
    return found;
}

TEST(AccuracySweep, FillsTheReport) {
    Report report;
    EXPECT_TRUE(run_sweep(small_sweep(), loop_source(), report)) << prose_of(report);
    ASSERT_EQ(report.rows.size(), 2U * 2 * 2) << "two backends, strict and a tessellation, two numbers of samples";
    for (const BenchmarkRow& row : report.rows) {
        EXPECT_EQ(row.seconds.size(), 8U) << row.label;
        EXPECT_LE(figure(row, "RMSE low"), figure(row, "RMSE")) << row.label;
        EXPECT_GE(figure(row, "RMSE high"), figure(row, "RMSE")) << row.label;
        ASSERT_EQ(row.series.size(), metrics.size());
        for (const auto& [name, values] : row.series) EXPECT_EQ(values.size(), 8U) << name;
    }
    EXPECT_EQ(figure(report.rows[0], "samples per pixel"), 1) << "in order";
    EXPECT_GT(figure(report.rows[0], "RMSE low"), figure(report.rows[1], "RMSE high")) << "four samples are better";
    EXPECT_EQ(report.rows[0].errors[0].share, 0);
    EXPECT_GT(report.rows[2].errors[0].share, 0) << "20 triangles are no sphere";
    EXPECT_EQ(report.rows[4].errors[0].share, 0) << "the other backend has the same bits";

    EXPECT_EQ(blocks_of<ScatterPlot>(report).size(), 3U);
    EXPECT_EQ(blocks_of<ScatterPlot>(report)[0].series.size(), 2U) << "both backends on the same axes";
    EXPECT_EQ(blocks_of<ScatterPlot>(report)[0].references.size(), 1U) << "the noise floor";
    const auto comparisons = blocks_of<PictureComparison>(report);
    ASSERT_EQ(comparisons.size(), 1U);
    EXPECT_EQ(comparisons[0].pictures.size(), 2U * 2 + 1);
    const std::string prose = prose_of(report);
    for (const char* part : {"a tenth of the error costs", "20 triangles a sphere on cpu", "Worth their time on cuda",
                             "Effects: not asked for.", "8 seeds are few", "the image is the same, bit for bit"}) {
        EXPECT_TRUE(contains(prose, part));
    }
    EXPECT_GT(std::stod(property_of(report, "price of a digit named:paper cpu")), 1);
    const auto json = nlohmann::json::parse(to_json(report));
    EXPECT_EQ(json["rows"][0]["series"]["squared error"].size(), 8U);
    EXPECT_NE(to_csv(report.rows).find("RMSE,RMSE low,RMSE high"), std::string::npos);
    EXPECT_NE(to_html(report).find("class=\"line front"), std::string::npos);
}

TEST(AccuracySweep, ATierFailsWhereItDecidesPixelsWrongly) {
    SweepOptions options = small_sweep();
    options.axes = {"tier"};
    options.tiers = {"strict", "fast", "precise"};
    options.samples = {16};
    options.size = {50, 45};
    options.seeds = 2;
    std::vector<SweepBackend> backends;
    backends.push_back({"cpu", make_backend("cpu")});
    for (const char* name : {"named:hard/far-telescope", "named:paper"}) {
        const SceneSweep sweep = sweep_scene(options, name, backends);
        ASSERT_EQ(sweep.points.size(), 3U);
        for (const SweepPoint& point : sweep.points) {
            const bool fails = point.setting.tier == Tier::fast && sweep.scene.scene.name != "paper";
            ASSERT_EQ(point.failures.size(), fails ? 1U : 0U) << name << ": " << point.row.label;
            if (fails) {
                EXPECT_TRUE(contains(point.failures[0], "differ by more than 5 % from those of strict"));
            }
        }
        const SweepPoint& strict = sweep.points[0];
        const SweepPoint& fast = sweep.points[1];
        const double ratio = fast.error(Metric::rmse).value / strict.error(Metric::rmse).value;
        EXPECT_EQ(ratio > 2, sweep.scene.scene.name != "paper") << name << ": " << ratio;
    }
}

TEST(AccuracySweep, TheAnswerIsAtTheTop) {
    SweepOptions options = small_sweep();
    options.seeds = 32;
    options.axes = {};
    options.samples = {1};
    Report report;
    (void)run_sweep(options, loop_source(), report);
    ASSERT_FALSE(report.blocks.empty());
    ASSERT_TRUE(std::holds_alternative<Heading>(report.blocks.front()));
    EXPECT_EQ(std::get<Heading>(report.blocks.front()).text, "The answer");
}

TEST(AccuracySweep, MeasuresTheRungBelowAndADenoiser) {
    SweepOptions options = small_sweep();
    options.backends = {"cpu"};
    options.axes = {"rasterised", "denoised"};
    options.denoiser = TANDEM_STUB_DENOISER;
    Report report;
    EXPECT_TRUE(run_sweep(options, BackendSource(), report)) << prose_of(report);
    ASSERT_EQ(report.rows.size(), 3U * 2) << "strict, rasterised, denoised";
    const BenchmarkRow& strict = report.rows[1];
    const BenchmarkRow& rasterised = report.rows[3];
    const BenchmarkRow& denoised = report.rows[5];
    EXPECT_EQ(rasterised.label, "cpu, rasterised, 4 spp");
    EXPECT_EQ(denoised.label, "cpu, denoised (biased), 4 spp");
    EXPECT_LT(figure(rasterised, "RMSE"), 3 * figure(strict, "RMSE")) << "the paper's scene needs no rays";
    EXPECT_GT(figure(denoised, "RMSE"), 3 * figure(strict, "RMSE")) << "the stub is no denoiser";
    EXPECT_GT(rasterised.errors[0].share, 0.5);
    EXPECT_GT(denoised.errors[0].share, 0.9);
    const std::string prose = prose_of(report);
    for (const char* part : {"Rasterised images come without a ray", "This scene needs no effect that it leaves out.",
                             "Denoised images are biased", "rasterised on cpu takes"}) {
        EXPECT_TRUE(contains(prose, part));
    }
}

TEST(AccuracySweep, SaysWhatTheRungBelowLacksAndWhyThereIsNoDenoiser) {
    const VariedAxes axes{.tiers = {Tier::strict},
                          .samplers = false,
                          .filters = false,
                          .effects = false,
                          .depth = false,
                          .tessellation = false,
                          .no_denoiser = "It is not here."};
    const SettingPlan plan = plan_settings(load_scene(TANDEM_SCENES "/whitted.gltf"), axes);
    ASSERT_EQ(plan.settings.size(), 2U);
    EXPECT_EQ(plan.settings[1].axis, Axis::rasterised);
    EXPECT_TRUE(runs_on(plan.settings[1], "cpu"));
    EXPECT_FALSE(runs_on(plan.settings[1], "cuda"));
    ASSERT_EQ(plan.biases.size(), 1U);
    for (const char* part : {"shadows", "reflection", "refraction"}) EXPECT_TRUE(contains(plan.biases[0], part));
    EXPECT_TRUE(contains(plan.skipped.back(), "Denoised: not run. It is not here."));
    const SettingPlan many = plan_settings(named_scene("spheres/300000"), axes);
    EXPECT_EQ(many.settings.size(), 1U);
    EXPECT_TRUE(contains(many.skipped[6], "the rasteriser draws at most 4000000"));
}

TEST(AccuracySweep, ComparesAFilterWithReferencesOfTheSameFilter) {
    SweepOptions options = small_sweep();
    options.backends = {"cpu"};
    options.axes = {"filter"};
    options.samples = {256};
    Report report;
    EXPECT_TRUE(run_sweep(options, BackendSource(), report)) << prose_of(report);
    ASSERT_EQ(report.rows.size(), 4U) << "box, tent, gaussian, blackman_harris";
    const std::string converged = property_of(report, "difference of converged images named:paper gaussian");
    EXPECT_GT(std::stod(converged), 0.02) << "the edges of 16 x 14 pixels are soft";
    for (const BenchmarkRow& row : report.rows) {
        EXPECT_LT(figure(row, "RMSE high"), std::stod(converged) / 2) << row.label << ": noise alone";
        EXPECT_GT(figure(row, "RMSE low"), 0.001) << row.label;
    }
    EXPECT_GT(report.rows[2].errors[0].share, 0.5) << "other bits than those of strict";
    const std::string prose = prose_of(report);
    for (const char* part : {"each from references with its own filter; the RMSE of its converged image from that of "
                             "strict is ",
                             "A filter is a choice of the image", "Points of filters are grey too"}) {
        EXPECT_TRUE(contains(prose, part));
    }
    EXPECT_TRUE(contains(prose, "both faster and closer: strict (256 spp).")) << "filters are not ranked";
    for (const ScatterPlot& plot : blocks_of<ScatterPlot>(report)) {
        ASSERT_EQ(plot.series[0].points.size(), 4U);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(plot.series[0].points[i].faded, i > 0);
    }
}

TEST(AccuracySweep, FailsIfABackendThatPromisesBitsHasOthers) {
    SweepOptions options = small_sweep();
    options.axes = {};
    Report report;
    EXPECT_FALSE(run_sweep(options, loop_source(spoil_the_gpu), report));
    EXPECT_TRUE(contains(prose_of(report), "differ in a bit from those of cpu"));
}

TEST(AccuracySweep, RefusesOptionsThatMakeNoSense) {
    const auto refused = [](auto change) {
        SweepOptions options = small_sweep();
        change(options);
        Report report;
        return input_error([&] { (void)run_sweep(options, loop_source(), report); });
    };
    EXPECT_TRUE(contains(refused([](auto& o) { o.samples = {}; }), "--samples"));
    EXPECT_TRUE(contains(refused([](auto& o) { o.seeds = 1; }), "--seeds"));
    EXPECT_TRUE(contains(refused([](auto& o) { o.rebuild_references = true; }), "--references"));
    EXPECT_TRUE(contains(refused([](auto& o) { o.axes = {"colour"}; }), "colour"));
    EXPECT_TRUE(contains(refused([](auto& o) { o.tiers = {"sloppy"}; }), "sloppy"));
    EXPECT_FALSE(refused([](auto& o) { o.size = {0, 5}; }).empty());
    EXPECT_FALSE(refused([](auto& o) { o.samples = {1 << 24}; }).empty()) << "the reference would need more";
}

/// A sweep of one backend whose errors and times are made up.
SceneSweep made_up(const std::vector<std::tuple<std::string, int, double, double>>& points) {
    FloatImage grey{2, 2, {}};
    grey.pixels.assign(4, {1, 1, 1});
    SceneSweep sweep{{"a scene", {}, {}, {}}, {}, {Reference(grey), "Made up."}, {}, {}};
    for (const auto& [setting, samples, seconds, error] : points) {
        SweepPoint point;
        point.setting.name = setting;
        point.setting.axis =
            sweep.points.empty() || sweep.points[0].setting.name == setting ? Axis::baseline : Axis::tier;
        point.samples = samples;
        point.row.backend = "cpu";
        point.row.label = "cpu, " + setting;
        point.row.seconds = {seconds * 0.99, seconds, seconds * 1.01};
        point.errors.fill({error, {error * 0.99, error * 1.01}, true});
        const bool known = !sweep.points.empty() && sweep.points.back().setting.name == setting;
        if (!known) sweep.plan.settings.push_back(point.setting);
        sweep.points.push_back(std::move(point));
    }
    return sweep;
}

std::vector<SweepBackend> one_backend() {
    std::vector<SweepBackend> backends;
    backends.push_back({"cpu", nullptr});
    return backends;
}

/// The answer and the comparisons, a line each.
std::string words_of(const SceneSweep& sweep) {
    std::string text;
    for (const std::string& sentence : answers(sweep, one_backend())) text += sentence + "\n";
    for (const std::string& sentence : comparisons(sweep, one_backend())) text += sentence + "\n";
    return text;
}

TEST(AccuracyWords, SayWhatADigitCostsAndWhatToChoose) {
    const SceneSweep sweep = made_up({{"strict", 1, 0.1, 0.4},
                                      {"strict", 4, 0.4, 0.2},
                                      {"strict", 16, 1.6, 0.1},
                                      {"precise", 1, 0.2, 0.4},
                                      {"precise", 4, 0.8, 0.2},
                                      {"precise", 16, 3.2, 0.1},
                                      {"coarse", 1, 0.09, 0.5},
                                      {"coarse", 4, 0.36, 0.45},
                                      {"coarse", 16, 1.4, 0.44}});
    const std::string text = words_of(sweep);
    EXPECT_TRUE(contains(text, "On cpu, a tenth of the error costs 100 times the time"));
    EXPECT_TRUE(contains(text,
                         "precise on cpu takes 2 (2 to 2) times as long as strict at 16 spp, and its error "
                         "cannot be told from that of strict."));
    EXPECT_TRUE(contains(text, "its RMSE is 4.4 times as large; more samples hardly reduce it."));
    EXPECT_TRUE(contains(text, "strict (1, 4, 16 spp); coarse (1 spp)."));
    EXPECT_FALSE(contains(text, "precise (")) << "it is dominated";
}

TEST(AccuracyWords, SayHowTheErrorOfASamplerFalls) {
    SceneSweep sweep = made_up({{"strict", 1, 0.1, 0.4},
                                {"strict", 4, 0.4, 0.2},
                                {"strict", 16, 1.6, 0.1},
                                {"sobol", 1, 0.1, 0.4},
                                {"sobol", 4, 0.4, 0.1},
                                {"sobol", 16, 1.6, 0.025}});
    sweep.plan.settings[1].axis = Axis::sampler;
    const Table table = convergence_table(sweep, one_backend());
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(table.rows[0][2], "-0.50 (-0.51 to -0.49)");
    EXPECT_EQ(table.rows[1][2], "-1.00 (-1.01 to -0.99)");
    EXPECT_TRUE(
        contains(words_of(sweep),
                 "it falls with the samples to the power -1.00 (-1.01 to -0.99), that of strict -0.50 (-0.51 to "
                 "-0.49)."));
    sweep.points[4].errors.fill({0.1, {0, 0.2}, false});
    sweep.points[5].errors.fill({0.1, {0, 0.2}, false});
    EXPECT_TRUE(contains(convergence_table(sweep, one_backend()).rows[1][2], "fewer than two"));
}

TEST(AccuracyWords, SayThatABiasDoesNotGoAway) {
    const SceneSweep sweep = made_up({{"strict", 1, 0.1, 0.4}, {"strict", 4, 0.4, 0.4}});
    EXPECT_TRUE(contains(answers(sweep, one_backend()).front(), "more samples do not reduce the error"));
}

TEST(AccuracyWords, NameWhatFailed) {
    SceneSweep sweep = made_up({{"strict", 1, 0.1, 0.4}, {"fast", 1, 0.05, 0.3}});
    sweep.points[1].failures = {"3 pixels are not finite"};
    const std::vector<std::string> sentences = answers(sweep, one_backend());
    EXPECT_TRUE(contains(sentences[1], "fast on cpu failed: 3 pixels are not finite."));
    EXPECT_FALSE(contains(sentences[2], "fast (")) << "not worth its time";
    EXPECT_TRUE(comparisons(sweep, one_backend()).empty()) << "only of what has not failed";
    const ScatterPlot plot = pareto_plot(sweep, one_backend(), Metric::rmse);
    EXPECT_TRUE(plot.series[0].points[1].failed);
    EXPECT_EQ(points_table(sweep).rows[1].back(), "failed");
}

TEST(AccuracyTables, AtEqualTimeAndAtEqualError) {
    const SceneSweep sweep = made_up({{"strict", 1, 0.1, 0.4}, {"strict", 4, 0.4, 0.2}, {"better", 4, 0.3, 0.1}});
    const Table time = equal_time_table(sweep, one_backend());
    ASSERT_EQ(time.rows.size(), 2U);
    EXPECT_TRUE(contains(time.rows[0][1], "strict, 1 spp"));
    EXPECT_TRUE(contains(time.rows[1][1], "better, 4 spp"));
    const Table error = equal_error_table(sweep, one_backend());
    EXPECT_TRUE(contains(error.rows[1][1], "better, 4 spp: 0.1"));
    const Table points = points_table(sweep);
    EXPECT_EQ(points.rows[1].back(), "3") << "dominated by the third point";
    EXPECT_EQ(points.rows[0].back(), "");
    const ScatterPlot plot = pareto_plot(sweep, one_backend(), Metric::rmse);
    EXPECT_TRUE(plot.series[0].points[1].faded);
    EXPECT_EQ(plot.series[0].points[1].mark, "2") << "named by its number in the table";
    EXPECT_TRUE(contains(plot.series[0].points[1].label, "dominated by cpu, better"));
}

TEST(AccuracyWords, ErrorsThatAreNotResolvedAreBounds) {
    EXPECT_EQ(in_words(ErrorEstimate{0.001, {0, 0.003}, false}), "below 0.003");
    EXPECT_EQ(in_words(ErrorEstimate{0, {0, 0}, false}), "0");
    EXPECT_EQ(in_words(ErrorEstimate{0.5, {0.4, 0.6}, true}), "0.5 (0.4 to 0.6)");
}

}  // namespace
}  // namespace tandem::bench
