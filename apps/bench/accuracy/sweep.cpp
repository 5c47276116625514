#include "accuracy/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <future>
#include <map>
#include <optional>
#include <thread>
#include <utility>

#include "frame_timing.h"
#include "output.h"
#include "pictures.h"
#include "rasterised_frame.h"
#include "tandem/accuracy/image_errors.h"
#include "tandem/accuracy/reference_difference.h"
#include "tandem/base/error.h"
#include "tandem/base/seconds.h"
#include "tandem/images/compare.h"
#include "tandem/images/flip.h"
#include "tandem/report/format_number.h"
#include "tiers.h"

namespace tandem::bench {

namespace {

/// The share of pixels in which a tier may differ from the baseline by 5 %. The samples are the same, so only wrong
/// decisions can cause such differences. Above this share the tier has failed, whatever its mean error.
constexpr double most_wrong_pixels = 0.01;

constexpr std::size_t most_pending_bytes = std::size_t{256} << 20;  // of images whose errors are not yet computed

/// A point while it is measured.
struct Measured {
    const SweepBackend* backend = nullptr;
    const Scene* scene = nullptr;
    const FlipReference* reference = nullptr;
    std::optional<ErrorMeter> meter;
    std::array<std::vector<double>, metrics.size()> errors;  ///< one per seed; squared for Metric::rmse
    std::size_t broken = 0;                                  ///< pixels of all seeds
};

/// Computes the errors of images on all cores, while nothing is timed.
class PendingImages {
  public:
    void add(Measured& measured, FloatImage image) {
        bytes_ += image.pixels.size() * sizeof(Vec3f);
        images_.emplace_back(&measured, std::move(image));
        if (bytes_ > most_pending_bytes) measure();
    }

    /// No two of the images belong to the same point.
    void measure() {
        std::atomic<std::size_t> next{0};
        const auto work = [&] {
            for (std::size_t i = next++; i < images_.size(); i = next++) measure(*images_[i].first, images_[i].second);
        };
        std::vector<std::future<void>> helpers;
        for (unsigned int i = 1; i < std::thread::hardware_concurrency(); ++i) {
            helpers.push_back(std::async(std::launch::async, work));
        }
        work();
        for (std::future<void>& helper : helpers) helper.get();
        images_.clear();
        bytes_ = 0;
    }

  private:
    static void measure(Measured& measured, const FloatImage& image) {
        const ImageErrors errors = measured.meter->add(image);
        const double seen = measured.reference->difference(image).mean;
        const std::array values = {errors.squared, errors.relative, errors.trimmed, seen};
        for (std::size_t i = 0; i < metrics.size(); ++i) measured.errors[i].push_back(values[i]);
        measured.broken += errors.broken;
    }

    std::vector<std::pair<Measured*, FloatImage>> images_;
    std::size_t bytes_ = 0;
};

void estimate_errors(SweepPoint& point, const Measured& measured, bool exact_reference) {
    const ErrorMeter::Variance shared = measured.meter->reference_variance();
    const auto estimate = [&](Metric metric, double variance) {
        return estimate_mean(measured.errors[static_cast<std::size_t>(metric)], variance);
    };
    // Trimmed errors: the variance of all pixels is an upper bound for that of the pixels that are kept
    point.errors = {root_of(estimate(Metric::rmse, shared.squared)), estimate(Metric::relative, shared.relative),
                    estimate(Metric::trimmed, shared.relative), estimate(Metric::flip, 0)};
    BenchmarkRow& row = point.row;
    row.figures.emplace_back("samples per pixel", point.samples);
    for (const Metric metric : metrics) {
        const ErrorEstimate& error = point.error(metric);
        const std::string name = to_string(metric);
        row.figures.emplace_back(name, error.value);
        row.figures.emplace_back(name + " low", error.interval.low);
        row.figures.emplace_back(name + " high", error.interval.high);
        row.series.emplace_back(metric == Metric::rmse ? "squared error" : name,
                                measured.errors[static_cast<std::size_t>(metric)]);
    }
    row.figures.emplace_back("exact reference", exact_reference ? 1 : 0);
    if (measured.broken > 0) point.failures.push_back(fmt::format("{} pixels are not finite", measured.broken));
    for (std::string& counted : in_words(row.counters)) point.failures.push_back(std::move(counted));
}

SweepPoint make_point(const SweepOptions& options, const std::string& scene, const SweepBackend& backend,
                      const Setting& setting, int samples) {
    SweepPoint point{setting, samples, {}, {}, 0, {}};
    point.row.label = fmt::format("{}, {}, {} spp", backend.name, setting.name, samples);
    point.row.scene = scene;
    point.row.backend = backend.name;
    point.row.tier = to_string(setting.tier);
    point.row.samples = sample_count(job_of(options, setting, samples, 0));
    point.row.note = fmt::format("axis: {}", to_string(setting.axis));
    if (backend.name != "cuda") point.row.threads = options.threads;
    return point;
}

/// Renders every point once with the same seed, compares the bits, and says how long the rounds may take.
void render_first_frames(const SweepOptions& options, SceneSweep& sweep, const std::vector<Measured>& measured) {
    const Stopwatch watch;
    std::map<int, Film> baseline;  // by samples
    for (std::size_t i = 0; i < sweep.points.size(); ++i) {
        SweepPoint& point = sweep.points[i];
        TimedFrame first = render_setting(options, *measured[i].backend->backend, sweep.denoiser.get(),
                                          *measured[i].scene, point.setting, point.samples, options.seed);
        point.row.counters += first.stats.counters;
        const auto found = baseline.find(point.samples);
        if (found == baseline.end()) {
            baseline.emplace(point.samples, std::move(first.film));
            continue;
        }
        const FilmDifference difference = compare(found->second, first.film);
        point.differing = static_cast<double>(difference.differing_sums) / static_cast<double>(difference.pixels);
        const double wrong = difference.residual_rate(Tolerance::relative_5_percent);
        if (point.setting.axis == Axis::tier && wrong > most_wrong_pixels) {
            point.failures.push_back(
                fmt::format("{} of the pixels differ by more than 5 % from those of {} with the "
                            "same samples",
                            format_share(wrong), sweep.plan.settings.front().name));
        }
    }
    log_progress(fmt::format("{}: {} rounds of {} images; rendering takes about {}", sweep.scene.name, options.seeds,
                             sweep.points.size(), format_seconds(watch.seconds() * options.seeds)));
}

/// Null if there is none; then `why_not` gives the reason.
std::shared_ptr<const Denoiser> find_denoiser(const SweepOptions& options, std::string& why_not) {
    try {
        return std::make_shared<Denoiser>(options.denoiser, options.threads);
    } catch (const EnvironmentError& error) {
        why_not = fmt::format("{}.", error.what());
        return nullptr;
    }
}

}  // namespace

const char* to_string(Metric metric) {
    static constexpr std::array names = {"RMSE", "relMSE", "trimmed relMSE", "mean FLIP"};
    return names[static_cast<std::size_t>(metric)];
}

PricedError SweepPoint::priced(Metric metric) const {
    const Summary time = summarize(row.seconds);
    return {time.median, time.interval.value_or(Interval{time.least, time.most}), error(metric)};
}

namespace {

const FilterReference& filter_reference(const SceneSweep& sweep, const Setting& setting) {
    const auto found = std::find_if(sweep.filters.begin(), sweep.filters.end(),
                                    [&](const FilterReference& one) { return one.filter == setting.filter; });
    assert(found != sweep.filters.end());
    return *found;
}

}  // namespace

const Reference& SceneSweep::reference_of(const Setting& setting) const {
    return has_the_image_of_the_baseline(setting) ? reference.reference
                                                  : filter_reference(*this, setting).described.reference;
}

const ErrorEstimate& SceneSweep::difference_of(const Setting& setting) const {
    return filter_reference(*this, setting).difference;
}

std::vector<const SweepPoint*> SceneSweep::ladder(const std::string& backend, const Setting& setting) const {
    std::vector<const SweepPoint*> found;
    for (const SweepPoint& point : points) {
        if (point.row.backend == backend && point.setting.name == setting.name) found.push_back(&point);
    }
    return found;
}

Scene scene_of(const Scene& scene, const Setting& setting) {
    return setting.level ? tessellated_twin(scene, *setting.level).value() : scene;
}

RenderJob job_of(const SweepOptions& options, const Setting& setting, int samples, std::uint64_t seed) {
    RenderJob job;
    job.width = options.size.width;
    job.height = options.size.height;
    job.samples = samples;
    job.seed = seed;
    job.tier = setting.tier;
    job.sampler = setting.sampler;
    job.filter = setting.filter;
    job.limits = setting.limits;
    return job;
}

VariedAxes varied_axes(const SweepOptions& options) {
    VariedAxes axes = parse_axes(options.axes, parse_tiers(options.tiers));
    axes.levels = options.levels;
    return axes;
}

ReferenceOptions reference_options(const SweepOptions& options, PixelFilter filter) {
    const int most = *std::max_element(options.samples.begin(), options.samples.end());
    return {options.size,
            options.reference_samples > 0 ? options.reference_samples : 16 * most,
            options.seed,
            options.reference_folder,
            options.rebuild_references,
            filter};
}

Backend& reference_backend(const std::vector<SweepBackend>& backends) {
    const auto gpu = std::find_if(backends.begin(), backends.end(), [](const auto& b) { return b.name == "cuda"; });
    return gpu == backends.end() ? *backends.front().backend : *gpu->backend;
}

TimedFrame render_setting(const SweepOptions& options, Backend& backend, const Denoiser* denoiser, const Scene& scene,
                          const Setting& setting, int samples, std::uint64_t seed) {
    RenderJob job = job_of(options, setting, samples, seed);
    if (setting.axis == Axis::rasterised) return rasterise_timed(scene, job, options.threads);
    if (setting.axis != Axis::denoised) return render_timed(backend, scene, job, setting.forced);
    job.planes = denoiser_planes;
    TimedFrame timed = render_timed(backend, scene, job, setting.forced);
    const Stopwatch watch;
    const FloatImage image = denoiser->denoise(timed.film);
    timed.stats.seconds.render += watch.seconds();
    timed.film = film_of({&image.pixels[0].x, 3 * image.pixels.size()}, image.width, image.height);
    return timed;
}

SceneSweep sweep_scene(const SweepOptions& options, const std::string& name,
                       const std::vector<SweepBackend>& backends) {
    AccuracyScene loaded = load_accuracy_scene(name, options.size);
    VariedAxes axes = varied_axes(options);
    std::shared_ptr<const Denoiser> denoiser;
    if (axes.denoised) denoiser = find_denoiser(options, axes.no_denoiser);
    SettingPlan plan = plan_settings(loaded.scene, axes);
    DescribedReference described = make_reference(loaded, reference_backend(backends), reference_options(options));
    SceneSweep sweep{std::move(loaded), std::move(plan), std::move(described), {}, {}, std::move(denoiser)};
    const Reference& reference = sweep.reference.reference;
    sweep.floors[static_cast<std::size_t>(Metric::rmse)] = reference.noise_floor();
    if (!reference.is_exact()) {
        sweep.floors[static_cast<std::size_t>(Metric::flip)] =
            flip(reference.first(), reference.second(), {.display = sweep.display()}).mean;
    }

    for (const Setting& setting : sweep.plan.settings) {
        if (has_the_image_of_the_baseline(setting)) continue;
        DescribedReference other =
            make_reference(sweep.scene, reference_backend(backends), reference_options(options, setting.filter));
        const ErrorEstimate difference = difference_of(other.reference, reference);
        sweep.filters.push_back({setting.filter, std::move(other), difference});
    }

    std::map<int, Scene> twins;  // by level
    for (const Setting& setting : sweep.plan.settings) {
        if (setting.level) twins.emplace(*setting.level, scene_of(sweep.scene.scene, setting));
    }
    std::map<const Reference*, FlipReference> as_seen;
    std::vector<Measured> measured;
    for (const SweepBackend& backend : backends) {
        for (const Setting& setting : sweep.plan.settings) {
            const Scene& scene = setting.level ? twins.at(*setting.level) : sweep.scene.scene;
            if (!runs_on(setting, backend.name)) continue;
            for (const int samples : options.samples) {
                sweep.points.push_back(make_point(options, name, backend, setting, samples));
                const Reference& own = sweep.reference_of(setting);
                const FlipOptions flip_options{.display = sweep.display()};
                const FlipReference& seen = as_seen.try_emplace(&own, own.mean(), flip_options).first->second;
                measured.push_back({&backend, &scene, &seen, std::nullopt, {}, 0});
                measured.back().meter.emplace(own);
            }
        }
    }
    render_first_frames(options, sweep, measured);
    PendingImages pending;
    for (int round = 0; round < options.seeds; ++round) {
        for (const std::size_t i : interleaved_order(sweep.points.size(), static_cast<std::size_t>(round))) {
            SweepPoint& point = sweep.points[i];
            const auto seed = options.seed + 1 + static_cast<std::uint64_t>(round);
            const TimedFrame timed = render_setting(options, *measured[i].backend->backend, sweep.denoiser.get(),
                                                    *measured[i].scene, point.setting, point.samples, seed);
            record(point.row, round, timed.stats.seconds.render, timed);
            pending.add(measured[i], film_to_image(timed.film));
        }
        pending.measure();
    }
    for (std::size_t i = 0; i < measured.size(); ++i) {
        estimate_errors(sweep.points[i], measured[i], reference.is_exact());
        sweep.points[i].row.errors.push_back(
            {fmt::format("{} on {}, same seed", sweep.plan.settings.front().name, backends.front().name), "any bit",
             sweep.points[i].differing});
    }
    return sweep;
}

}  // namespace tandem::bench
