// The pictures of the accuracy report, side by side at equal time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "accuracy/report_blocks.h"
#include "accuracy/report_words.h"
#include "frame_timing.h"
#include "output.h"
#include "pictures.h"
#include "tandem/accuracy/image_errors.h"
#include "tandem/images/flip.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

constexpr int most_width = 960;

/// The number of samples that a setting takes in about `seconds`, at the rate of its last point; at most that of a
/// reference.
int samples_within(const SweepOptions& options, const SweepPoint& fastest, double seconds) {
    const double samples = std::round(seconds / fastest.seconds() * fastest.samples);
    return static_cast<int>(std::clamp(samples, 1.0, static_cast<double>(reference_options(options).samples)));
}

/// A picture and the map of its FLIP. The caption of the map has the mean.
ComparedPicture compared(const SceneSweep& sweep, const Reference& reference, const FloatImage& image,
                         const std::string& caption) {
    const FlipDifference difference = flip(reference.mean(), image, {.display = sweep.display()});
    return {small_picture(image, most_width, caption, sweep.display()),
            small_picture(
                flip_map(difference), most_width,
                fmt::format("FLIP of {}: mean {}; black is 0, light is 1", caption, format_number(difference.mean)),
                {TransferFunction::linear})};
}

}  // namespace

PictureComparison equal_time_pictures(const SweepOptions& options, const SceneSweep& sweep,
                                      const std::vector<SweepBackend>& backends) {
    const std::vector<const SweepPoint*> ladder = sweep.ladder(backends.front().name, sweep.plan.settings.front());
    const SweepPoint& chosen = *ladder[ladder.size() > 1 ? ladder.size() - 2 : 0];
    log_progress(fmt::format("{}: pictures at {}", sweep.scene.name, format_seconds(chosen.seconds())));
    PictureComparison comparison{
        fmt::format("{}: about {} each, the time of {} on {} with {} spp", sweep.scene.name,
                    format_seconds(chosen.seconds()), chosen.setting.name, chosen.row.backend, chosen.samples),
        {}};
    for (const SweepBackend& backend : backends) {
        for (const Setting& setting : sweep.plan.settings) {
            if (!runs_on(setting, backend.name)) continue;
            const SweepPoint& fastest = *sweep.ladder(backend.name, setting).back();
            const int samples = samples_within(options, fastest, chosen.seconds());
            const TimedFrame frame =
                render_setting(options, *backend.backend, sweep.denoiser.get(), scene_of(sweep.scene.scene, setting),
                               setting, samples, options.seed + 1);
            const FloatImage image = film_to_image(frame.film);
            const Reference& reference = sweep.reference_of(setting);
            ErrorMeter meter(reference);
            const double rmse = std::sqrt(std::max(meter.add(image).squared, 0.0));
            comparison.pictures.push_back(
                compared(sweep, reference, image,
                         fmt::format("{}, {}, {} spp, {}, RMSE {}", backend.name, setting.name, samples,
                                     format_seconds(frame.stats.seconds.render), format_number(rmse))));
        }
    }
    comparison.pictures.push_back(
        compared(sweep, sweep.reference.reference, sweep.reference.reference.first(), "Reference"));
    return comparison;
}

}  // namespace tandem::bench
