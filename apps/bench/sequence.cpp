#include "sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "pictures.h"
#include "tandem/base/seconds.h"
#include "tandem/compile/prepare.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

/// Threads that process a queue of bounded length. finish() rethrows the first exception of a task.
class Workers {
  public:
    explicit Workers(int count) : capacity_(static_cast<std::size_t>(count) + 2) {
        for (int i = 0; i < count; ++i) threads_.emplace_back([this] { run(); });
    }
    ~Workers() { stop(); }
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    /// Waits while the queue is full; returns the seconds spent waiting.
    double add(std::function<void()> task) {
        const Stopwatch watch;
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return queue_.size() < capacity_; });
        const double waited = watch.seconds();
        queue_.push_back(std::move(task));
        changed_.notify_all();
        return waited;
    }

    /// Waits for all tasks; returns the seconds that the threads worked.
    double finish() {
        stop();
        if (error_) std::rethrow_exception(error_);
        return busy_;
    }

  private:
    void stop() {
        {
            const std::lock_guard lock(mutex_);
            stopping_ = true;
            changed_.notify_all();
        }
        threads_.clear();
    }

    void run() {
        while (true) {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
            if (queue_.empty()) return;
            std::function<void()> task = std::move(queue_.front());
            queue_.pop_front();
            changed_.notify_all();
            lock.unlock();
            const Stopwatch watch;
            std::exception_ptr error;
            try {
                task();
            } catch (...) {
                error = std::current_exception();
            }
            task = nullptr;  // the film goes back to the backend before the next one is asked for
            const double seconds = watch.seconds();
            lock.lock();
            busy_ += seconds;
            if (error && !error_) error_ = error;
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> queue_;
    std::size_t capacity_;
    bool stopping_ = false;
    double busy_ = 0;
    std::exception_ptr error_;
    std::vector<std::jthread> threads_;
};

struct InFlight {
    std::int32_t frame;
    std::unique_ptr<PendingFrame> pending;
};

}  // namespace

SequenceTimes render_sequence(Backend& backend, const Scene& scene, const RenderJob& job,
                              const SequenceOptions& options) {
    SequenceTimes times;
    times.frames = options.frames.count();
    const int cores = static_cast<int>(std::thread::hardware_concurrency());
    times.encoders = options.encoders > 0 ? options.encoders : std::max(1, cores - 1);
    Workers encoders(times.encoders);
    std::deque<InFlight> flying;

    const auto take_oldest = [&] {
        InFlight oldest = std::move(flying.front());
        flying.pop_front();
        RenderResult result = oldest.pending->get();
        times.render += result.stats.seconds.render;
        times.download += result.stats.seconds.download;
        times.counters += result.stats.counters;
        if (options.output == SequenceOutput::none) return;
        RenderJob done = job;
        done.frame = static_cast<std::uint32_t>(oldest.frame);
        times.blocked += encoders.add([film = std::move(result.film), done, &options, &scene, &backend]() mutable {
            const bool png = options.output == SequenceOutput::png;
            write_picture(fmt::format("{}/frame-{:04}.{}", options.folder, done.frame, png ? "png" : "ppm"),
                          std::move(film), describe_picture(done, backend.name()), scene.display);
        });
    };

    const Stopwatch wall;
    for (std::int32_t frame = options.frames.first; frame <= options.frames.last; ++frame) {
        if (flying.size() >= static_cast<std::size_t>(options.in_flight)) take_oldest();
        const Stopwatch host;
        const std::shared_ptr<ResidentScene> resident = backend.load(prepare(scene, {frame, {}}), job.tier);
        RenderJob this_job = job;
        this_job.frame = static_cast<std::uint32_t>(frame);
        times.host += host.seconds();
        flying.push_back({frame, backend.submit(resident, this_job)});
    }
    while (!flying.empty()) take_oldest();
    times.encode = encoders.finish();
    times.wall = wall.seconds();
    return times;
}

std::string describe_bottleneck(const SequenceTimes& times) {
    struct Load {
        double seconds;
        const char* name;
    };
    const std::array loads = {
        Load{times.encode / times.encoders, "encoding and writing the files, shared by the encoding threads"},
        Load{times.download, "copying the films to the host"},
        Load{times.host, "preparing and loading scenes on the host"},
    };
    const Load& most = *std::max_element(loads.begin(), loads.end(),
                                         [](const Load& a, const Load& b) { return a.seconds < b.seconds; });
    return fmt::format(
        "Rendering takes {} of {} wall-clock time ({}). Other work runs at the same time: encoding and writing files, "
        "{} "
        "on {} threads; copies to the host, {}; preparing and loading scenes, {}; the main thread waited {} for an "
        "encoder. The bottleneck is {}.",
        format_seconds(times.render), format_seconds(times.wall), format_share(times.render_share()),
        format_seconds(times.encode), times.encoders, format_seconds(times.download), format_seconds(times.host),
        format_seconds(times.blocked), most.name);
}

}  // namespace tandem::bench
