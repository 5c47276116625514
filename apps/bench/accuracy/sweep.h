/// The measurements of the accuracy report: every setting of a scene with every number of samples on every backend.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "accuracy/accuracy_scenes.h"
#include "accuracy/references.h"
#include "accuracy/settings.h"
#include "backend_source.h"
#include "frame_timing.h"
#include "tandem/accuracy/pareto.h"
#include "tandem/images/denoiser.h"
#include "tandem/report/report.h"

namespace tandem::bench {

struct SweepOptions {
    std::vector<std::string> scenes;  ///< as load_accuracy_scene() takes them; empty means the paper's
    std::vector<std::string> backends = {"cpu", "cuda"};
    std::vector<std::string> tiers = {"fast", "strict", "precise"};
    std::vector<std::string> axes = {"samples", "sampler",      "filter",     "tier",    "effects",
                                     "depth",   "tessellation", "rasterised", "denoised"};
    std::string denoiser;                       ///< its library; empty: where the system's loader looks
    std::vector<int> levels = {1, 3, 5};        ///< of tessellation
    std::vector<int> samples = {1, 4, 16, 64};  ///< per pixel
    FilmSize size{200, 180};
    int seeds = 32;  ///< images per point; at least 2
    std::uint64_t seed = 0;
    int threads = 0;               ///< of the CPU; 0 means one per core
    int reference_samples = 0;     ///< per pixel, of each of two; 0 means 16 times the most of `samples`
    std::string reference_folder;  ///< empty: references are not kept
    bool rebuild_references = false;
};

enum class Metric { rmse, relative, trimmed, flip };
inline constexpr std::array metrics = {Metric::rmse, Metric::relative, Metric::trimmed, Metric::flip};

/// "RMSE", "relMSE", "trimmed relMSE", "mean FLIP".
[[nodiscard]] const char* to_string(Metric metric);

/// A backend, a setting and a number of samples.
struct SweepPoint {
    Setting setting;
    int samples = 0;                                   ///< per pixel
    BenchmarkRow row;                                  ///< one measurement per seed; the time is that of rendering
    std::array<ErrorEstimate, metrics.size()> errors;  ///< by Metric
    double differing = 0;  ///< the share of pixels whose bits differ from the baseline's on the first backend
    std::vector<std::string> failures;  ///< in words: pixels that are not finite, wrong decisions of a tier,
                                        ///< counters of what should not happen

    [[nodiscard]] const ErrorEstimate& error(Metric metric) const { return errors[static_cast<std::size_t>(metric)]; }
    [[nodiscard]] PricedError priced(Metric metric) const;
    [[nodiscard]] double seconds() const { return median(row.seconds); }
};

struct SweepBackend {
    std::string name;
    std::unique_ptr<Backend> backend;
};

/// What the images of another filter than the baseline's are compared with.
struct FilterReference {
    PixelFilter filter;
    DescribedReference described;
    ErrorEstimate difference;  ///< the RMSE of its converged image from that of the baseline
};

struct SceneSweep {
    AccuracyScene scene;
    SettingPlan plan;
    DescribedReference reference;
    std::array<double, metrics.size()> floors{};  ///< of the references' noise, by Metric; 0 where it has none
    std::vector<SweepPoint> points;               ///< by backend, then by setting, then by samples
    std::shared_ptr<const Denoiser> denoiser{};   ///< null if no setting is denoised
    std::vector<FilterReference> filters{};       ///< of the settings of Axis::filter

    [[nodiscard]] const Display& display() const { return scene.scene.display; }
    [[nodiscard]] double floor(Metric metric) const { return floors[static_cast<std::size_t>(metric)]; }
    /// What the images of a setting are compared with.
    [[nodiscard]] const Reference& reference_of(const Setting& setting) const;
    /// How far the converged image of a setting of Axis::filter is from that of the baseline.
    [[nodiscard]] const ErrorEstimate& difference_of(const Setting& setting) const;
    /// The points of a setting on a backend, by samples.
    [[nodiscard]] std::vector<const SweepPoint*> ladder(const std::string& backend, const Setting& setting) const;
};

/// Measures a scene. One image per point before the rounds, which is not timed, for the bits; then one round per seed,
/// in alternating order. Errors are computed between renders, on all cores. Throws as make_reference() does.
[[nodiscard]] SceneSweep sweep_scene(const SweepOptions& options, const std::string& name,
                                     const std::vector<SweepBackend>& backends);

/// The scene of a setting: the twin of meshes, or the scene itself.
[[nodiscard]] Scene scene_of(const Scene& scene, const Setting& setting);

/// Renders a frame of a setting, of a scene that scene_of() gave: on the backend, or by the rasteriser. `denoiser` may
/// be null where no setting is denoised. The time of rendering includes that of denoising, and the film is then the
/// denoised image.
[[nodiscard]] TimedFrame render_setting(const SweepOptions& options, Backend& backend, const Denoiser* denoiser,
                                        const Scene& scene, const Setting& setting, int samples, std::uint64_t seed);

/// The job of a setting with a seed.
[[nodiscard]] RenderJob job_of(const SweepOptions& options, const Setting& setting, int samples, std::uint64_t seed);

/// The backend that renders references: the GPU's if there is one. Bits are equal anyway.
[[nodiscard]] Backend& reference_backend(const std::vector<SweepBackend>& backends);

/// Throws as parse_axes() does.
[[nodiscard]] VariedAxes varied_axes(const SweepOptions& options);

/// Of the references with a filter.
[[nodiscard]] ReferenceOptions reference_options(const SweepOptions& options, PixelFilter filter = PixelFilter::box);

}  // namespace tandem::bench
