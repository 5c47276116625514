#include "render/render_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <exception>
#include <filesystem>
#include <future>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include "render/frame_pattern.h"
#include "tandem/base/error.h"
#include "tandem/base/seconds.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/film/plane_names.h"
#include "tandem/images/exposure.h"
#include "tandem/kernel/surface.h"
#include "tandem/render/foreground.h"
#include "tandem/render/frame_metadata.h"
#include "tandem/render/motion_blur.h"
#include "tandem/render/ray_cost.h"
#include "tandem/render/ready_frame.h"

namespace tandem {

namespace {

constexpr std::size_t most_with_backend = 2;

/// ImageMetadata::exposure_rule.
constexpr const char* automatic_exposure = "auto";

/// Seconds from one call to the next.
class LapWatch {
  public:
    double lap() { return std::exchange(watch_, Stopwatch()).seconds(); }

  private:
    Stopwatch watch_;
};

/// Films wait in memory for their writers: at most 4 GiB of them, but at least one.
std::size_t writer_count(const SequenceOptions& options) {
    const std::size_t wanted = options.writers > 0 ? static_cast<std::size_t>(options.writers)
                                                   : std::max<std::size_t>(2, std::thread::hardware_concurrency());
    const std::size_t pixels =
        static_cast<std::size_t>(options.job.width) * static_cast<std::size_t>(options.job.height);
    return std::clamp<std::size_t>((std::size_t{1} << 32) / film_bytes(pixels, options.job.planes), 1, wanted);
}

/// The metadata of the file at `path`, if rendering `wanted` would give the same file. `any_exposure`: accept every
/// exposure that was found automatically.
std::optional<ImageMetadata> finished_frame(const std::string& path, ImageFormat format, ImageMetadata wanted,
                                            PlaneMask planes, bool any_exposure) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return std::nullopt;
    try {
        const DecodedImage file = read_image(path);
        if (file.format != format || !file.metadata || file.metadata->film_sha256.empty()) return std::nullopt;
        if (file.image.width != wanted.width || file.image.height != wanted.height) return std::nullopt;
        wanted.film_sha256 = file.metadata->film_sha256;
        wanted.backend = file.metadata->backend;
        wanted.scene_source = file.metadata->scene_source;
        wanted.forced_effects = file.metadata->forced_effects;
        if (!wanted.target.empty()) {
            if (file.metadata->stopped_by == to_string(StoppedBy::interrupt)) return std::nullopt;
            wanted.tile_samples = file.metadata->tile_samples;
            wanted.error = file.metadata->error;
            wanted.stopped_by = file.metadata->stopped_by;
        }
        if (any_exposure) {
            if (wanted.exposure_rule != file.metadata->exposure_rule) return std::nullopt;
            wanted.exposure_stops = file.metadata->exposure_stops;
        }
        wanted.exposure_rule = file.metadata->exposure_rule;
        if (wanted != *file.metadata) return std::nullopt;
        for (const PlaneInfo& info : plane_infos()) {
            if (format != ImageFormat::pfm || !planes.has(info.plane)) continue;
            if (read_metadata(plane_path(path, info.plane)) != wanted) return std::nullopt;
        }
        return file.metadata;
    } catch (const InputError&) {
        return std::nullopt;  // damaged, or written by another program
    }
}

/// How films become files.
struct FileChoice {
    ImageFormat format;
    WriteOptions options;
    PlaneMask planes;  ///< of the files; films have the denoiser's too
    const Denoiser* denoiser;
};

/// Denoises the film of `record`, and keeps the planes of the file.
EncodedImage encode_denoised(Film film, FrameRecord& record, const FileChoice& choice) {
    const Stopwatch watch;
    const FloatImage image = choice.denoiser->denoise(film);
    std::vector<PlaneImage> planes = plane_images(film);
    film = {};
    std::erase_if(planes, [&](const PlaneImage& plane) { return !choice.planes.has(plane.plane); });
    record.seconds.denoise = watch.seconds();
    return encode_image(image, planes, choice.format, record.metadata, choice.options);
}

/// Encodes the film of `record`. Adds the name of the file to errors, such as that of a codec that runs out of memory.
EncodedImage encode_frame(Film film, FrameRecord& record, const FileChoice& choice) {
    try {
        if (choice.denoiser != nullptr) return encode_denoised(std::move(film), record, choice);
        return encode_image(std::move(film), choice.format, record.metadata, choice.options);
    } catch (const std::bad_alloc&) {
        throw EnvironmentError(fmt::format("cannot encode '{}': not enough memory on this machine", record.file));
    } catch (const std::exception& error) {
        throw EnvironmentError(fmt::format("cannot encode '{}': {}", record.file, error.what()));
    }
}

using SceneHash = std::shared_future<std::string>;

/// The hash of a scene. Hashing ten million spheres takes a tenth of a second, so another thread hashes large scenes,
/// and keeps them meanwhile. The hash of a small scene is computed when it is needed.
SceneHash start_hash(std::shared_ptr<const PreparedScene> scene) {
    constexpr std::size_t many = 100'000;
    const auto policy = primitive_count(*scene) > many ? std::launch::async : std::launch::deferred;
    const auto hash = [scene = std::move(scene)]() mutable { return scene_hash(*std::exchange(scene, nullptr)); };
    return std::async(policy, hash).share();
}

/// Hashes, encodes and writes a film in a thread of its own. `scene`: the hash for the metadata, if they lack it.
FrameRecord write_frame(Film film, FrameRecord record, const SceneHash& scene, FileChoice choice) {
    LapWatch watch;
    record.metadata.film_sha256 = film_hash(film);
    if (scene.valid()) record.metadata.scene_hash = scene.get();
    record.seconds.hash = watch.lap();
    const EncodedImage encoded = encode_frame(std::move(film), record, choice);
    record.nan_values = encoded.nan_values;
    record.seconds.encode = watch.lap() - record.seconds.denoise;
    write_encoded(record.file, encoded, choice.format, record.metadata, choice.options);
    record.seconds.write = watch.lap();
    return record;
}

class Sequence {
  public:
    Sequence(const Scene& scene, Backend& backend, const SequenceOptions& options, const std::atomic<bool>& interrupted,
             const std::function<void(const FrameRecord&)>& on_frame)
        : scene_(scene),
          backend_(backend),
          options_(options),
          interrupted_(interrupted),
          on_frame_(on_frame),
          pattern_(options.output),
          format_(format_of(options.output, options.write)),
          write_(options.write),
          samples_(options.job.samples),
          limits_(options.job.limits),
          effects_(options.effects),
          work_is_open_(options.fewer_samples || options.shorter_paths),
          exposure_is_open_(options.exposure && options.exposure->automatic && !holds_floats(format_)),
          exposure_rule_(exposure_is_open_ ? automatic_exposure : ""),
          most_writing_(writer_count(options)) {
        write_.display = display_of(options, scene);
    }

    ~Sequence() {
        // Only after an exception: waits for the frames that the backend still renders.
        for (const Started& frame : started_) {
            try {
                if (frame.pending) (void)frame.pending->get();
            } catch (...) {
            }
        }
    }
    Sequence(const Sequence&) = delete;
    Sequence& operator=(const Sequence&) = delete;

    std::size_t run() {
        const FrameRange& frames = options_.frames;
        try {
            for (std::int32_t i = 0; i < frames.count() && !interrupted_; ++i) {
                start(frames.first + i);
                report_written();
            }
            while (!started_.empty()) pass_to_writer();
            while (!writing_.empty()) report_first();
        } catch (...) {
            report_others();
            throw;
        }
        return done_;
    }

  private:
    /// A frame that the backend renders, or one without `pending` that needs no rendering.
    struct Started {
        FrameRecord record;
        std::unique_ptr<PendingFrame> pending;
        EffectMask on_host;                  ///< FramePlan::effects
        std::optional<Backdrop> backdrop{};  ///< if the film decides the exposure
        SceneHash scene{};                   ///< unless the record has it
    };

    void start(std::int32_t frame) {
        while (exposure_is_open_ && !started_.empty()) pass_to_writer();  // the first frame decides
        RenderJob job = options_.job;
        job.frame = static_cast<std::uint32_t>(frame);
        if (options_.denoiser) job.planes |= denoiser_planes;
        PrepareOptions prepare_options = {.frame = frame, .camera = options_.camera, .effects = effects_};
        LapWatch watch;
        std::shared_ptr<const PreparedScene> prepared;
        if (std::exchange(work_is_open_, false)) {
            prepared = std::make_shared<PreparedScene>(choose_work(prepare_options));
            if (effects_ != options_.effects) prepared.reset();
            prepare_options.effects = effects_;
        }
        job.samples = samples_;
        job.limits = limits_;
        const FramePlan plan = plan_frame(scene_, prepare_options, job);
        FrameRecord record;
        record.file = pattern_.path(job.frame);
        record.bounds_per_ray = bounds_per_ray_;
        record.has_short_paths = limits_ != options_.job.limits;
        record.has_opaque_masks = effects_ != options_.effects;
        if (options_.checkpoint || options_.target) {
            start_in_tiles(plan, job, std::move(record));
        } else if (is_blurred(plan)) {
            start_blurred(plan, job, std::move(record));
        } else {
            if (!prepared) {
                prepared = std::make_shared<PreparedScene>(prepare(scene_, plan.instants.front().prepare));
            }
            start_still(std::move(prepared), plan, job, std::move(record), watch);
        }
    }

    /// Sets samples and limits from the first frame, which it returns prepared.
    PreparedScene choose_work(const PrepareOptions& options) {
        PreparedScene prepared = prepare(scene_, options);
        const RenderJob& job = options_.job;
        const double bounds = bounds_per_ray(prepared, job.width, job.height);
        double work = bounds;
        if (prepared.masked_kinds != 0) {
            work *= 1 + std::min(bounds, double{max_masked_hits});  // each masked hit costs a search of its own
            if (options_.shorter_paths && affordable_limits(job.limits, job.samples, work) != job.limits) {
                effects_.off = effects_.off | Effect::cutouts;
                work = bounds;
            }
        }
        if (options_.fewer_samples) samples_ = affordable_samples(job.samples, work);
        if (options_.shorter_paths) limits_ = affordable_limits(job.limits, job.samples, work);
        if (samples_ < job.samples || limits_ != job.limits || effects_ != options_.effects) bounds_per_ray_ = bounds;
        return prepared;
    }

    void start_still(std::shared_ptr<const PreparedScene> prepared, const FramePlan& plan, const RenderJob& job,
                     FrameRecord record, LapWatch& watch) {
        const SceneHash hash = start_hash(prepared);
        const bool waits_for_hash = resident_ || may_be_finished(record);
        record.metadata = metadata_of(job, waits_for_hash ? hash.get() : std::string());
        record.seconds.prepare = watch.lap();
        if (waits_for_hash && is_finished(record)) return;
        while (with_backend_ >= most_with_backend) pass_to_writer();
        const std::optional<Backdrop> behind = backdrop(*prepared, job);
        make_resident(prepared, hash, job.tier, record);
        prepared.reset();  // the hash, or the backend, may still need it
        ++with_backend_;
        auto pending = backend_.submit(resident_, job);
        started_.push_back({std::move(record), std::move(pending), plan.effects, behind, hash});
    }

    /// Renders a frame with motion blur at once: two instants at a time, and no other frame.
    void start_blurred(const FramePlan& plan, const RenderJob& job, FrameRecord record) {
        if (may_be_finished(record)) {
            record.metadata = metadata_of(job, frame_hash(scene_, plan));
            if (is_finished(record)) return;
        }
        leave_backend();
        FrameHash hash(plan);
        RenderedFrame frame = render_frame(backend_, scene_, plan, &hash);
        record.metadata = metadata_of(job, hash.get());
        pass_at_once(std::move(frame), plan, job, std::move(record));
    }

    /// Renders a frame in tiles, and no other frame meanwhile. An interrupted frame is not passed on.
    void start_in_tiles(const FramePlan& plan, const RenderJob& job, FrameRecord record) {
        record.metadata = metadata_of(job, frame_hash(scene_, plan));
        if (is_finished(record)) return;
        leave_backend();
        const ImageMetadata film = describe(job, record.metadata.scene_hash, backend_.name());
        auto frame = options_.target
                         ? to_target(plan, film, record)
                         : render_with_checkpoints(backend_, scene_, plan, film, *options_.checkpoint, interrupted_);
        if (frame) pass_at_once(*std::move(frame), plan, job, std::move(record));
    }

    /// Renders a frame to the target, and says in its record how it ended.
    std::optional<RenderedFrame> to_target(const FramePlan& plan, const ImageMetadata& film,
                                           FrameRecord& record) const {
        RenderTarget target = *options_.target;
        target.display = write_.display;
        const auto clock = [watch = Stopwatch()] { return watch.seconds(); };
        auto result = options_.checkpoint ? render_to_target_with_checkpoints(backend_, scene_, plan, target, film,
                                                                              *options_.checkpoint, interrupted_, clock)
                                          : render_to_target(backend_, scene_, plan, target, interrupted_, clock);
        if (!result) return std::nullopt;
        record.metadata.tile_samples = std::move(result->tile_samples);
        record.metadata.error = fmt::format("{} {}", to_string(options_.target->metric), to_string(result->error));
        record.metadata.stopped_by = to_string(result->stopped_by);
        record.mean_samples = result->mean_samples;
        return std::move(result->frame);
    }

    /// Waits until the backend renders nothing, and releases its scene.
    void leave_backend() {
        while (with_backend_ > 0) pass_to_writer();
        resident_.reset();
    }

    /// Passes a film that is complete to the writers.
    void pass_at_once(RenderedFrame frame, const FramePlan& plan, const RenderJob& job, FrameRecord record) {
        record.seconds.prepare = frame.prepare;
        record.seconds.backend = frame.load;
        ++with_backend_;
        started_.push_back({std::move(record), std::make_unique<ReadyFrame>(std::move(frame.result)), plan.effects,
                            backdrop(prepare(scene_, plan.instants.front().prepare), job)});
        while (with_backend_ > 0) pass_to_writer();
    }

    /// Whether the file exists and may be kept; it may also be that of another render.
    [[nodiscard]] bool may_be_finished(const FrameRecord& record) const {
        std::error_code ignored;
        return !options_.force && std::filesystem::exists(record.file, ignored);
    }

    /// Whether the file exists already, so that the frame need not be rendered.
    bool is_finished(FrameRecord& record) {
        if (options_.force) return false;
        auto finished = finished_frame(record.file, format_, record.metadata, options_.job.planes, exposure_is_open_);
        if (!finished) return false;
        record.metadata = std::move(*finished);
        if (exposure_is_open_) close_exposure(record.metadata.exposure_stops);
        record.skipped = true;
        started_.push_back({std::move(record), nullptr, {}, {}, {}});
        return true;
    }

    /// The metadata of the file, except for the film's hash.
    ImageMetadata metadata_of(const RenderJob& job, std::string scene_hash) const {
        ImageMetadata metadata = describe(job, std::move(scene_hash), backend_.name());
        metadata.exposure_rule = exposure_rule_;
        metadata.scene_source = options_.scene_source;
        metadata.forced_effects = to_string(effects_);
        metadata.planes = to_string(options_.job.planes);
        if (options_.denoiser) metadata.denoised = options_.denoiser->name();
        if (options_.target) metadata.target = to_string(*options_.target);
        return as_written(std::move(metadata), job.width, job.height, format_, write_);
    }

    /// Empty if the exposure is known.
    std::optional<Backdrop> backdrop(const PreparedScene& prepared, const RenderJob& job) const {
        if (!exposure_is_open_) return std::nullopt;
        return Backdrop(prepared, job.width, job.height, job.filter);
    }

    void close_exposure(double stops) {
        write_.display.exposure_stops = stops;
        exposure_is_open_ = false;
    }

    /// Loads the scene unless it is loaded already: in a still scene only the random numbers change.
    void make_resident(const std::shared_ptr<const PreparedScene>& prepared, const SceneHash& hash, Tier tier,
                       FrameRecord& record) {
        if (resident_ && resident_hash_.get() == hash.get()) return;
        resident_ = backend_.load_shared(prepared, tier);
        resident_hash_ = hash;
        record.seconds.backend = resident_->load_times();
    }

    /// Waits for the backend's oldest frame and for a free writer.
    void pass_to_writer() {
        Started frame = std::move(started_.front());
        started_.pop_front();
        FrameRecord& record = frame.record;
        if (!frame.pending) {
            const auto at_once = [record] { return record; };
            writing_.push_back(std::async(std::launch::deferred, at_once));
            return;
        }
        --with_backend_;
        RenderResult result = frame.pending->get();
        PhaseTimes& seconds = record.seconds.backend;
        seconds.build += result.stats.seconds.build;
        seconds.upload += result.stats.seconds.upload;
        seconds.compile = result.stats.seconds.compile;
        seconds.render = result.stats.seconds.render;
        seconds.download = result.stats.seconds.download;
        record.counters = result.stats.counters;
        record.variant = result.stats.variant;
        record.effects = result.stats.effects | frame.on_host;
        record.carried = result.stats.carried;
        record.registers = result.stats.registers;
        record.occupancy = result.stats.occupancy;
        record.warning = result.stats.warning;
        if (frame.backdrop) {
            close_exposure(auto_exposure(frame.backdrop->foreground(result.film)));
            record.metadata = with_display(std::move(record.metadata), write_.display);
        }
        while (writing_.size() >= most_writing_) report_first();
        const FileChoice choice{format_, write_, options_.job.planes, options_.denoiser.get()};
        writing_.push_back(std::async(std::launch::async, write_frame, std::move(result.film), std::move(record),
                                      std::move(frame.scene), choice));
    }

    void report_first() {
        std::future<FrameRecord> first = std::move(writing_.front());
        writing_.pop_front();
        const FrameRecord record = first.get();
        ++done_;
        if (options_.checkpoint && !record.skipped) {
            std::error_code ignored;
            std::filesystem::remove(options_.checkpoint->file, ignored);
        }
        on_frame_(record);
    }

    /// After an error: reports the frames whose files are still written, and ignores their errors.
    void report_others() {
        while (!writing_.empty()) {
            try {
                report_first();
            } catch (...) {
            }
        }
    }

    void report_written() {
        while (!started_.empty() && !started_.front().pending) pass_to_writer();
        const auto is_done = [](const auto& frame) {
            return frame.wait_for(std::chrono::seconds(0)) != std::future_status::timeout;
        };
        while (!writing_.empty() && is_done(writing_.front())) report_first();
    }

    const Scene& scene_;
    Backend& backend_;
    const SequenceOptions& options_;
    const std::atomic<bool>& interrupted_;
    const std::function<void(const FrameRecord&)>& on_frame_;
    FramePattern pattern_;
    ImageFormat format_;
    WriteOptions write_;
    int samples_;
    PathLimits limits_;
    ForcedEffects effects_;
    bool work_is_open_;  ///< until the first frame is prepared
    double bounds_per_ray_ = 0;
    bool exposure_is_open_;  ///< until the first frame is rendered
    std::string exposure_rule_;
    std::size_t most_writing_;

    std::shared_ptr<ResidentScene> resident_;
    SceneHash resident_hash_;
    std::deque<Started> started_;
    std::size_t with_backend_ = 0;
    std::deque<std::future<FrameRecord>> writing_;
    std::size_t done_ = 0;
};

}  // namespace

Display display_of(const SequenceOptions& options, const Scene& scene) {
    Display display = scene.display;
    if (options.transfer) display.transfer = *options.transfer;
    if (options.exposure) display.exposure_stops = options.exposure->stops;
    return display;
}

void check_output(const SequenceOptions& options) {
    const FramePattern pattern(options.output);
    const ImageFormat format = format_of(options.output, options.write);
    try {
        check_holds(format, options.job.planes);
    } catch (const InputError& error) {
        throw InputError(fmt::format("--aov cannot be used with '{}': {}", options.output, error.what()));
    }
    if (options.job.planes.has(FilmPlane::variance) && options.job.samples < 2) {
        throw InputError("--aov variance needs 2 samples per pixel or more; raise --spp");
    }
    if (options.frames.count() > 1 && !pattern.has_frame()) {
        throw InputError(fmt::format("'{}' has no placeholder for the frame number; use a name such as frame-####.png",
                                     options.output));
    }
    if (options.target) {
        check(*options.target, options.job);
        if (options.target->metric == ErrorMetric::flip && options.exposure && options.exposure->automatic) {
            throw InputError(
                "--metric flip depends on the exposure, so --exposure auto, which depends on the image, cannot be used "
                "with it; give the exposure in stops");
        }
    }
    if (options.checkpoint) {
        if (options.frames.count() > 1) {
            throw InputError("--checkpoint is for one frame; a sequence goes on from its finished files");
        }
        check_output(*options.checkpoint);
    }
    check_can_write(pattern.path(static_cast<std::uint32_t>(options.frames.first)));
}

std::size_t render_sequence(const Scene& scene, Backend& backend, const SequenceOptions& options,
                            const std::atomic<bool>& interrupted,
                            const std::function<void(const FrameRecord&)>& on_frame) {
    check(options.job);
    check_output(options);
    return Sequence(scene, backend, options, interrupted, on_frame).run();
}

}  // namespace tandem
