#include "tandem/render/adaptive_frame.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "tandem/base/error.h"
#include "tandem/base/seconds.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/math/fp_environment.h"
#include "tandem/render/flip_error.h"
#include "tandem/render/tile_windows.h"

namespace tandem {

namespace {

/// Of a window: an interrupt waits for two windows.
constexpr std::size_t most_window_samples = std::size_t{1} << 26;

RoundState first_round(const RenderJob& job) {
    const TileGrid grid{job.width, job.height, target_tile_edge(job.width, job.height)};
    const std::size_t tiles = grid.count();
    return {TiledFilm(grid, job.planes | FilmPlane::variance),
            {std::vector<Film>(tiles), std::vector<int>(tiles, 0),
             std::vector<int>(tiles, std::min(first_round_end, job.samples))}};
}

/// The mean of all values of a film.
double mean_value(const TiledFilm& film) {
    double sum = 0, pixels = 0;
    for (std::size_t i = 0; i < film.grid().count(); ++i) {
        const auto sums = film.tile(i).sums();
        const double tile = std::accumulate(sums.begin(), sums.end(), 0.0,
                                            [](double total, const Vec3d& c) { return total + (c.x + c.y + c.z); });
        sum += tile / film.samples(i);
        pixels += static_cast<double>(sums.size());
    }
    return sum / (3 * pixels);
}

class Rounds {
  public:
    Rounds(Backend& backend, const FramePlan& plan, const RenderTarget& target, const std::function<double()>& clock,
           const Resumption& resumption)
        : backend_(backend),
          target_(target),
          clock_(clock),
          resumption_(resumption),
          job_(plan.instants.front().job),
          wanted_(job_.planes),
          state_(resumption.begin ? *resumption.begin : first_round(job_)),
          planned_(state_.film.samples()),
          start_(clock() - state_.round.seconds) {
        job_.planes |= FilmPlane::variance;
        stats_.counters = resumption.counters;
    }
    ~Rounds() {
        // Only after an exception: waits for the windows that the backend still renders.
        for (const Flying& window : flying_) {
            try {
                (void)window.pending->get();
            } catch (...) {
            }
        }
    }
    Rounds(const Rounds&) = delete;
    Rounds& operator=(const Rounds&) = delete;

    /// Renders rounds until one of the reasons to stop.
    StoppedBy run(const std::shared_ptr<ResidentScene>& scene, const std::atomic<bool>& interrupted) {
        while (true) {
            render(scene, interrupted);
            if (!round_is_complete()) return StoppedBy::interrupt;
            if (state_.round.is_last && reaches_target()) return StoppedBy::target;
            Allotment next = allot(all_errors(), target_, job_.samples);
            const double work = work_of(next.ends);
            if (work == 0) return StoppedBy::samples;
            const double elapsed = clock_() - start_;
            if (elapsed + elapsed / work_so_far() * work > target_.seconds) return StoppedBy::time;
            if (interrupted) {
                save();
                return StoppedBy::interrupt;
            }
            state_.round.was_last = state_.round.was_last || state_.round.is_last;
            state_.round.begins = state_.film.samples();
            state_.round.ends = std::move(next.ends);
            state_.round.is_last = next.is_last;
        }
    }

    /// Whether the first round is incomplete.
    [[nodiscard]] bool is_too_early() const {
        const std::vector<int> samples = state_.film.samples();
        return *std::min_element(samples.begin(), samples.end()) < std::min(first_round_end, job_.samples);
    }
    [[nodiscard]] TargetFrame result(StoppedBy reason) {
        TargetFrame frame;
        const ErrorSums errors = sum_of(fresh_errors());
        frame.frame.result = {state_.film.whole(wanted_), std::move(stats_)};
        frame.error = estimate_error(errors, target_.metric);
        if (target_.metric != ErrorMetric::flip) {
            const StatedError all = estimate_error(sum_of(all_errors()), target_.metric);
            frame.error.low = std::min(frame.error.low, all.low);
            frame.error.high = std::max(frame.error.high, all.high);
        }
        frame.stopped_by = reason;
        frame.tile_samples = tile_samples_text(state_.film.grid().edge, state_.film.samples());
        frame.mean_samples = work_so_far() / static_cast<double>(frame.frame.result.film.pixel_count());
        return frame;
    }

  private:
    struct Flying {
        FilmWindow window;
        int begin;  ///< its first sample
        std::unique_ptr<PendingFrame> pending;
    };

    /// From the fresh samples of the film as it is now.
    [[nodiscard]] const std::vector<TileErrors>& fresh_errors() {
        if (!fresh_errors_) fresh_errors_ = tile_errors(state_.film, &state_.round.fresh, target_);
        return *fresh_errors_;
    }
    /// From all samples. FLIP is estimated from both anyway.
    [[nodiscard]] std::vector<TileErrors> all_errors() {
        if (target_.metric == ErrorMetric::flip) return fresh_errors();
        return tile_errors(state_.film, nullptr, target_);
    }
    /// True unless the last round shows that the error is above the target.
    [[nodiscard]] bool reaches_target() {
        return estimate_error(sum_of(fresh_errors()), target_.metric).low <= target_.error;
    }
    [[nodiscard]] bool round_is_complete() const { return state_.film.samples() == state_.round.ends; }
    [[nodiscard]] double pixels_of(std::size_t tile) const {
        return static_cast<double>(pixel_count(state_.film.grid().tile(tile)));
    }
    /// Pixels times samples.
    [[nodiscard]] double work_so_far() const {
        double work = 0;
        for (std::size_t i = 0; i < planned_.size(); ++i) work += pixels_of(i) * state_.film.samples(i);
        return work;
    }
    [[nodiscard]] double work_of(const std::vector<int>& ends) const {
        double work = 0;
        for (std::size_t i = 0; i < ends.size(); ++i) work += pixels_of(i) * (ends[i] - state_.film.samples(i));
        return work;
    }

    /// Renders the rest of the round: the tiles with the fewest samples first, part by part.
    void render(const std::shared_ptr<ResidentScene>& scene, const std::atomic<bool>& interrupted) {
        while (!interrupted) {
            int begin = job_.samples;
            for (std::size_t i = 0; i < planned_.size(); ++i) {
                if (planned_[i] < state_.round.ends[i]) begin = std::min(begin, planned_[i]);
            }
            if (begin == job_.samples) break;
            std::vector<bool> marked(planned_.size());
            for (std::size_t i = 0; i < planned_.size(); ++i) {
                marked[i] = planned_[i] == begin && begin < state_.round.ends[i];
            }
            render_part(scene, interrupted, marked, begin);
        }
        while (!flying_.empty()) take_oldest();
        if (interrupted && !round_is_complete()) save();
    }

    /// Renders the part that begins with the sample `begin`, for the marked tiles.
    void render_part(const std::shared_ptr<ResidentScene>& scene, const std::atomic<bool>& interrupted,
                     const std::vector<bool>& marked, int begin) {
        const int end = next_part_end(begin, job_.samples);
        RenderJob job = job_;
        job.first_sample = job_.first_sample + begin;
        job.samples = end - begin;
        const TileGrid& grid = state_.film.grid();
        const std::size_t most_pixels = most_window_samples / static_cast<std::size_t>(job.samples);
        for (const FilmWindow& window : cut(windows_of(grid, marked), grid.edge, most_pixels)) {
            if (flying_.size() >= backend_.frames_in_flight()) take_oldest();
            if (interrupted) return;
            job.window = window;
            flying_.push_back({window, begin, backend_.submit(scene, job)});
        }
        for (std::size_t i = 0; i < marked.size(); ++i) {
            if (marked[i]) planned_[i] = end;
        }
    }

    /// Cuts a window into its tiles, and adds them to the film.
    void take_oldest() {
        const Flying oldest = std::move(flying_.front());
        flying_.pop_front();
        const FilmWindow& window = oldest.window;
        const RenderResult part = oldest.pending->get();
        fresh_errors_.reset();
        tandem::add(stats_, part.stats);
        const TileGrid& grid = state_.film.grid();
        for (int top = window.top; top < window.top + window.height; top += grid.edge) {
            for (int left = window.left; left < window.left + window.width; left += grid.edge) {
                const std::size_t index =
                    static_cast<std::size_t>(top / grid.edge) * static_cast<std::size_t>(grid.columns()) +
                    static_cast<std::size_t>(left / grid.edge);
                const FilmWindow tile = grid.tile(index);
                const FilmWindow place{left - window.left, top - window.top, tile.width, tile.height};
                Film whole(tile.width, tile.height, part.film.samples(), state_.film.planes());
                copy_window(whole, 0, 0, part.film, place);
                state_.film.add(index, whole);
                Film judge(tile.width, tile.height, part.film.samples(), FilmPlane::variance);
                copy_window(judge, 0, 0, part.film, place);
                const int round = state_.round.begins[index];
                const bool is_new = round == 0 || (oldest.begin == round && !state_.round.was_last);
                if (is_new) {
                    state_.round.fresh[index] = std::move(judge);
                } else {
                    state_.round.fresh[index].add(judge);
                }
            }
        }
        if (since_save_.seconds() >= resumption_.every) save();
    }

    void save() {
        if (!resumption_.save) return;
        state_.round.seconds = clock_() - start_;
        resumption_.save(state_, stats_.counters);
        since_save_ = Stopwatch();
    }

    Backend& backend_;
    const RenderTarget& target_;
    const std::function<double()>& clock_;
    const Resumption& resumption_;
    RenderJob job_;
    PlaneMask wanted_;
    RoundState state_;
    std::vector<int> planned_;                             ///< by tile: the samples that the backend has been asked for
    std::optional<std::vector<TileErrors>> fresh_errors_;  ///< of the film as it is now, if they are known
    double start_;  ///< by the clock, as if all had been rendered without a pause
    RenderStats stats_;
    std::deque<Flying> flying_;
    Stopwatch since_save_;
};

}  // namespace

int target_tile_edge(int width, int height) {
    for (const int edge : {32, 16}) {
        if (TileGrid{width, height, edge}.count() >= 64) return edge;
    }
    return 8;
}

void check_still(const FramePlan& plan) {
    if (!is_blurred(plan)) return;
    throw InputError(
        "the frame has motion blur, whose samples are not independent, so its error cannot be estimated from them; "
        "render it with --spp, or without blur (--effects -motion_blur)");
}

const char* to_string(StoppedBy reason) {
    switch (reason) {
        case StoppedBy::target:
            return "target";
        case StoppedBy::samples:
            return "samples";
        case StoppedBy::time:
            return "time";
        case StoppedBy::interrupt:
            return "interrupt";
    }
    return "";
}

std::vector<TileErrors> tile_errors(const TiledFilm& film, const std::vector<Film>* fresh, const RenderTarget& target) {
    const DefaultFpEnvironment guard;
    std::vector<TileErrors> tiles(film.grid().count());
    if (target.metric == ErrorMetric::flip) {
        tiles = flip_errors(film, *fresh, target.display);
        look_around(tiles, film.grid());
        return tiles;
    }
    const double mean = mean_value(film);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const Film& tile = film.tile(i);
        tiles[i].errors = squared_errors(tile, fresh != nullptr ? (*fresh)[i] : tile, target.metric, mean);
        tiles[i].samples = film.samples(i);
    }
    look_around(tiles, film.grid());
    return tiles;
}

ErrorSums sum_of(const std::vector<TileErrors>& tiles) {
    ErrorSums sum;
    for (const TileErrors& tile : tiles) sum += tile.errors;
    return sum;
}

std::optional<TargetFrame> render_to_target(Backend& backend, const Scene& scene, const FramePlan& plan,
                                            const RenderTarget& target, const std::atomic<bool>& interrupted,
                                            const std::function<double()>& clock, const Resumption& resumption) {
    const DefaultFpEnvironment guard;
    check_still(plan);
    const FrameInstant& instant = plan.instants.front();
    check(target, instant.job);
    const Stopwatch watch;
    const PreparedScene prepared = prepare(scene, instant.prepare);
    const double seconds = watch.seconds();
    const auto resident = backend.load(prepared, instant.job.tier);
    Rounds rounds(backend, plan, target, clock, resumption);
    const StoppedBy reason = rounds.run(resident, interrupted);
    const bool is_saved = reason == StoppedBy::interrupt && resumption.save;
    if (is_saved || rounds.is_too_early()) return std::nullopt;
    TargetFrame result = rounds.result(reason);
    result.frame.load = resident->load_times();
    result.frame.prepare = seconds;
    RenderStats& stats = result.frame.result.stats;
    stats.effects |= plan.effects;
    stats.carried = stats.carried - stats.effects;
    return result;
}

}  // namespace tandem
