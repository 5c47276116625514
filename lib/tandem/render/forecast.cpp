#include "tandem/render/forecast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "tandem/math/fp_environment.h"
#include "tandem/render/tiled_film.h"

namespace tandem {

namespace {

/// The probe has a window for each of a few bands: rows of tiles, so that every processor has work.
constexpr int most_bands = 8;

struct Band {
    FilmWindow window;
    Film film;                                 ///< of all passes
    std::array<double, probe_passes> rates{};  ///< seconds per sample, by pass
};

std::vector<Band> bands_of(const TileGrid& grid) {
    std::vector<Band> bands;
    const int rows = (grid.rows() - 1) / most_bands + 1;
    for (int row = 0; row < grid.rows(); row += rows) {
        const int top = row * grid.edge;
        bands.push_back({{0, top, grid.width, std::min(rows * grid.edge, grid.height - top)}, {}, {}});
    }
    return bands;
}

/// The samples that render_to_target() takes for a tile, if its errors at `probed` samples are those times `scale`.
int samples_of(const SquaredErrors& errors, const RenderTarget& target, int probed, int most, double scale) {
    for (int samples = next_round_end(0, most); samples < most; samples = next_round_end(samples, most)) {
        const double now = static_cast<double>(probed) / samples * scale;
        const int next = next_round_end(samples, most);
        if (will_reach(errors, target, static_cast<double>(next) / samples / now)) return next;
    }
    return most;
}

/// Pixels times samples, as expected and at the ends of the interval.
struct Work {
    double value = 0, low = 0, high = 0;
    double short_pixels = 0;

    Work& operator+=(const Work& other) {
        value += other.value;
        low += other.low;
        high += other.high;
        short_pixels += other.short_pixels;
        return *this;
    }
};

Work work_of(const SquaredErrors& errors, const RenderTarget& target, int probed, int most) {
    const double pixels = errors.pixels;
    const double mean = errors.sum / pixels;
    const double spread = mean > 0 ? upper_mean(errors) / mean : 1;
    const auto at = [&](double scale) { return pixels * samples_of(errors, target, probed, most, scale); };
    Work work{at(1), at(1 / spread), at(spread), 0};
    const double last = static_cast<double>(probed) / most;
    if (!will_reach(errors, target, 1 / last)) work.short_pixels = pixels;
    return work;
}

/// The work of a band's tiles.
Work work_of(const Band& band, const RenderTarget& target, int most, double film_mean) {
    if (target.error == 0) {
        const double all = static_cast<double>(pixel_count(band.window)) * most;
        return {all, all, all, 0};
    }
    Work work;
    const TileGrid grid{band.window.width, band.window.height, target_tile_edge};
    for (std::size_t i = 0; i < grid.count(); ++i) {
        const FilmWindow window = grid.tile(i);
        Film tile(window.width, window.height, band.film.samples(), band.film.plane_mask());
        copy_window(tile, 0, 0, band.film, window);
        work += work_of(squared_errors(tile, tile, target.metric, film_mean), target, tile.samples(), most);
    }
    return work;
}

}  // namespace

Forecast forecast(Backend& backend, const Scene& scene, const FramePlan& plan, const RenderTarget& target,
                  const std::function<double()>& clock) {
    const DefaultFpEnvironment guard;
    check_still(plan);
    RenderJob job = plan.instants.front().job;
    check(target, job);
    const int most = job.samples;
    const double start = clock();
    const auto resident = backend.load(prepare(scene, plan.instants.front().prepare), job.tier);
    const double loaded = clock();

    if (target.error > 0) job.planes |= FilmPlane::variance;
    job.samples = std::clamp(most / probe_passes, 1, target_first_round / probe_passes);
    std::vector<Band> bands = bands_of({job.width, job.height, target_tile_edge});
    for (std::size_t pass = 0; pass < probe_passes; ++pass) {
        job.first_sample = static_cast<int>(pass) * job.samples;
        for (Band& band : bands) {
            job.window = band.window;
            const double before = clock();
            const Film film = backend.render(resident, job).film;
            band.rates[pass] = (clock() - before) / (static_cast<double>(pixel_count(band.window)) * job.samples);
            if (pass == 0) {
                band.film = Film(film.width(), film.height(), film.samples(), film.plane_mask());
                copy_window(band.film, 0, 0, film, {0, 0, film.width(), film.height()});
            } else {
                band.film.add(film);
            }
        }
    }

    double film_mean = 0;
    const double pixels = static_cast<double>(job.width) * job.height;
    for (const Band& band : bands) {
        film_mean += mean_value(band.film) * static_cast<double>(pixel_count(band.window)) / pixels;
    }
    Work all;
    std::array<double, probe_passes> seconds{};
    for (const Band& band : bands) {
        const Work work = work_of(band, target, most, film_mean);
        all += work;
        for (std::size_t pass = 0; pass < probe_passes; ++pass) seconds[pass] += band.rates[pass] * work.value;
    }
    double mean = 0, squares = 0;
    for (const double s : seconds) mean += s / probe_passes;
    for (const double s : seconds) squares += (s - mean) * (s - mean) / (probe_passes - 1);
    constexpr double quantile = 3.182446305284263;  // Student's t, 97.5 %, 3 degrees of freedom
    static_assert(probe_passes == 4);
    const double half = quantile * std::sqrt(squares * (1 + 1.0 / probe_passes));
    const double setup = loaded - start;
    Forecast result;
    result.samples = {all.value / pixels, all.low / pixels, all.high / pixels};
    result.seconds = {setup + mean, setup + std::max(mean - half, 0.0) * (all.low / all.value),
                      setup + (mean + half) * (all.high / all.value)};
    result.probe_seconds = clock() - loaded;
    result.short_pixels = all.short_pixels / pixels;
    return result;
}

Fits fits(const Forecast& forecast, double seconds) {
    if (forecast.seconds.low > seconds) return Fits::no;
    return forecast.seconds.high <= seconds ? Fits::yes : Fits::perhaps;
}

}  // namespace tandem
