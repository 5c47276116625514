#include "tandem/render/adaptive_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "tandem/base/error.h"
#include "tandem/base/seconds.h"
#include "tandem/math/fp_environment.h"
#include "tandem/render/sampler_names.h"
#include "tandem/render/tile_windows.h"
#include "tandem/render/tiled_film.h"

namespace tandem {

namespace {

constexpr std::size_t most_in_flight = 2;

class Rounds {
  public:
    Rounds(Backend& backend, const FramePlan& plan, const RenderTarget& target)
        : backend_(backend),
          target_(target),
          job_(plan.instants.front().job),
          wanted_(job_.planes),
          film_({job_.width, job_.height, target_tile_edge}, wanted_ | FilmPlane::variance),
          goes_on_(film_.grid().count(), true),
          is_last_(film_.grid().count(), false),
          errors_(film_.grid().count()),
          total_(job_.samples) {
        job_.planes |= FilmPlane::variance;
    }
    ~Rounds() {
        // Only after an exception: waits for the windows that the backend still renders.
        for (const auto& window : flying_) {
            try {
                (void)window.second->get();
            } catch (...) {
            }
        }
    }
    Rounds(const Rounds&) = delete;
    Rounds& operator=(const Rounds&) = delete;

    /// Renders rounds until one of the reasons to stop.
    StoppedBy run(const std::shared_ptr<ResidentScene>& scene, const std::atomic<bool>& interrupted,
                  const std::function<double()>& clock) {
        const double start = clock();
        double sampled = 0;  // pixels times samples
        while (true) {
            if (std::find(goes_on_.begin(), goes_on_.end(), true) == goes_on_.end()) return StoppedBy::target;
            if (samples_ == total_) return StoppedBy::samples;
            if (interrupted) return StoppedBy::interrupt;
            const int end = next_round_end(samples_, total_);
            const double next = pixels_that_go_on() * (end - samples_);
            const double elapsed = clock() - start;
            if (samples_ > 0 && elapsed + elapsed / sampled * next > target_.seconds) return StoppedBy::time;
            render(scene, end);
            sampled += next;
        }
    }

    [[nodiscard]] bool is_empty() const { return samples_ == 0; }
    [[nodiscard]] TargetFrame result(StoppedBy reason) {
        SquaredErrors all;
        for (const SquaredErrors& tile : errors_) all += tile;
        double samples = 0;
        for (std::size_t i = 0; i < film_.grid().count(); ++i) {
            samples += static_cast<double>(pixel_count(film_.grid().tile(i))) * film_.samples(i);
        }
        TargetFrame frame;
        frame.frame.result = {film_.whole(wanted_), std::move(stats_)};
        frame.error = estimate_error(all, target_.metric);
        frame.stopped_by = reason;
        frame.tile_samples = tile_samples_text(film_.grid().edge, film_.samples());
        frame.mean_samples = samples / all.pixels;
        return frame;
    }

  private:
    [[nodiscard]] double pixels_that_go_on() const {
        double pixels = 0;
        for (std::size_t i = 0; i < goes_on_.size(); ++i) {
            if (goes_on_[i]) pixels += static_cast<double>(pixel_count(film_.grid().tile(i)));
        }
        return pixels;
    }

    /// A round: the tiles that go on get samples up to number `end`.
    void render(const std::shared_ptr<ResidentScene>& scene, int end) {
        RenderJob job = job_;
        job.first_sample = job_.first_sample + samples_;
        job.samples = end - samples_;
        fresh_.assign(goes_on_.size(), Film());
        for (const FilmWindow& window : windows_of(film_.grid(), goes_on_)) {
            if (flying_.size() == most_in_flight) take_oldest();
            job.window = window;
            flying_.emplace_back(window, backend_.submit(scene, job));
        }
        while (!flying_.empty()) take_oldest();
        if (samples_ == 0) film_mean_ = mean_value(film_.whole({}));
        samples_ = end;
        const double growth = std::min(2.0, static_cast<double>(total_) / end);
        for (std::size_t i = 0; i < goes_on_.size(); ++i) {
            if (!goes_on_[i]) continue;
            errors_[i] = squared_errors(film_.tile(i), fresh_[i], target_.metric, film_mean_);
            if (is_last_[i]) {
                goes_on_[i] = false;
            } else if (target_.error > 0 && growth > 1) {
                is_last_[i] = will_reach(errors_[i], target_, growth);
            }
        }
        fresh_.clear();
    }

    /// Cuts a window into the fresh films of its tiles, and adds them to the tiles.
    void take_oldest() {
        const auto [window, pending] = std::move(flying_.front());
        flying_.pop_front();
        const RenderResult part = pending->get();
        tandem::add(stats_, part.stats);
        const TileGrid& grid = film_.grid();
        for (int top = window.top; top < window.top + window.height; top += grid.edge) {
            for (int left = window.left; left < window.left + window.width; left += grid.edge) {
                const std::size_t index =
                    static_cast<std::size_t>(top / grid.edge) * static_cast<std::size_t>(grid.columns()) +
                    static_cast<std::size_t>(left / grid.edge);
                const FilmWindow tile = grid.tile(index);
                Film fresh(tile.width, tile.height, part.film.samples(), film_.planes());
                copy_window(fresh, 0, 0, part.film, {left - window.left, top - window.top, tile.width, tile.height});
                film_.add(index, fresh);
                fresh_[index] = std::move(fresh);
            }
        }
    }

    Backend& backend_;
    const RenderTarget& target_;
    RenderJob job_;
    PlaneMask wanted_;
    TiledFilm film_;
    std::vector<bool> goes_on_;          ///< the tiles of the next round
    std::vector<bool> is_last_;          ///< of them, those for which it is the last
    std::vector<SquaredErrors> errors_;  ///< of each tile, from its last round so far
    std::vector<Film> fresh_;            ///< of each tile, during a round
    int total_;                          ///< the most samples
    int samples_ = 0;                    ///< of the tiles that go on
    double film_mean_ = 0;               ///< after the first round
    RenderStats stats_;
    std::deque<std::pair<FilmWindow, std::unique_ptr<PendingFrame>>> flying_;
};

}  // namespace

void check(const RenderTarget& target, const RenderJob& job) {
    if (!(target.error >= 0) || !std::isfinite(target.error)) {
        throw InputError(fmt::format("the target of the error is {}, but must be a number above 0", target.error));
    }
    if (!(target.seconds > 0)) {
        throw InputError(fmt::format("the time budget is {} s, but must be above 0", target.seconds));
    }
    if (job.samples < 2 && !to_string(target).empty()) {
        throw InputError("one sample per pixel has no variance; allow 2 or more (--spp) for a target of error or time");
    }
    if (job.sampler != Sampler::random && !to_string(target).empty()) {
        throw InputError(
            fmt::format("a target of error or time estimates errors from independent samples, but those of the sampler "
                        "'{}' are not independent; use --sampler random",
                        to_string(job.sampler)));
    }
    if (job.window) throw InputError("a target of error or time needs the whole film, not a window");
}

void check_still(const FramePlan& plan) {
    if (!is_blurred(plan)) return;
    throw InputError(
        "the frame has motion blur, whose samples are not independent, so its error cannot be estimated from them; "
        "render it with --spp, or without blur (--effects -motion_blur)");
}

std::string to_string(const RenderTarget& target) {
    std::string text;
    if (target.error > 0) text = fmt::format("{} {}", to_string(target.metric), target.error);
    if (std::isfinite(target.seconds)) text += fmt::format("{}within {} s", text.empty() ? "" : " ", target.seconds);
    return text;
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

int next_round_end(int samples, int most) {
    if (samples == 0) return std::min(target_first_round, most);
    return static_cast<int>(std::min<std::int64_t>(2 * std::int64_t{samples}, most));
}

bool will_reach(const SquaredErrors& errors, const RenderTarget& target, double factor) {
    return upper_mean(errors) <= factor * mean_of_target(target.error, target.metric);
}

double mean_value(const Film& film) {
    const DefaultFpEnvironment guard;
    const auto sums = film.sums();
    const double sum = std::accumulate(sums.begin(), sums.end(), 0.0,
                                       [](double total, const Vec3d& c) { return total + (c.x + c.y + c.z); });
    return sum / (3.0 * film.samples() * static_cast<double>(film.pixel_count()));
}

std::optional<TargetFrame> render_to_target(Backend& backend, const Scene& scene, const FramePlan& plan,
                                            const RenderTarget& target, const std::atomic<bool>& interrupted,
                                            const std::function<double()>& clock) {
    const DefaultFpEnvironment guard;
    check_still(plan);
    const FrameInstant& instant = plan.instants.front();
    check(target, instant.job);
    const Stopwatch watch;
    const PreparedScene prepared = prepare(scene, instant.prepare);
    const double seconds = watch.seconds();
    const auto resident = backend.load(prepared, instant.job.tier);
    Rounds rounds(backend, plan, target);
    const StoppedBy reason = rounds.run(resident, interrupted, clock);
    if (rounds.is_empty()) return std::nullopt;
    TargetFrame result = rounds.result(reason);
    result.frame.load = resident->load_times();
    result.frame.prepare = seconds;
    RenderStats& stats = result.frame.result.stats;
    stats.effects |= plan.effects;
    stats.carried = stats.carried - stats.effects;
    return result;
}

}  // namespace tandem
