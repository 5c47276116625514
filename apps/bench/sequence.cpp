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
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/image_io.h"
#include "tandem/images/png_encoder.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

/// Work on one file, in parts that different threads may do at the same time.
struct FileWork {
    std::size_t parts = 1;
    std::function<void(std::size_t part)> encode;
    std::function<void()> finish{};  ///< once, when all parts are done
    // state of the queue:
    std::size_t next = 0, done = 0;
    bool failed = false;
};

/// Threads that process a queue of bounded length. All of them work on the file at its front. finish() rethrows the
/// first exception.
class Workers {
  public:
    explicit Workers(int count) : capacity_(static_cast<std::size_t>(count) + 2) {
        for (int i = 0; i < count; ++i) threads_.emplace_back([this] { run(); });
    }
    ~Workers() { stop(); }
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    /// Waits while the queue is full; returns the seconds spent waiting.
    double add(FileWork work) {
        auto added = std::make_shared<FileWork>(std::move(work));
        const Stopwatch watch;
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return queue_.size() < capacity_; });
        const double waited = watch.seconds();
        queue_.push_back(std::move(added));
        changed_.notify_all();
        return waited;
    }

    /// Waits for all files; returns the seconds that the threads worked.
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
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
            if (queue_.empty()) return;
            std::shared_ptr<FileWork> work = queue_.front();
            const std::size_t part = work->next++;
            if (work->next == work->parts) {
                queue_.pop_front();
                changed_.notify_all();
            }
            timed(lock, *work, [&] { work->encode(part); });
            if (++work->done == work->parts && !work->failed && work->finish) timed(lock, *work, work->finish);
            // memory of images returns to the backend outside the lock
            lock.unlock();
            work.reset();
            lock.lock();
        }
    }

    /// Calls f without the lock.
    void timed(std::unique_lock<std::mutex>& lock, FileWork& work, const std::function<void()>& f) {
        lock.unlock();
        const Stopwatch watch;
        std::exception_ptr error;
        try {
            f();
        } catch (...) {
            error = std::current_exception();
        }
        const double seconds = watch.seconds();
        lock.lock();
        busy_ += seconds;
        work.failed = work.failed || error;
        if (error && !error_) error_ = error;
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::shared_ptr<FileWork>> queue_;
    std::size_t capacity_;
    bool stopping_ = false;
    double busy_ = 0;
    std::exception_ptr error_;
    std::vector<std::jthread> threads_;
};

/// A frame of which either the film or the 8-bit image is wanted.
struct InFlight {
    std::int32_t frame;
    std::unique_ptr<PendingFrame> film;
    std::unique_ptr<PendingImage> image;
};

/// The file of an image.
FileWork work_on(ImageResult image, const std::string& folder, SequenceOutput output, const RenderJob& job,
                 const std::string& backend, const Display& display) {
    const bool png = output == SequenceOutput::png;
    const ImageMetadata metadata =
        as_written(describe_picture(job, backend), image.image.width, image.image.height,
                   png ? ImageFormat::png : ImageFormat::ppm_text, {.ppm_text = true, .display = display});
    const std::string path = fmt::format("{}/frame-{:04}.{}", folder, job.frame, png ? "png" : "ppm");
    FileWork work;
    if (png) {
        const auto encoder = std::make_shared<PngEncoder>(image.image, metadata, WriteOptions().png_level);
        work.parts = encoder->part_count();
        work.encode = [encoder, pixels = std::move(image.memory)](std::size_t part) { encoder->encode(part); };
        work.finish = [encoder, path] { write_file(path, encoder->finish(), Durability::written); };
    } else {
        work.encode = [image = std::move(image), metadata, path](std::size_t) {
            write_file(path, encode_ppm_text(image.image, metadata), Durability::written);
        };
    }
    return work;
}

}  // namespace

SequenceTimes render_sequence(Backend& backend, const Scene& scene, const RenderJob& job,
                              const SequenceOptions& options) {
    SequenceTimes times;
    times.frames = options.frames.count();
    const int cores = static_cast<int>(std::thread::hardware_concurrency());
    times.encoders = options.encoders > 0 ? options.encoders : std::max(1, cores - 1);
    Workers encoders(times.encoders);
    std::deque<InFlight> flying;
    const bool writes = options.output != SequenceOutput::none;
    const std::string name = backend.name();

    const auto take_oldest = [&] {
        InFlight oldest = std::move(flying.front());
        flying.pop_front();
        ImageResult image;
        RenderStats stats;
        if (writes) {
            image = oldest.image->get();
            stats = std::move(image.stats);
        } else {
            stats = oldest.film->get().stats;
        }
        times.render += stats.seconds.render;
        times.download += stats.seconds.download;
        times.counters += stats.counters;
        if (!writes) return;
        RenderJob done = job;
        done.frame = static_cast<std::uint32_t>(oldest.frame);
        times.blocked +=
            encoders.add(work_on(std::move(image), options.folder, options.output, done, name, scene.display));
    };

    const Stopwatch wall;
    for (std::int32_t frame = options.frames.first; frame <= options.frames.last; ++frame) {
        if (flying.size() >= static_cast<std::size_t>(options.in_flight)) take_oldest();
        const Stopwatch host;
        const std::shared_ptr<ResidentScene> resident = backend.load(prepare(scene, {frame, {}}), job.tier);
        RenderJob this_job = job;
        this_job.frame = static_cast<std::uint32_t>(frame);
        times.host += host.seconds();
        InFlight started{frame, {}, {}};
        if (writes) {
            started.image = backend.submit_image(resident, this_job, scene.display);
        } else {
            started.film = backend.submit(resident, this_job);
        }
        flying.push_back(std::move(started));
        if (frame == options.frames.first) times.head = wall.seconds();
    }
    while (!flying.empty()) take_oldest();
    const double arrived = wall.seconds();
    times.encode = encoders.finish();
    times.wall = wall.seconds();
    times.tail = times.wall - arrived;
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
        "encoder. The first frame was submitted after {}, and {} passed after the last one was on the host, so {} "
        "passed between the frames. The bottleneck is {}.",
        format_seconds(times.render), format_seconds(times.wall), format_share(times.render_share()),
        format_seconds(times.encode), times.encoders, format_seconds(times.download), format_seconds(times.host),
        format_seconds(times.blocked), format_seconds(times.head), format_seconds(times.tail),
        format_seconds(std::max(0.0, times.wall - times.render - times.head - times.tail)), most.name);
}

}  // namespace tandem::bench
