#include "tandem/render/forecast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "tandem/compile/prepared_scene.h"
#include "tandem/math/fp_environment.h"
#include "tandem/render/tile_windows.h"

namespace tandem {

namespace {

/// The probe has a window for each of a few bands: rows of tiles, so that every processor has work.
constexpr int most_probe_bands = 8;

/// The share of the time that the probe cannot predict: two standard deviations.
constexpr double unknown_share_of_time = 0.2;

struct ProbeBand {
    FilmWindow window;
    std::array<double, probe_passes> rates{};  ///< seconds per sample, by pass
};

std::vector<ProbeBand> bands_of(const TileGrid& grid) {
    std::vector<ProbeBand> bands;
    const int rows = (grid.rows() - 1) / most_probe_bands + 1;
    for (int row = 0; row < grid.rows(); row += rows) {
        const int top = row * grid.edge;
        bands.push_back({{0, top, grid.width, std::min(rows * grid.edge, grid.height - top)}, {}});
    }
    return bands;
}

/// Adds a window of whole tiles to the tiles of a film, and its samples to `fresh`, unless they are the first ones.
void add(TiledFilm& film, std::vector<Film>& fresh, const FilmWindow& window, const Film& part) {
    for (std::size_t i = 0; i < film.grid().count(); ++i) {
        const FilmWindow tile = film.grid().tile(i);
        if (tile.top < window.top || tile.top >= window.top + window.height) continue;
        Film cut(tile.width, tile.height, part.samples(), film.planes());
        copy_window(cut, 0, 0, part, {tile.left - window.left, tile.top - window.top, tile.width, tile.height});
        const bool is_first = film.samples(i) == 0;
        film.add(i, cut);
        if (is_first) continue;
        if (fresh[i].samples() == 0) {
            fresh[i] = std::move(cut);
        } else {
            fresh[i].add(cut);
        }
    }
}

/// The tiles after the last round.
struct Outcome {
    std::vector<int> samples;
    int rounds = 1;
};

/// The outcome if the errors were `factor` times those of the probe.
Outcome outcome_of(std::vector<TileErrors> tiles, const TileGrid& grid, const RenderTarget& target, int most,
                   double factor) {
    for (TileErrors& tile : tiles) tile.errors = scaled(tile.errors, factor);
    for (int rounds = 2;; ++rounds) {
        look_around(tiles, grid);
        Allotment next = allot(tiles, target, most);
        if (next.is_last) return {std::move(next.ends), rounds};
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            tiles[i].errors = predicted(tiles[i], next.ends[i]);
            tiles[i].samples = next.ends[i];
        }
    }
}

/// Pixels times samples of the tiles within a window. Marked tiles count `factor` times.
double work_in(const FilmWindow& window, const TileGrid& grid, const std::vector<int>& samples,
               const std::vector<bool>& marked, double factor) {
    double work = 0;
    for (std::size_t i = 0; i < grid.count(); ++i) {
        const FilmWindow tile = grid.tile(i);
        if (tile.top < window.top || tile.top >= window.top + window.height) continue;
        work += static_cast<double>(pixel_count(tile)) * samples[i] * (marked[i] ? factor : 1);
    }
    return work;
}

/// Renders the marked tiles once more, and returns their time over that of their bands for as many samples.
double dearness_of(Backend& backend, const std::shared_ptr<ResidentScene>& scene, RenderJob job, const TileGrid& grid,
                   const std::vector<ProbeBand>& bands, const std::vector<bool>& marked,
                   const std::function<double()>& clock) {
    std::vector<int> samples(grid.count());
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = marked[i] ? job.samples : 0;
    double expected = 0;
    for (const ProbeBand& band : bands) {
        double rate = 0;
        for (const double of_pass : band.rates) rate += of_pass / probe_passes;
        expected += rate * work_in(band.window, grid, samples, marked, 1);
    }
    const double start = clock();
    for (const FilmWindow& window : windows_of(grid, marked)) {
        job.window = window;
        (void)backend.render(scene, job);
    }
    return expected > 0 ? (clock() - start) / expected : 1;
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

    const bool has_error = target.error > 0;
    if (has_error) job.planes |= FilmPlane::variance;
    job.samples = std::clamp(most / probe_passes, 1, first_round_end / probe_passes);
    const TileGrid grid{job.width, job.height, target_tile_edge(job.width, job.height)};
    TiledFilm film(grid, FilmPlane::variance);
    std::vector<Film> fresh(grid.count());
    std::vector<ProbeBand> bands = bands_of(grid);
    for (std::size_t pass = 0; pass < probe_passes; ++pass) {
        job.first_sample = static_cast<int>(pass) * job.samples;
        for (ProbeBand& band : bands) {
            job.window = band.window;
            const double before = clock();
            const Film part = backend.render(resident, job).film;
            band.rates[pass] = (clock() - before) / (static_cast<double>(pixel_count(band.window)) * job.samples);
            if (has_error) add(film, fresh, band.window, part);
        }
    }

    Forecast result;
    std::array<Outcome, 3> outcomes;  // expected, low and high
    outcomes.fill({std::vector<int>(grid.count(), most)});
    double of_decision = 0;  // seconds
    if (has_error) {
        const double before = clock();
        const std::vector<TileErrors> tiles =
            tile_errors(film, target.metric == ErrorMetric::flip ? &fresh : nullptr, target);
        of_decision = clock() - before;
        const ErrorSums now = sum_of(tiles);
        const StatedError stated = estimate_error(now, target.metric);
        const double spread =
            now.sum > 0 ? mean_of_target(stated.high, target.metric) / mean_of_target(stated.value, target.metric) : 1;
        outcomes = {outcome_of(tiles, grid, target, most, 1), outcome_of(tiles, grid, target, most, 1 / spread),
                    outcome_of(tiles, grid, target, most, spread)};
        ErrorSums least;
        for (const TileErrors& tile : tiles) least += predicted(tile, most);
        const StatedError error = estimate_error(least, target.metric);
        result.least_error = {error.value, error.low, error.high};
        result.can_reach = error.value <= target.error;
    }
    // tiles with much noise take more time per sample than others of their row
    std::vector<bool> noisy(grid.count());
    const std::vector<int>& ends = outcomes[0].samples;
    const int fewest = *std::min_element(ends.begin(), ends.end());
    std::transform(ends.begin(), ends.end(), noisy.begin(), [&](int end) { return end > fewest; });
    job.first_sample += job.samples;
    const double dearness = dearness_of(backend, resident, job, grid, bands, noisy, clock);

    std::array<double, 3> work{};
    std::array<double, probe_passes> seconds{};
    for (const ProbeBand& band : bands) {
        for (std::size_t i = 0; i < work.size(); ++i)
            work[i] += work_in(band.window, grid, outcomes[i].samples, noisy, 1);
        for (std::size_t pass = 0; pass < probe_passes; ++pass) {
            seconds[pass] += band.rates[pass] * work_in(band.window, grid, ends, noisy, dearness);
        }
    }
    double mean = 0, squares = 0;
    for (const double s : seconds) mean += s / probe_passes;
    for (const double s : seconds) squares += (s - mean) * (s - mean) / (probe_passes - 1);
    constexpr double quantile = 3.182446305284263;  // Student's t, 97.5 %, 3 degrees of freedom
    static_assert(probe_passes == 4);
    const double of_passes = quantile * std::sqrt(squares * (1 + 1.0 / probe_passes));
    const double half = std::sqrt(of_passes * of_passes + unknown_share_of_time * mean * unknown_share_of_time * mean);
    const double setup = loaded - start;
    const double pixels = static_cast<double>(job.width) * job.height;
    result.samples = {work[0] / pixels, work[1] / pixels, work[2] / pixels};
    const auto decisions = [&](std::size_t i) { return of_decision * outcomes[i].rounds; };
    result.seconds = {setup + decisions(0) + mean,
                      setup + decisions(1) + std::max(mean - half, 0.0) * (work[1] / work[0]),
                      setup + decisions(2) + (mean + half) * (work[2] / work[0])};
    result.probe_seconds = clock() - loaded;
    return result;
}

Fits fits(const Forecast& forecast, double seconds) {
    if (forecast.seconds.low > seconds) return Fits::no;
    return forecast.seconds.high <= seconds ? Fits::yes : Fits::perhaps;
}

}  // namespace tandem
