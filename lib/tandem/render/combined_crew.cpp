#include "tandem/render/combined_crew.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <new>
#include <stdexcept>

#include "tandem/base/error.h"

namespace tandem {

namespace {

/// Bands that a member holds at a time: the film of one is downloaded, another is rendered, and a third fills the
/// multiprocessors that the last pixels of the second leave idle, without a pause in which this thread submits it.
constexpr std::size_t most_bands = 3;

/// The number of parts into which a member divides its portion of the remaining rows or rays (part_size()).
constexpr int steps = 2;

/// A band has at most a member's share of the frame's rows, divided by this: rows may differ much in cost.
constexpr double most_of_share = 8;

/// If downloads take more than this share of the time, a frame waits for them. Then a member's first band is its share
/// of the frame over `first_of_share`, so that the first download starts soon, and a band has at most `growth` times
/// the rows of the one before, so that it is rendered before that one is downloaded.
constexpr double most_downloading = 0.5, first_of_share = 16, growth = 1.5;

/// wait_for() polls for the end of a frame whose last rows have been taken. After this time, in seconds, it sleeps: a
/// thread takes 0.05 to 0.1 ms to wake up.
constexpr double most_looking = 2e-3;

constexpr double forever = std::numeric_limits<double>::infinity();

/// The least size of a part of rays: a member's equal share of all rays, divided by this, if that is large enough.
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

}  // namespace

bool is_wrong_input(const std::exception_ptr& error) { return describe(error).kind == Failure::input; }

Crew::Crew(std::vector<CombinedMember> members, const CombinedOptions& options) : options_(options) {
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

Crew::~Crew() {
    {
        const std::lock_guard lock(mutex_);
        stops_ = true;
    }
    wake_.notify_all();
    for (const auto& member : members_) member->thread.join();
}

Film Crew::make_film(int width, int height, int samples, PlaneMask planes) {
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

void Crew::submit(const std::shared_ptr<SharedFrame>& frame) {
    const std::lock_guard lock(mutex_);
    require_one();
    queue_.push_back(frame);
    wake_.notify_all();
}

RenderResult Crew::wait_for(SharedFrame& frame) {
    std::unique_lock lock(mutex_);
    settled_.wait(lock, [&] { return frame.is_done || frame.rows.is_empty(); });
    if (!frame.is_done) {
        lock.unlock();
        const Stopwatch watch;
        while (!frame.is_done && watch.seconds() < most_looking) std::this_thread::yield();
        lock.lock();
        settled_.wait(lock, [&] { return frame.is_done.load(); });
    }
    if (frame.error) std::rethrow_exception(frame.error);
    return {std::move(frame.film), std::move(frame.stats)};
}

void Crew::cancel(SharedFrame& frame) {
    const std::lock_guard lock(mutex_);
    frame.is_done = true;
    std::erase_if(queue_, [&](const auto& other) { return other.get() == &frame; });
}

template <class Paces>
std::vector<Worker> Crew::workers(const Paces& paces, double units) const {
    std::vector<Worker> workers;
    const double now = clock_.seconds();
    for (std::size_t i = 0; i < paces.size(); ++i) {
        const bool failed = members_[i]->has_failed;
        workers.push_back({paces[i].get() * units, failed ? forever : std::max(0.0, members_[i]->free_at - now)});
    }
    return workers;
}

std::optional<Division::Part> Crew::take_rays(const CombinedScene& scene, std::size_t member, std::size_t all,
                                              Division& rays) {
    const std::size_t least = std::max(options_.least_rays, all / (most_ray_parts * members_.size()));
    const std::vector<Worker> crew = workers(scene.ray_paces, 1);
    const double portion = fair_portion(crew, member, rays.left());
    const auto part = rays.take(size_of_part(portion, crew[member].pace, steps, least));
    if (part) members_[member]->free_at = clock_.seconds() + crew[member].pace * static_cast<double>(part->count);
    return part;
}

void Crew::count_rays(std::size_t member, std::size_t rays) {
    members_[member]->rays += rays;
    members_[member]->free_at = 0;
}

std::vector<MemberWork> Crew::works() {
    const std::lock_guard lock(mutex_);
    std::vector<MemberWork> works;
    for (const auto& member : members_) {
        works.push_back({member->name, {}, member->samples, member->rays, member->failure});
    }
    return works;
}

void Crew::run(std::size_t index) {
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

bool Crew::has_band_for(std::size_t index) const {
    return !members_[index]->has_failed && !queue_.empty();  // a member that works has a part of every scene
}

Band Crew::take_band(std::size_t index) {
    const std::shared_ptr<SharedFrame> frame = queue_.front();
    const double samples_of_row = static_cast<double>(frame->window.width) * frame->job.samples;
    const std::size_t least_rows = options_.least_pixels / static_cast<std::size_t>(frame->window.width);
    std::vector<Worker> crew = workers(frame->scene->sample_paces, samples_of_row);
    level(crew);
    for (Worker& worker : crew)
        worker.busy = worker.busy < forever ? 0 : forever;  // each has bands, and takes the next when one is done
    const double portion = fair_portion(crew, index, frame->rows.left());
    const double share = fair_portion(crew, index, static_cast<std::size_t>(frame->window.height));
    double most_rows = share / most_of_share;
    if (frame->scene->waits_for_downloads) {
        const double grown = growth * static_cast<double>(frame->last_rows[index]);
        most_rows = std::min(most_rows, std::max(share / first_of_share, grown));
    }
    const std::size_t rows =
        std::min(size_of_part(portion, crew[index].pace, steps, least_rows), static_cast<std::size_t>(most_rows));
    Band band{frame, frame->rows.take(std::max(rows, least_rows)).value()};
    frame->last_rows[index] = band.rows.count;
    if (frame->rows.is_empty()) {
        queue_.pop_front();
        settled_.notify_all();
    }
    ++frame->bands;
    if (!frame->watch) frame->watch.emplace();
    return band;
}

std::size_t Crew::size_of_part(double portion, double pace, int steps, std::size_t least) const {
    if (pace > 0) least = std::max(least, static_cast<std::size_t>(options_.least_seconds / pace));
    return part_size(portion, steps, pace > 0, least);
}

void Crew::start(std::size_t index, Band band, std::unique_lock<std::mutex>& lock) {
    Member& member = *members_[index];
    if (member.bands.empty()) member.busy = Stopwatch();
    const SharedFrame& frame = *band.frame;
    const std::shared_ptr<ResidentScene> part = frame.scene->parts[index];
    lock.unlock();
    std::exception_ptr error;
    try {
        band.pending = member.backend->submit_to(frame.film, 0, static_cast<int>(band.rows.first), part, band.job());
    } catch (...) {
        error = std::current_exception();
    }
    lock.lock();
    member.bands.push_back(std::move(band));
    if (error) fail(index, member.bands.size() - 1, error);
}

void Crew::finish(std::size_t index, std::unique_lock<std::mutex>& lock) {
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
    const double seconds = std::exchange(member.busy, Stopwatch()).seconds() - result.stats.seconds.compile;
    frame.scene->sample_paces[index].add(band.samples(), seconds);
    frame.band_seconds += seconds;
    frame.download_seconds += result.stats.seconds.download;
    frame.compile = std::max(frame.compile, result.stats.seconds.compile);
    add(frame.stats, result.stats);
    member.samples += static_cast<std::uint64_t>(band.samples());
    const Band done = std::move(band);
    member.bands.pop_front();
    settle(*done.frame);
}

void Crew::settle(SharedFrame& frame) {
    --frame.bands;
    if (frame.bands > 0 || !frame.rows.is_empty() || frame.is_done) return;
    frame.stats.seconds = {};
    frame.stats.seconds.compile = frame.compile;
    frame.stats.seconds.render = std::max(frame.watch->seconds() - frame.compile, 0.0);
    for (MeanPace& pace : frame.scene->sample_paces) pace.fade();
    frame.scene->waits_for_downloads = frame.download_seconds > most_downloading * frame.band_seconds;
    for (const std::string& warning : std::exchange(warnings_, {})) {
        frame.stats.warning += (frame.stats.warning.empty() ? "" : "; ") + warning;
    }
    frame.is_done = true;
    settled_.notify_all();
}

void Crew::fail(std::size_t index, std::size_t which, const std::exception_ptr& error) {
    Member& member = *members_[index];
    if (!is_wrong_input(error)) return leave_out(index, error);
    const Band band = std::move(member.bands[which]);
    member.bands.erase(member.bands.begin() + static_cast<std::ptrdiff_t>(which));
    --band.frame->bands;
    end_with(*band.frame, error);
}

void Crew::end_with(SharedFrame& frame, const std::exception_ptr& error) {
    std::erase_if(queue_, [&](const auto& other) { return other.get() == &frame; });
    if (frame.is_done) return;
    frame.error = error;
    frame.is_done = true;
    settled_.notify_all();
}

void Crew::leave_out(std::size_t index, const std::exception_ptr& error) {
    Member& member = *members_[index];
    if (std::exchange(member.has_failed, true)) return;
    const Caught caught = describe(error);
    member.has_bug = caught.kind == Failure::bug;
    member.failure = caught.what;
    while (!member.bands.empty()) {
        Band band = std::move(member.bands.back());
        member.bands.pop_back();
        band.pending.reset();  // the GPU stops writing to the film before others render the band again
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

bool Crew::works_nobody() const {
    return std::all_of(members_.begin(), members_.end(), [](const auto& member) { return member->has_failed; });
}

void Crew::require_one() const {
    if (works_nobody()) std::rethrow_exception(all_failures());
}

std::exception_ptr Crew::all_failures() const {
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

}  // namespace tandem
