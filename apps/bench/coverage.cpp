#include "coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <functional>
#include <numeric>
#include <utility>

#include "accuracy/accuracy_scenes.h"
#include "accuracy/settings.h"
#include "output.h"
#include "tandem/accuracy/image_errors.h"
#include "tandem/accuracy/reference.h"
#include "tandem/base/error.h"
#include "tandem/base/seconds.h"
#include "tandem/images/flip.h"
#include "tandem/render/forecast.h"

namespace tandem::bench {

namespace {

/// Far from the seeds of the trials.
constexpr std::uint64_t seeds_of_references = 1'000'000'001;
constexpr int pilots = 3;

struct Trial {
    double error = 0;  ///< true
    StatedError stated;
    double samples = 0;
    double seconds = 0;  ///< of loading and rendering, as Forecast::seconds
    Forecast forecast;
    bool reached = false;
};

/// One scene of the report.
class CoveredScene {
  public:
    CoveredScene(const CoverageOptions& options, Backend& backend, const std::string& name)
        : options_(options),
          backend_(backend),
          scene_(load_accuracy_scene(name, options.size)),
          resident_(backend.load(prepare(scene_.scene, {}))),
          reference_(scene_.truth ? Reference(uniform(*scene_.truth))
                                  : Reference(render(options.reference_samples, seeds_of_references),
                                              render(options.reference_samples, seeds_of_references + 1))),
          meter_(reference_) {
        target_.metric = parse_metric(options.metric);
        target_.display = scene_.scene.display;
        double sum = 0;
        for (int i = 0; i < pilots; ++i) {
            const FloatImage image = render(options.equal_samples, seeds_of_references + 2 + static_cast<unsigned>(i));
            const double error = error_of(image);
            sum += target_.metric == ErrorMetric::rmse ? error * error : error;
        }
        const double mean = sum / pilots;
        target_.error = target_.metric == ErrorMetric::rmse ? std::sqrt(mean) : mean;
        resident_.reset();
    }

    [[nodiscard]] double target() const { return target_.error; }
    [[nodiscard]] const std::string& name() const { return scene_.name; }

    Trial run(std::uint64_t seed) {
        RenderJob job = job_with(options_.most_samples, seed);
        const FramePlan plan = plan_frame(scene_.scene, {}, job);
        const std::function<double()> clock = clock_of();
        const std::atomic<bool> never{false};
        Trial trial;
        trial.forecast = forecast(backend_, scene_.scene, plan, target_, clock);
        const double start = clock();
        const std::optional<TargetFrame> frame = render_to_target(backend_, scene_.scene, plan, target_, never, clock);
        trial.seconds = clock() - start;
        trial.stated = frame->error;
        trial.samples = frame->mean_samples;
        trial.reached = frame->stopped_by == StoppedBy::target;
        trial.error = error_of(film_to_image(frame->frame.result.film));
        return trial;
    }

  private:
    [[nodiscard]] FloatImage uniform(const Vec3f& value) const {
        const auto [width, height] = options_.size;
        return {width, height,
                std::vector<Vec3f>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value)};
    }
    [[nodiscard]] RenderJob job_with(int samples, std::uint64_t seed) const {
        RenderJob job;
        job.width = options_.size.width;
        job.height = options_.size.height;
        job.samples = samples;
        job.seed = seed;
        if (scene_.truth) job.limits = unlimited;  // a closed form is of all light
        return job;
    }
    [[nodiscard]] FloatImage render(int samples, std::uint64_t seed) {
        return film_to_image(backend_.render(resident_, job_with(samples, seed)).film);
    }
    /// In the unit of the metric.
    [[nodiscard]] double error_of(const FloatImage& image) {
        if (target_.metric == ErrorMetric::flip) {
            return flip(image, reference_.mean(), {.display = target_.display}).mean;
        }
        const ImageErrors errors = meter_.add(image);
        return target_.metric == ErrorMetric::rmse ? std::sqrt(std::max(errors.squared, 0.0)) : errors.relative;
    }
    [[nodiscard]] std::function<double()> clock_of() const {
        if (options_.clock == "process") {
            return [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
        }
        return [watch = Stopwatch()] { return watch.seconds(); };
    }

    const CoverageOptions& options_;
    Backend& backend_;
    AccuracyScene scene_;
    std::shared_ptr<ResidentScene> resident_;  ///< until the target is known
    Reference reference_;
    ErrorMeter meter_;
    RenderTarget target_;
};

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double share_of(const std::vector<Trial>& trials, const std::function<bool(const Trial&)>& holds) {
    return static_cast<double>(std::count_if(trials.begin(), trials.end(), holds)) / static_cast<double>(trials.size());
}

bool contains(const ForecastRange& range, double value) { return value >= range.low && value <= range.high; }

BenchmarkRow row_of(const CoveredScene& scene, const CoverageOptions& options, const std::vector<Trial>& trials) {
    BenchmarkRow row;
    row.label = fmt::format("{} {}", scene.name(), options.metric);
    row.scene = scene.name();
    row.backend = options.backend;
    row.tier = "strict";
    row.threads = options.threads;
    const auto series = [&](const char* name, const std::function<double(const Trial&)>& value) {
        std::vector<double> values;
        std::transform(trials.begin(), trials.end(), std::back_inserter(values), value);
        row.series.emplace_back(name, values);
        return values;
    };
    const auto errors = series("error", [](const Trial& t) { return t.error; });
    const auto stated = series("stated", [](const Trial& t) { return t.stated.value; });
    series("stated_low", [](const Trial& t) { return t.stated.low; });
    series("stated_high", [](const Trial& t) { return t.stated.high; });
    const auto samples = series("samples", [](const Trial& t) { return t.samples; });
    const auto planned = series("planned_samples", [](const Trial& t) { return t.forecast.samples.value; });
    series("planned_samples_low", [](const Trial& t) { return t.forecast.samples.low; });
    series("planned_samples_high", [](const Trial& t) { return t.forecast.samples.high; });
    const auto times = series("planned_seconds", [](const Trial& t) { return t.forecast.seconds.value; });
    series("planned_seconds_low", [](const Trial& t) { return t.forecast.seconds.low; });
    series("planned_seconds_high", [](const Trial& t) { return t.forecast.seconds.high; });
    for (std::size_t i = 0; i < trials.size(); ++i) {
        row.seconds.push_back(trials[i].seconds);
        row.rounds.push_back(static_cast<std::int32_t>(i));
    }
    row.figures = {
        {"target", scene.target()},
        {"trials", static_cast<double>(trials.size())},
        {"reached", share_of(trials, [](const Trial& t) { return t.reached; })},
        {"covered",
         share_of(trials, [](const Trial& t) { return t.error >= t.stated.low && t.error <= t.stated.high; })},
        {"below", share_of(trials, [](const Trial& t) { return t.error < t.stated.low; })},
        {"above", share_of(trials, [](const Trial& t) { return t.error > t.stated.high; })},
        {"error_over_target", mean_of(errors) / scene.target()},
        {"stated_over_error", mean_of(stated) / mean_of(errors)},
        {"interval_over_stated", mean_of(row.series[3].second) / mean_of(stated) - 1},
        {"samples", mean_of(samples)},
        {"equal_samples", static_cast<double>(options.equal_samples)},
        {"planned_over_samples", mean_of(planned) / mean_of(samples)},
        {"samples_in_plan", share_of(trials, [](const Trial& t) { return contains(t.forecast.samples, t.samples); })},
        {"planned_over_seconds", mean_of(times) / mean_of(row.seconds)},
        {"seconds_in_plan", share_of(trials, [](const Trial& t) { return contains(t.forecast.seconds, t.seconds); })}};
    return row;
}

double figure(const BenchmarkRow& row, const std::string& name) {
    const auto found =
        std::find_if(row.figures.begin(), row.figures.end(), [&](const auto& entry) { return entry.first == name; });
    return found->second;
}

Table table_of(const std::vector<BenchmarkRow>& rows) {
    Table table{
        "Means over the trials. Covered: the true error is in the stated 95 % interval. In plan: within the "
        "interval of the forecast",
        {{"Scene"},
         {"Target", true},
         {"Error / target", true},
         {"Samples per pixel", true},
         {"Covered", true},
         {"Below", true},
         {"Above", true},
         {"Interval", true},
         {"Reached", true},
         {"Samples in plan", true},
         {"Time in plan", true}},
        {}};
    const auto percent = [](double share) { return fmt::format("{:.1f} %", 100 * share); };
    for (const BenchmarkRow& row : rows) {
        table.rows.push_back({row.scene, fmt::format("{:.4g}", figure(row, "target")),
                              fmt::format("{:.3f}", figure(row, "error_over_target")),
                              fmt::format("{:.1f}", figure(row, "samples")), percent(figure(row, "covered")),
                              percent(figure(row, "below")), percent(figure(row, "above")),
                              "+" + percent(figure(row, "interval_over_stated")), percent(figure(row, "reached")),
                              percent(figure(row, "samples_in_plan")), percent(figure(row, "seconds_in_plan"))});
    }
    return table;
}

}  // namespace

bool run_coverage(const CoverageOptions& options, const BackendSource& source, Report& report) {
    if (options.scenes.empty()) throw InputError("name the scenes: glTF files, named:NAME, or those of closed:");
    report.title = "Renders to a target";
    report.summary = fmt::format(
        "Each scene is rendered {} times, with {} x {} pixels, to the {} that {} samples in every pixel have. The true "
        "error is measured against two references of {} samples per pixel. Times: {} clock.",
        options.trials, options.size.width, options.size.height, options.metric, options.equal_samples,
        options.reference_samples, options.clock);
    BackendOptions backend_options;
    backend_options.threads = options.threads;
    const std::unique_ptr<Backend> backend = source.make(options.backend, backend_options);
    describe_backend(*backend, report);
    bool covers = true;
    for (const std::string& name : options.scenes) {
        log_progress("coverage: " + name);
        CoveredScene scene(options, *backend, name);
        std::vector<Trial> trials;
        trials.reserve(static_cast<std::size_t>(options.trials));
        for (int i = 0; i < options.trials; ++i) trials.push_back(scene.run(options.seed + static_cast<unsigned>(i)));
        report.rows.push_back(row_of(scene, options, trials));
        covers = covers && figure(report.rows.back(), "covered") >= least_covered;
    }
    report.blocks.emplace_back(table_of(report.rows));
    report.blocks.emplace_back(
        covers
            ? Callout{Callout::Kind::good, "The stated intervals have the true error in 93 % of the trials or more."}
            : Callout{Callout::Kind::bad, "For a scene, fewer than 93 % of the stated intervals have the true error."});
    return covers;
}

}  // namespace tandem::bench
