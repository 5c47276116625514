/// How a combined backend (combined_backend.h) works: the threads of its members, and the queue of frames.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tandem/base/seconds.h"
#include "tandem/render/combined_backend.h"
#include "tandem/render/division.h"

namespace tandem {

/// Bands begin at multiples of this number of rows: a block of GPU threads covers as many.
inline constexpr std::size_t band_step = 8;

/// The time that a member takes for a unit of work, measured on what it has done; 0 before that.
class Pace {
  public:
    void add(double units, double seconds) {
        if (!(units > 0) || !(seconds > 0)) return;
        const double now = seconds / units;
        seconds_per_unit_ = seconds_per_unit_ > 0 ? 0.5 * (seconds_per_unit_ + now) : now;
    }
    [[nodiscard]] double get() const { return seconds_per_unit_; }

  private:
    double seconds_per_unit_ = 0;
};

/// The same over all of its work, because parts differ: the last rows of a frame say little about others.
class MeanPace {
  public:
    void add(double units, double seconds) {
        if (!(units > 0) || !(seconds > 0)) return;
        units_ += units;
        seconds_ += seconds;
    }
    /// From now on, the measurements so far have half their weight.
    void fade() { units_ *= 0.5, seconds_ *= 0.5; }
    [[nodiscard]] double get() const { return units_ > 0 ? seconds_ / units_ : 0; }

  private:
    double units_ = 0, seconds_ = 0;
};

class Crew;

class CombinedScene final : public ResidentScene {
  public:
    CombinedScene(Tier tier, std::size_t members, Crew& crew)
        : ResidentScene(tier), parts(members), sample_paces(members), ray_paces(members), crew_(crew) {}
    [[nodiscard]] PhaseTimes load_times() const override;

    // all guarded by the crew's mutex once the scene is loaded
    std::vector<std::shared_ptr<ResidentScene>> parts;  ///< of each member; null if it failed
    std::vector<MeanPace> sample_paces;
    std::vector<Pace> ray_paces;
    bool waits_for_downloads = false;  ///< most of the time, in the last frame

  private:
    Crew& crew_;
};

/// A frame that members are rendering. Guarded by the crew's mutex.
struct SharedFrame {
    SharedFrame(std::shared_ptr<CombinedScene> of, const RenderJob& asked, Film memory)
        : scene(std::move(of)),
          job(asked),
          window(window_of(asked)),
          film(std::move(memory)),
          rows(static_cast<std::size_t>(window.height), band_step),
          last_rows(scene->parts.size()) {}

    const std::shared_ptr<CombinedScene> scene;
    const RenderJob job;
    const FilmWindow window;
    Film film;
    Division rows;
    std::vector<std::size_t> last_rows;  ///< of the last band of each member
    std::size_t bands = 0;               ///< held by members now
    RenderStats stats;
    double compile = 0;
    double band_seconds = 0, download_seconds = 0;  ///< of all bands; the second is a part of the first
    std::optional<Stopwatch> watch;                 ///< since the first band
    std::atomic<bool> is_done = false;              ///< may be read without the mutex
    std::exception_ptr error;
};

/// Rows of a frame that a member renders.
struct Band {
    std::shared_ptr<SharedFrame> frame;
    Division::Part rows;
    std::unique_ptr<PendingFrame> pending{};

    [[nodiscard]] double samples() const {
        return static_cast<double>(rows.count) * frame->window.width * frame->job.samples;
    }
    [[nodiscard]] RenderJob job() const {
        RenderJob part = frame->job;
        part.window = FilmWindow{frame->window.left, frame->window.top + static_cast<int>(rows.first),
                                 frame->window.width, static_cast<int>(rows.count)};
        return part;
    }
};

/// Whether it is an InputError, which says that the scene or the job is wrong.
[[nodiscard]] bool is_wrong_input(const std::exception_ptr& error);

class Crew {
  public:
    /// Throws InputError if there is no member.
    Crew(std::vector<CombinedMember> members, const CombinedOptions& options);
    ~Crew();
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

    [[nodiscard]] std::size_t size() const { return members_.size(); }
    [[nodiscard]] Backend& backend(std::size_t member) const { return *members_[member]->backend; }

    /// Calls work(member) in the thread of each member that works, and waits. A member that throws is left out. Throws
    /// an InputError of any of them, or, if no member is left, their failures.
    template <class Work>
    void on_all(Work work) {
        std::unique_lock lock(mutex_);
        std::size_t open = 0;
        std::exception_ptr wrong_input;
        for (std::size_t i = 0; i < members_.size(); ++i) {
            if (members_[i]->has_failed) continue;
            ++open;
            members_[i]->tasks.emplace_back([&, i] {
                std::exception_ptr error;
                try {
                    work(i);
                } catch (...) {
                    error = std::current_exception();
                }
                const std::lock_guard guard(mutex_);
                if (error && is_wrong_input(error)) {
                    wrong_input = error;
                } else if (error) {
                    leave_out(i, error);
                }
                --open;
                settled_.notify_all();
            });
        }
        wake_.notify_all();
        settled_.wait(lock, [&] { return open == 0; });
        if (wrong_input) std::rethrow_exception(wrong_input);
        require_one();
    }

    /// Calls f with the mutex locked.
    template <class F>
    auto locked(F f) {
        const std::lock_guard lock(mutex_);
        return f();
    }

    /// A film in the memory that the members fill fast, or in ordinary memory if there is none.
    [[nodiscard]] Film make_film(int width, int height, int samples, PlaneMask planes);

    void submit(const std::shared_ptr<SharedFrame>& frame);
    [[nodiscard]] RenderResult wait_for(SharedFrame& frame);
    /// Renders no more bands of a frame whose result is no longer wanted.
    void cancel(SharedFrame& frame);

    // While locked():
    /// Takes a part of the rays for a member. `all`: how many there were at first. Nothing if none are left.
    [[nodiscard]] std::optional<Division::Part> take_rays(const CombinedScene& scene, std::size_t member,
                                                          std::size_t all, Division& rays);
    void count_rays(std::size_t member, std::size_t rays);

    [[nodiscard]] std::vector<MemberWork> works();

  private:
    struct Member {
        std::string name;
        std::unique_ptr<Backend> backend;
        std::thread thread;
        std::deque<std::function<void()>> tasks;
        std::deque<Band> bands;  ///< submitted; only its own thread changes them
        Stopwatch busy;          ///< since it began with the oldest of them
        double free_at = 0;      ///< by clock_, when it will have traced the rays that it took
        std::uint64_t samples = 0, rays = 0;
        bool has_failed = false;
        bool has_bug = false;
        std::string failure;
    };

    /// A member's thread.
    void run(std::size_t index);

    [[nodiscard]] bool has_band_for(std::size_t index) const;
    [[nodiscard]] Band take_band(std::size_t index);
    /// The members as workers; those that have failed are busy for ever. A worker's unit is `units` of the paces'
    /// units.
    template <class Paces>
    [[nodiscard]] std::vector<Worker> workers(const Paces& paces, double units) const;
    [[nodiscard]] std::size_t size_of_part(double portion, double pace, int steps, std::size_t least) const;

    void start(std::size_t index, Band band, std::unique_lock<std::mutex>& lock);
    void finish(std::size_t index, std::unique_lock<std::mutex>& lock);
    /// A member no longer holds a band of the frame.
    void settle(SharedFrame& frame);
    /// Handles a failure of a member's band number `which`.
    void fail(std::size_t index, std::size_t which, const std::exception_ptr& error);
    void end_with(SharedFrame& frame, const std::exception_ptr& error);
    /// Gives the member no more work, and gives its bands to the others.
    void leave_out(std::size_t index, const std::exception_ptr& error);

    [[nodiscard]] bool works_nobody() const;
    void require_one() const;
    [[nodiscard]] std::exception_ptr all_failures() const;

    CombinedOptions options_;
    Stopwatch clock_;
    std::vector<std::unique_ptr<Member>> members_;
    std::mutex mutex_;  ///< guards everything below, and what the comments above say
    std::condition_variable wake_, settled_;
    std::deque<std::shared_ptr<SharedFrame>> queue_;  ///< frames with rows that nobody has taken
    std::vector<std::string> warnings_;               ///< for the next frame that is done
    bool stops_ = false;
};

}  // namespace tandem
