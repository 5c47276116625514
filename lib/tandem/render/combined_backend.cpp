#include "tandem/render/combined_backend.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <limits>
#include <mutex>
#include <new>
#include <numeric>
#include <optional>
#include <thread>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/base/seconds.h"
#include "tandem/render/division.h"

namespace tandem {

namespace {

/// Bands that a member holds at a time: while one is rendered, the film of another is downloaded.
constexpr std::size_t most_bands = 2;

/// Bands begin at multiples of so many rows, which is what a block of a GPU's threads covers.
constexpr std::size_t band_step = 8;

/// How many parts a member makes of its portion of what is left (part_size()). Bands are rendered two at a time, and
/// rows may differ much, so a band is a smaller part than one of rays, each of which is traced alone.
constexpr int band_steps = 4, ray_steps = 2;

constexpr double never = std::numeric_limits<double>::infinity();

/// The least part of rays is at least so small a part of what a member has of them.
constexpr std::size_t most_ray_parts = 16;

enum class Failure { input, environment, bug };

struct Caught {
    Failure kind = Failure::bug;
    std::string what;
};

Caught describe(const std::exception_ptr& error) {
    try {
        std::rethrow_exception(error);
    } catch (const InputError& input) {
        return {Failure::input, input.what()};
    } catch (const EnvironmentError& environment) {
        return {Failure::environment, environment.what()};
    } catch (const std::bad_alloc&) {
        return {Failure::environment, "not enough memory on this machine"};
    } catch (const std::exception& bug) {
        return {Failure::bug, bug.what()};
    } catch (...) {
        return {Failure::bug, "an unknown exception"};
    }
}

/// The time that a member takes for a unit, from what it has done; 0: not known yet.
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

class Crew;

class CombinedScene final : public ResidentScene {
  public:
    CombinedScene(Tier tier, std::size_t members, Crew& crew)
        : ResidentScene(tier), parts(members), sample_paces(members), ray_paces(members), crew_(crew) {}
    [[nodiscard]] PhaseTimes load_times() const override;

    // all guarded by the crew's mutex once the scene is loaded
    std::vector<std::shared_ptr<ResidentScene>> parts;  ///< of each member; null if it failed
    std::vector<Pace> sample_paces, ray_paces;

  private:
    Crew& crew_;
};

/// A frame in work. Guarded by the crew's mutex.
struct SharedFrame {
    SharedFrame(std::shared_ptr<CombinedScene> of, const RenderJob& asked, Film memory)
        : scene(std::move(of)),
          job(asked),
          window(window_of(asked)),
          film(std::move(memory)),
          rows(static_cast<std::size_t>(window.height), band_step) {}

    const std::shared_ptr<CombinedScene> scene;
    const RenderJob job;
    const FilmWindow window;
    Film film;
    Division rows;
    std::size_t bands = 0;  ///< that members hold
    RenderStats stats;
    double compile = 0;
    std::optional<Stopwatch> watch;  ///< since the first band
    bool is_done = false;
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

/// The members, their threads, and the queue of frames.
class Crew {
  public:
    Crew(std::vector<CombinedMember> members, const CombinedOptions& options) : options_(options) {
        if (members.empty()) throw InputError("a combined backend needs at least one member");
        for (CombinedMember& member : members) {
            members_.push_back(std::make_unique<Member>());
            members_.back()->name = std::move(member.name);
            members_.back()->backend = std::move(member.backend);
        }
        for (std::size_t i = 0; i < members_.size(); ++i) {
            members_[i]->thread = std::thread([this, i] { run(i); });
        }
    }
    ~Crew() {
        {
            const std::lock_guard lock(mutex_);
            stops_ = true;
        }
        wake_.notify_all();
        for (const auto& member : members_) member->thread.join();
    }
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
                if (error && describe(error).kind == Failure::input) {
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

    /// Calls f while nothing else changes.
    template <class F>
    auto locked(F f) {
        const std::lock_guard lock(mutex_);
        return f();
    }

    /// A film in the memory that the members fill fast, or in ordinary memory if there is none.
    [[nodiscard]] Film make_film(int width, int height, int samples, PlaneMask planes) {
        const std::size_t first = locked([&] {
            require_one();
            const auto works = [](const auto& member) { return !member->has_failed; };
            return static_cast<std::size_t>(std::find_if(members_.begin(), members_.end(), works) - members_.begin());
        });
        try {
            return backend(first).make_film(width, height, samples, planes);
        } catch (const std::exception&) {
            return {width, height, samples, planes};
        }
    }

    void submit(const std::shared_ptr<SharedFrame>& frame) {
        const std::lock_guard lock(mutex_);
        require_one();
        queue_.push_back(frame);
        wake_.notify_all();
    }
    [[nodiscard]] RenderResult wait_for(SharedFrame& frame) {
        std::unique_lock lock(mutex_);
        settled_.wait(lock, [&] { return frame.is_done; });
        if (frame.error) std::rethrow_exception(frame.error);
        return {std::move(frame.film), std::move(frame.stats)};
    }
    /// Renders no more bands of a frame that nobody waits for.
    void cancel(SharedFrame& frame) {
        const std::lock_guard lock(mutex_);
        frame.is_done = true;
        std::erase_if(queue_, [&](const auto& other) { return other.get() == &frame; });
    }

    /// Takes rays for a member, of `all` that there were. Nothing if none are left.
    [[nodiscard]] std::optional<Division::Part> take_rays(const CombinedScene& scene, std::size_t member,
                                                          std::size_t all, Division& rays) {
        const std::size_t least = std::max(options_.least_rays, all / (most_ray_parts * members_.size()));
        const std::vector<Worker> crew = workers(scene.ray_paces, 1);
        const double portion = fair_portion(crew, member, rays.left());
        const auto part = rays.take(size_of_part(portion, crew[member].pace, ray_steps, least));
        if (part) members_[member]->free_at = clock_.seconds() + crew[member].pace * static_cast<double>(part->count);
        return part;
    }
    void count_rays(std::size_t member, std::size_t rays) {
        members_[member]->rays += rays;
        members_[member]->free_at = 0;
    }

    [[nodiscard]] std::vector<MemberWork> works() {
        const std::lock_guard lock(mutex_);
        std::vector<MemberWork> works;
        for (const auto& member : members_) {
            works.push_back({member->name, {}, member->samples, member->rays, member->failure});
        }
        return works;
    }

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
    void run(std::size_t index) {
        Member& member = *members_[index];
        std::unique_lock lock(mutex_);
        while (true) {
            wake_.wait(lock,
                       [&] { return stops_ || !member.tasks.empty() || !member.bands.empty() || has_band_for(index); });
            if (!member.tasks.empty()) {
                const std::function<void()> task = std::move(member.tasks.front());
                member.tasks.pop_front();
                lock.unlock();
                task();
                lock.lock();
                member.busy = Stopwatch();
            } else if (!stops_ && member.bands.size() < most_bands && has_band_for(index)) {
                start(index, take_band(index), lock);
            } else if (!member.bands.empty()) {
                finish(index, lock);
            } else if (stops_) {
                return;
            }
        }
    }

    [[nodiscard]] bool has_band_for(std::size_t index) const {
        return !members_[index]->has_failed && !queue_.empty();  // a member that works has a part of every scene
    }

    [[nodiscard]] Band take_band(std::size_t index) {
        const std::shared_ptr<SharedFrame> frame = queue_.front();
        const double samples_of_row = static_cast<double>(frame->window.width) * frame->job.samples;
        const std::size_t least_rows = options_.least_pixels / static_cast<std::size_t>(frame->window.width);
        std::vector<Worker> crew = workers(frame->scene->sample_paces, samples_of_row);
        for (Worker& worker : crew)
            worker.busy = worker.busy < never ? 0 : never;  // each has two bands, and takes the next when one is done
        const double portion = fair_portion(crew, index, frame->rows.left());
        Band band{frame, frame->rows.take(size_of_part(portion, crew[index].pace, band_steps, least_rows)).value()};
        if (frame->rows.is_empty()) queue_.pop_front();
        ++frame->bands;
        if (!frame->watch) frame->watch.emplace();
        return band;
    }

    /// The members; those that have failed are busy for ever. `units`: how many of those that the paces count make one.
    [[nodiscard]] std::vector<Worker> workers(const std::vector<Pace>& paces, double units) const {
        std::vector<Worker> workers;
        const double now = clock_.seconds();
        for (std::size_t i = 0; i < paces.size(); ++i) {
            const bool failed = members_[i]->has_failed;
            workers.push_back({paces[i].get() * units, failed ? never : std::max(0.0, members_[i]->free_at - now)});
        }
        return workers;
    }

    [[nodiscard]] std::size_t size_of_part(double portion, double pace, int steps, std::size_t least) const {
        if (pace > 0) least = std::max(least, static_cast<std::size_t>(options_.least_seconds / pace));
        return part_size(portion, steps, pace > 0, least);
    }

    void start(std::size_t index, Band band, std::unique_lock<std::mutex>& lock) {
        Member& member = *members_[index];
        if (member.bands.empty()) member.busy = Stopwatch();
        const SharedFrame& frame = *band.frame;
        const std::shared_ptr<ResidentScene> part = frame.scene->parts[index];
        lock.unlock();
        std::exception_ptr error;
        try {
            band.pending =
                member.backend->submit_to(frame.film, 0, static_cast<int>(band.rows.first), part, band.job());
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        member.bands.push_back(std::move(band));
        if (error) fail(index, member.bands.size() - 1, error);
    }

    void finish(std::size_t index, std::unique_lock<std::mutex>& lock) {
        Member& member = *members_[index];
        Band& band = member.bands.front();
        lock.unlock();
        RenderResult result;
        std::exception_ptr error;
        try {
            result = band.pending->get();
        } catch (...) {
            error = std::current_exception();
        }
        band.pending.reset();
        lock.lock();
        if (error) return fail(index, 0, error);
        SharedFrame& frame = *band.frame;
        const double seconds = std::exchange(member.busy, Stopwatch()).seconds();
        frame.scene->sample_paces[index].add(band.samples(), seconds - result.stats.seconds.compile);
        frame.compile = std::max(frame.compile, result.stats.seconds.compile);
        add(frame.stats, result.stats);
        member.samples += static_cast<std::uint64_t>(band.samples());
        const Band done = std::move(band);
        member.bands.pop_front();
        settle(*done.frame);
    }

    /// A member no longer holds a band of the frame.
    void settle(SharedFrame& frame) {
        --frame.bands;
        if (frame.bands > 0 || !frame.rows.is_empty() || frame.is_done) return;
        frame.stats.seconds = {};
        frame.stats.seconds.compile = frame.compile;
        frame.stats.seconds.render = std::max(frame.watch->seconds() - frame.compile, 0.0);
        for (const std::string& warning : std::exchange(warnings_, {})) {
            frame.stats.warning += (frame.stats.warning.empty() ? "" : "; ") + warning;
        }
        frame.is_done = true;
        settled_.notify_all();
    }

    /// What happens if a member's band number `which` throws.
    void fail(std::size_t index, std::size_t which, const std::exception_ptr& error) {
        Member& member = *members_[index];
        if (describe(error).kind != Failure::input) return leave_out(index, error);
        const Band band = std::move(member.bands[which]);
        member.bands.erase(member.bands.begin() + static_cast<std::ptrdiff_t>(which));
        --band.frame->bands;
        end_with(*band.frame, error);
    }

    void end_with(SharedFrame& frame, const std::exception_ptr& error) {
        std::erase_if(queue_, [&](const auto& other) { return other.get() == &frame; });
        if (frame.is_done) return;
        frame.error = error;
        frame.is_done = true;
        settled_.notify_all();
    }

    /// Gives the member nothing more to do, and what it holds to the others.
    void leave_out(std::size_t index, const std::exception_ptr& error) {
        Member& member = *members_[index];
        if (std::exchange(member.has_failed, true)) return;
        const Caught caught = describe(error);
        member.has_bug = caught.kind == Failure::bug;
        member.failure = caught.what;
        while (!member.bands.empty()) {
            Band band = std::move(member.bands.back());
            member.bands.pop_back();
            band.pending.reset();  // a GPU stops writing to the film before others do it again
            --band.frame->bands;
            if (band.frame->is_done) continue;
            band.frame->rows.give_back(band.rows);
            if (std::find(queue_.begin(), queue_.end(), band.frame) == queue_.end()) queue_.push_front(band.frame);
        }
        if (works_nobody()) {
            const std::exception_ptr all = all_failures();
            while (!queue_.empty()) end_with(*std::shared_ptr(queue_.front()), all);
        } else {
            const std::string sentence =
                fmt::format("{} failed and is left out; the others do its work: {}", member.name, member.failure);
            warnings_.push_back(sentence);
            if (options_.report) options_.report(sentence);
        }
        wake_.notify_all();
    }

    [[nodiscard]] bool works_nobody() const {
        return std::all_of(members_.begin(), members_.end(), [](const auto& member) { return member->has_failed; });
    }
    void require_one() const {
        if (works_nobody()) std::rethrow_exception(all_failures());
    }
    [[nodiscard]] std::exception_ptr all_failures() const {
        std::vector<std::string> failures;
        bool has_bug = false;
        for (const auto& member : members_) {
            failures.push_back(fmt::format("{}: {}", member->name, member->failure));
            has_bug = has_bug || member->has_bug;
        }
        const std::string text =
            members_.size() == 1 ? failures.front() : fmt::format("all failed. {}", fmt::join(failures, ". "));
        if (has_bug) return std::make_exception_ptr(std::runtime_error(text));
        return std::make_exception_ptr(EnvironmentError(text));
    }

    CombinedOptions options_;
    Stopwatch clock_;
    std::vector<std::unique_ptr<Member>> members_;
    std::mutex mutex_;  ///< of everything below, and of what says so
    std::condition_variable wake_, settled_;
    std::deque<std::shared_ptr<SharedFrame>> queue_;  ///< frames with rows that nobody has taken
    std::vector<std::string> warnings_;               ///< for the next frame that is done
    bool stops_ = false;
};

PhaseTimes longest(PhaseTimes a, const PhaseTimes& b) {
    a.build = std::max(a.build, b.build);
    a.compile = std::max(a.compile, b.compile);
    a.upload = std::max(a.upload, b.upload);
    a.render = std::max(a.render, b.render);
    a.download = std::max(a.download, b.download);
    return a;
}

PhaseTimes CombinedScene::load_times() const {
    std::vector<PhaseTimes> times(parts.size());
    crew_.on_all([&](std::size_t member) {
        if (parts[member]) times[member] = parts[member]->load_times();
    });
    return std::accumulate(times.begin(), times.end(), PhaseTimes{}, longest);
}

class CombinedFrame final : public PendingFrame {
  public:
    CombinedFrame(Crew& crew, std::shared_ptr<SharedFrame> frame) : crew_(crew), frame_(std::move(frame)) {}
    ~CombinedFrame() override { crew_.cancel(*frame_); }
    RenderResult get() override { return crew_.wait_for(*frame_); }

  private:
    Crew& crew_;
    std::shared_ptr<SharedFrame> frame_;
};

class CombinedBackend final : public Backend {
  public:
    CombinedBackend(std::vector<CombinedMember> members, const CombinedOptions& options)
        : crew_(std::move(members), options) {
        for (std::size_t i = 0; i < crew_.size(); ++i) own_.push_back(crew_.backend(i).capabilities());
    }

    [[nodiscard]] std::string name() const override { return crew_.backend(0).name(); }

    [[nodiscard]] Capabilities capabilities() const override {
        Capabilities all;
        all.members = crew_.works();
        all.description = own_.front().description;
        for (std::size_t i = 0; i < own_.size(); ++i) {
            MemberWork& work = all.members[i];
            work.device = own_[i].device;
            all.device += fmt::format("{}{}: {}", i == 0 ? "" : "; ", work.name, work.device);
            all.exact = all.exact && own_[i].exact;
        }
        return all;
    }

    [[nodiscard]] std::shared_ptr<ResidentScene> load(const PreparedScene& scene, Tier tier) override {
        auto result = std::make_shared<CombinedScene>(tier, crew_.size(), crew_);
        crew_.on_all([&](std::size_t member) {
            auto part = crew_.backend(member).load(scene, tier);
            crew_.locked([&] { result->parts[member] = std::move(part); });
        });
        return result;
    }

    double trace(ResidentScene& scene, const TraceJob& job) override {
        check(job);
        auto& combined = dynamic_cast<CombinedScene&>(scene);
        Division rays(job.rays.size());
        std::vector<double> seconds(crew_.size());
        // again if a member fails when others are done already
        while (!rays.is_empty()) {
            crew_.on_all([&](std::size_t member) { trace_parts(combined, job, member, rays, seconds[member]); });
        }
        return *std::max_element(seconds.begin(), seconds.end());
    }

    [[nodiscard]] std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                       const RenderJob& job) override {
        check(job, scene->tier());
        auto& combined = dynamic_cast<CombinedScene&>(*scene);
        const FilmWindow window = window_of(job);
        auto frame =
            std::make_shared<SharedFrame>(std::shared_ptr<CombinedScene>(std::move(scene), &combined), job,
                                          crew_.make_film(window.width, window.height, job.samples, job.planes));
        crew_.submit(frame);
        return std::make_unique<CombinedFrame>(crew_, std::move(frame));
    }

    [[nodiscard]] Film make_film(int width, int height, int samples, PlaneMask planes) override {
        return crew_.make_film(width, height, samples, planes);
    }

    [[nodiscard]] std::size_t frames_in_flight() const override {
        std::size_t frames = 0;
        for (std::size_t i = 0; i < crew_.size(); ++i) frames += crew_.backend(i).frames_in_flight();
        return frames;
    }

  private:
    /// Traces parts of the rays with a member until none are left.
    void trace_parts(CombinedScene& scene, const TraceJob& job, std::size_t member, Division& rays, double& seconds) {
        while (true) {
            const std::optional<Division::Part> part =
                crew_.locked([&] { return crew_.take_rays(scene, member, job.rays.size(), rays); });
            if (!part) return;
            RenderCounters counters;
            TraceJob own = tandem::part(job, part->first, part->count);
            own.counters = &counters;
            const Stopwatch watch;
            try {
                seconds += crew_.backend(member).trace(*scene.parts[member], own);
            } catch (...) {
                crew_.locked([&] { rays.give_back(*part); });
                throw;
            }
            crew_.locked([&] {
                scene.ray_paces[member].add(static_cast<double>(part->count), watch.seconds());
                crew_.count_rays(member, part->count);
                if (job.counters != nullptr) *job.counters += counters;
            });
        }
    }

    mutable Crew crew_;
    std::vector<Capabilities> own_;  ///< of the members
};

}  // namespace

std::unique_ptr<Backend> make_combined_backend(std::vector<CombinedMember> members, const CombinedOptions& options) {
    return std::make_unique<CombinedBackend>(std::move(members), options);
}

}  // namespace tandem
