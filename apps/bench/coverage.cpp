#include "coverage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "accuracy/accuracy_scenes.h"
#include "accuracy/settings.h"
#include "output.h"
#include "tandem/accuracy/image_errors.h"
#include "tandem/accuracy/reference.h"
#include "tandem/base/error.h"
#include "tandem/base/seconds.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/flip.h"
#include "tandem/render/forecast.h"
#include "tandem/render/tiled_film.h"

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
        : options_(options), backend_(backend), scene_(load_accuracy_scene(name, options.size)) {
        metric_ = parse_metric(options.metric);
        resident_ = backend.load(prepare(scene_.scene, {}));
        Reference rough = scene_.truth ? Reference(uniform(*scene_.truth))
                                       : Reference(render(options.reference_samples, seeds_of_references),
                                                   render(options.reference_samples, seeds_of_references + 1));
        meter_.emplace(reference_.emplace(std::move(rough)));
        for (const int samples : options.equal_samples) targets_.push_back(target_of(samples));
        if (!scene_.truth) refine_reference();
        resident_.reset();
    }

    [[nodiscard]] const std::vector<RenderTarget>& targets() const { return targets_; }
    [[nodiscard]] const std::string& name() const { return scene_.name; }

    Trial run(const RenderTarget& target, std::uint64_t seed) {
        RenderJob job = job_with(options_.most_samples, seed);
        const FramePlan plan = plan_frame(scene_.scene, {}, job);
        const std::function<double()> clock = clock_of();
        const std::atomic<bool> never{false};
        Trial trial;
        if (options_.plans) trial.forecast = forecast(backend_, scene_.scene, plan, target, clock);
        const double start = clock();
        const std::optional<TargetFrame> frame = render_to_target(backend_, scene_.scene, plan, target, never, clock);
        trial.seconds = clock() - start;
        trial.stated = frame->error;
        trial.samples = frame->mean_samples;
        trial.reached = frame->stopped_by == StoppedBy::target;
        trial.error = error_of(film_to_image(frame->frame.result.film));
        return trial;
    }

  private:
    /// The error of an image with that many samples in every pixel, from a few such images.
    [[nodiscard]] RenderTarget target_of(int samples) {
        const bool is_root = metric_ == ErrorMetric::rmse;
        double sum = 0;
        for (int i = 0; i < pilots; ++i) {
            const double error = error_of(render(samples, seeds_of_references + 2 + static_cast<unsigned>(i)));
            sum += is_root ? error * error : error;
        }
        RenderTarget target;
        target.metric = metric_;
        target.display = scene_.scene.display;
        target.error = is_root ? std::sqrt(sum / pilots) : sum / pilots;
        return target;
    }
    /// Replaces the references. A separate render to the finest target shows how many samples each tile needs; the new
    /// references have `reference_factor` times as many. A few pixels may carry most of the error, and they then get
    /// most of the samples.
    void refine_reference() {
        const auto finest = std::min_element(targets_.begin(), targets_.end(),
                                             [](const auto& a, const auto& b) { return a.error < b.error; });
        const std::uint64_t seed = seeds_of_references + 2 + pilots;
        const RenderJob job = job_with(options_.most_samples, seed);
        const std::atomic<bool> never{false};
        const TileSamples tiles =
            parse_tile_samples(render_to_target(backend_, scene_.scene, plan_frame(scene_.scene, {}, job), *finest,
                                                never, [] { return 0.0; })
                                   ->tile_samples,
                               job.width, job.height);
        FloatImage first = refined(tiles, seed + 1), second = refined(tiles, seed + 2);
        meter_.emplace(reference_.emplace(std::move(first), std::move(second)));
    }
    [[nodiscard]] FloatImage refined(const TileSamples& tiles, std::uint64_t seed) const {
        TiledFilm film(tiles.grid, {});
        for (std::size_t i = 0; i < tiles.samples.size(); ++i) {
            RenderJob job = job_with(options_.reference_factor * tiles.samples[i], seed);
            job.window = tiles.grid.tile(i);
            film.add(i, backend_.render(resident_, job).film);
        }
        return film_to_image(film.whole());
    }
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
        if (scene_.truth) job.limits = unlimited;  // a closed form includes paths of any length
        return job;
    }
    [[nodiscard]] FloatImage render(int samples, std::uint64_t seed) {
        return film_to_image(backend_.render(resident_, job_with(samples, seed)).film);
    }
    /// In the unit of the metric.
    [[nodiscard]] double error_of(const FloatImage& image) {
        if (metric_ == ErrorMetric::flip) {
            return flip(image, reference_->mean(), {.display = scene_.scene.display}).mean;
        }
        const ImageErrors errors = meter_->add(image);
        return metric_ == ErrorMetric::rmse ? std::sqrt(std::max(errors.squared, 0.0)) : errors.relative;
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
    std::optional<Reference> reference_;
    std::optional<ErrorMeter> meter_;
    ErrorMetric metric_ = ErrorMetric::rmse;
    std::vector<RenderTarget> targets_;
};

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double share_of(const std::vector<Trial>& trials, const std::function<bool(const Trial&)>& holds) {
    return static_cast<double>(std::count_if(trials.begin(), trials.end(), holds)) / static_cast<double>(trials.size());
}

bool contains(const ForecastRange& range, double value) { return value >= range.low && value <= range.high; }

/// Adds a value per trial, and returns the values.
std::vector<double> add_series(BenchmarkRow& row, const std::vector<Trial>& trials, const char* name,
                               const std::function<double(const Trial&)>& value) {
    std::vector<double> values;
    std::transform(trials.begin(), trials.end(), std::back_inserter(values), value);
    row.series.emplace_back(name, values);
    return values;
}

/// The forecasts and their mean widths: the ratios of the ends of the ranges to the values, minus one.
void add_plans(BenchmarkRow& row, const std::vector<Trial>& trials) {
    struct Quantity {
        const char* name;
        ForecastRange Forecast::*range;
        double Trial::*truth;
    };
    for (const Quantity& quantity : {Quantity{"samples", &Forecast::samples, &Trial::samples},
                                     Quantity{"seconds", &Forecast::seconds, &Trial::seconds}}) {
        const std::string planned = fmt::format("planned_{}", quantity.name);
        const auto of = [&](double ForecastRange::*end, const char* suffix) {
            return add_series(row, trials, (planned + suffix).c_str(),
                              [&](const Trial& t) { return (t.forecast.*quantity.range).*end; });
        };
        const auto values = of(&ForecastRange::value, ""), low = of(&ForecastRange::low, "_low"),
                   high = of(&ForecastRange::high, "_high");
        double truths = 0;
        for (const Trial& trial : trials) truths += trial.*quantity.truth;
        const double mean = mean_of(values);
        row.figures.emplace_back(planned + "_over_" + quantity.name,
                                 mean * static_cast<double>(trials.size()) / truths);
        row.figures.emplace_back(planned + "_low", mean_of(low) / mean - 1);
        row.figures.emplace_back(planned + "_high", mean_of(high) / mean - 1);
        row.figures.emplace_back(fmt::format("{}_in_plan", quantity.name), share_of(trials, [&](const Trial& t) {
                                     return contains(t.forecast.*quantity.range, t.*quantity.truth);
                                 }));
    }
}

BenchmarkRow row_of(const CoveredScene& scene, std::size_t which, const CoverageOptions& options,
                    const std::vector<Trial>& trials) {
    const double target = scene.targets()[which].error;
    BenchmarkRow row;
    row.label = fmt::format("{} {} {:.3g}", scene.name(), options.metric, target);
    row.scene = scene.name();
    row.backend = options.backend;
    row.tier = "strict";
    row.threads = options.threads;
    const auto series = [&](const char* name, const std::function<double(const Trial&)>& value) {
        return add_series(row, trials, name, value);
    };
    const auto errors = series("error", [](const Trial& t) { return t.error; });
    const auto stated = series("stated", [](const Trial& t) { return t.stated.value; });
    series("stated_low", [](const Trial& t) { return t.stated.low; });
    series("stated_high", [](const Trial& t) { return t.stated.high; });
    const auto samples = series("samples", [](const Trial& t) { return t.samples; });
    for (std::size_t i = 0; i < trials.size(); ++i) {
        row.seconds.push_back(trials[i].seconds);
        row.rounds.push_back(static_cast<std::int32_t>(i));
    }
    row.figures = {
        {"target", target},
        {"trials", static_cast<double>(trials.size())},
        {"reached", share_of(trials, [](const Trial& t) { return t.reached; })},
        {"covered",
         share_of(trials, [](const Trial& t) { return t.error >= t.stated.low && t.error <= t.stated.high; })},
        {"below", share_of(trials, [](const Trial& t) { return t.error < t.stated.low; })},
        {"above", share_of(trials, [](const Trial& t) { return t.error > t.stated.high; })},
        {"error_over_target", mean_of(errors) / target},
        {"stated_over_error", mean_of(stated) / mean_of(errors)},
        {"interval_over_stated", mean_of(row.series[3].second) / mean_of(stated) - 1},
        {"samples", mean_of(samples)},
        {"equal_samples", static_cast<double>(options.equal_samples[which])}};
    if (options.plans) add_plans(row, trials);
    return row;
}

std::optional<double> figure(const BenchmarkRow& row, const std::string& name) {
    const auto found =
        std::find_if(row.figures.begin(), row.figures.end(), [&](const auto& entry) { return entry.first == name; });
    return found == row.figures.end() ? std::nullopt : std::optional(found->second);
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
    const auto percent = [](std::optional<double> share) {
        return share ? fmt::format("{:.1f} %", 100 * *share) : std::string("not made");
    };
    for (const BenchmarkRow& row : rows) {
        table.rows.push_back({row.scene, fmt::format("{:.4g}", *figure(row, "target")),
                              fmt::format("{:.3f}", *figure(row, "error_over_target")),
                              fmt::format("{:.1f}", *figure(row, "samples")), percent(figure(row, "covered")),
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
        "Each scene is rendered {} times, with {} x {} pixels, to the {} that {} samples per pixel reach. The true "
        "error is measured against two references, each with {} times the samples, in every tile, of a render to the "
        "finest of these targets. Times: {} clock.",
        options.trials, options.size.width, options.size.height, options.metric, fmt::join(options.equal_samples, ", "),
        options.reference_factor, options.clock);
    BackendOptions backend_options;
    backend_options.threads = options.threads;
    const std::unique_ptr<Backend> backend = source.make(options.backend, backend_options);
    describe_backend(*backend, report);
    bool covers = true;
    for (const std::string& name : options.scenes) {
        log_progress("coverage: " + name);
        CoveredScene scene(options, *backend, name);
        for (std::size_t which = 0; which < scene.targets().size(); ++which) {
            std::vector<Trial> trials;
            trials.reserve(static_cast<std::size_t>(options.trials));
            for (int i = 0; i < options.trials; ++i) {
                trials.push_back(scene.run(scene.targets()[which], options.seed + static_cast<unsigned>(i)));
            }
            report.rows.push_back(row_of(scene, which, options, trials));
            covers = covers && *figure(report.rows.back(), "covered") >= least_covered;
        }
    }
    report.blocks.emplace_back(table_of(report.rows));
    report.blocks.emplace_back(
        covers ? Callout{Callout::Kind::good,
                         "The stated intervals contain the true error in at least 93 % of the trials."}
               : Callout{Callout::Kind::bad,
                         "For a scene, fewer than 93 % of the stated intervals contain the true error."});
    return covers;
}

}  // namespace tandem::bench
