#include "paper_ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <thread>

#include "baseline/naive_renderer.h"
#include "frame_timing.h"
#include "output.h"
#include "pictures.h"
#include "rasterised_frame.h"
#include "tandem/base/error.h"
#include "tandem/base/seconds.h"
#include "tandem/gltf/load_scene.h"

namespace tandem::bench {

namespace {

constexpr int pictures_on_page = 6;
constexpr int largest_picture_width = 500;  ///< pixels, at most
/// Without a GPU, only this many frames are rendered by the paper's method on all threads, by the rasteriser, a second
/// time for the residual, and for the throughput of the animation: all frames would take minutes and show little.
constexpr int repeated_frames_without_gpu = 12;

/// One of the programs that take turns in each round.
struct Variant {
    std::vector<std::int32_t> frames;
    std::function<void(std::int32_t frame)> run;
};

class PaperRun {
  public:
    PaperRun(const PaperOptions& options, const BackendSource& source, Report& report)
        : options_(options),
          scene_(load_scene("named:paper")),
          threads_(options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency())),
          frames_folder_(options.out + "/frames"),
          text_path_(options.out + "/frame.ppm") {
        std::error_code error;
        std::filesystem::create_directories(frames_folder_, error);
        if (error) throw InputError(fmt::format("--out: cannot create {}: {}", frames_folder_, error.message()));
        make_backends(source, report);
        name_rows();
        repeated_ = spread_frames(options_.frames, gpu_ ? options_.frames.count() : repeated_frames_without_gpu);
        make_variants();
    }

    PaperMeasurements measure() {
        warm_up();
        const std::vector<std::int32_t> shown = spread_frames(options_.frames, pictures_on_page);
        for (std::int32_t frame = options_.frames.first; frame <= options_.frames.last; ++frame) {
            const auto round = static_cast<std::size_t>(frame - options_.frames.first);
            if (round % 10 == 0) log_progress(fmt::format("paper: frame {} of {}", frame, options_.frames.last));
            for (const std::size_t i : interleaved_order(variants_.size(), round)) {
                const Variant& variant = variants_[i];
                if (std::binary_search(variant.frames.begin(), variant.frames.end(), frame)) variant.run(frame);
            }
            compare_films(frame);
            result_.film_hashes.push_back(film_hash(output_film()));
            if (std::binary_search(shown.begin(), shown.end(), frame)) {
                result_.pictures.push_back(small_picture(film_to_image(output_film()), largest_picture_width,
                                                         fmt::format("Frame {}", frame), scene_.display));
            }
        }
        std::filesystem::remove(text_path_);
        render_sequences();
        return std::move(result_);
    }

  private:
    void make_backends(const BackendSource& source, Report& report) {
        for (const std::string& name : available_backends(source, options_.backends, report)) {
            auto& slot = name == "cuda" ? gpu_ : cpu_;
            if (name != "cuda" && name != "cpu") {
                throw InputError(fmt::format("--backends: paper compares cpu and cuda, not {}", name));
            }
            slot = source.make(name, {options_.threads, 16, {}});
            describe_backend(*slot, report);
        }
        result_.has_cpu = cpu_ != nullptr;
        result_.has_gpu = gpu_ != nullptr;
        if (!cpu_ && !gpu_) throw EnvironmentError("none of the requested backends can run on this machine");
        const std::string reason = naive_gpu_why_unavailable();
        result_.has_naive_gpu = reason.empty() && gpu_ != nullptr;
        result_.output_backend = output_backend().name();
    }

    Backend& output_backend() { return gpu_ ? *gpu_ : *cpu_; }
    const Film& output_film() const { return gpu_ ? gpu_film_ : cpu_film_; }

    void name_rows() {
        PaperRows& rows = result_.rows;
        const std::string ours = gpu_ ? "Tandem GPU" : "Tandem CPU";
        const auto name = [&](BenchmarkRow& row, const std::string& label, const char* backend, int threads) {
            row.label = label;
            row.backend = backend;
            row.threads = threads;
            row.scene = "named:paper";
            row.samples = sample_count(job(0));
        };
        name(rows.naive_o0, "Paper's method, CPU, -O0, 1 thread", "naive", 1);
        name(rows.naive_o3, "Paper's method, CPU, -O3, 1 thread", "naive", 1);
        name(rows.naive_o3_threads, fmt::format("Paper's method, CPU, -O3, {} threads", threads_), "naive", threads_);
        name(rows.rasterised, fmt::format("Rasteriser (no rays), CPU, {} threads", threads_), "rasteriser", threads_);
        name(rows.naive_gpu_kernel, "Paper's method, GPU, kernel alone", "naive CUDA", 0);
        name(rows.naive_gpu_frame, "Paper's method, GPU, whole frame with text", "naive CUDA", 0);
        name(rows.cpu, fmt::format("Tandem CPU, {} threads, rendering", threads_), "cpu", threads_);
        name(rows.gpu, "Tandem GPU, kernel", "cuda", 0);
        name(rows.whole, ours + ", scene to film in host memory", output_backend().name().c_str(), 0);
        name(rows.text, ours + ", and PPM text", output_backend().name().c_str(), 0);
        name(rows.png, ours + ", and PNG", output_backend().name().c_str(), 0);
        rows.naive_o0.variant = naive_o0.flags;
        rows.naive_o3.variant = rows.naive_o3_threads.variant = naive_o3.flags;
        for (BenchmarkRow* row : {&rows.cpu, &rows.gpu, &rows.whole, &rows.text, &rows.png}) row->tier = "strict";
    }

    RenderJob job(std::int32_t frame, std::uint64_t other_seed = 0) const {
        return {options_.size.width,
                options_.size.height,
                options_.samples,
                options_.seed + other_seed,
                static_cast<std::uint32_t>(frame),
                Tier::strict};
    }
    NaiveJob naive_job(std::int32_t frame, unsigned int sequence = 0) const {
        return {options_.size.width, options_.size.height, options_.samples, frame, sequence};
    }
    std::vector<float> picture_buffer() const {
        return std::vector<float>(std::size_t{3} * static_cast<std::size_t>(options_.size.width) *
                                  static_cast<std::size_t>(options_.size.height));
    }
    Film naive_film(const std::vector<float>& rgb) const {
        return film_of(rgb, options_.size.width, options_.size.height);
    }
    double write_naive_text(const std::vector<float>& rgb) const {
        const Stopwatch watch;
        naive_write_ppm(text_path_, options_.size.width, options_.size.height, rgb.data());
        return watch.seconds();
    }

    void make_variants() {
        const std::vector<std::int32_t> all = spread_frames(options_.frames, options_.frames.count());
        const auto spread = [&](int count) { return spread_frames(options_.frames, count); };
        const int slow = options_.slow_frames > 0 ? options_.slow_frames : gpu_ ? 3 : 1;
        variants_.push_back({spread(slow), [this](std::int32_t frame) {
                                 BenchmarkRow& row = result_.rows.naive_o0;
                                 const std::vector<float> rgb = run_naive_cpu(row, naive_o0, 1, frame);
                                 phase(row, "text (not in the time)").seconds.push_back(write_naive_text(rgb));
                             }});
        variants_.push_back({spread(3 * slow), [this](std::int32_t frame) {
                                 (void)run_naive_cpu(result_.rows.naive_o3, naive_o3, 1, frame);
                             }});
        variants_.push_back({repeated_, [this](std::int32_t frame) {
                                 BenchmarkRow& row = result_.rows.naive_o3_threads;
                                 naive_cpu_film_ = naive_film(run_naive_cpu(row, naive_o3, threads_, frame));
                             }});
        variants_.push_back({repeated_, [this](std::int32_t frame) {
                                 TimedFrame timed = rasterise_timed(scene_, job(frame), threads_);
                                 record(result_.rows.rasterised, frame, timed.load.build + timed.stats.seconds.render,
                                        timed);
                                 rasterised_film_ = std::move(timed.film);
                             }});
        if (result_.has_naive_gpu) variants_.push_back({all, [this](std::int32_t frame) { run_naive_gpu(frame); }});
        if (cpu_) variants_.push_back({all, [this](std::int32_t frame) { run_cpu(frame); }});
        if (gpu_) variants_.push_back({all, [this](std::int32_t frame) { run_gpu(frame); }});
    }

    /// Warms up each row except the slow ones, whose frames take so long that it makes no difference.
    void warm_up() {
        const std::int32_t frame = options_.frames.first;
        std::vector<float> rgb = picture_buffer();
        if (result_.has_naive_gpu) (void)naive_gpu_render(naive_job(frame), rgb.data());
        if (cpu_) (void)render_timed(*cpu_, scene_, job(frame));
        if (gpu_) (void)render_timed(*gpu_, scene_, job(frame));
    }

    std::vector<float> run_naive_cpu(BenchmarkRow& row, const NaiveBuild& build, int threads, std::int32_t frame) {
        std::vector<float> rgb = picture_buffer();
        const Stopwatch watch;
        naive_render(build, naive_job(frame), threads, rgb.data());
        row.seconds.push_back(watch.seconds());
        row.rounds.push_back(frame);
        phase(row, "render").seconds.push_back(row.seconds.back());
        return rgb;
    }

    void run_naive_gpu(std::int32_t frame) {
        std::vector<float> rgb = picture_buffer();
        const Stopwatch watch;
        const NaiveGpuTimes times = naive_gpu_render(naive_job(frame), rgb.data());
        const double text = write_naive_text(rgb);
        const double seconds = watch.seconds();
        naive_gpu_film_ = naive_film(rgb);
        BenchmarkRow& whole = result_.rows.naive_gpu_frame;
        for (BenchmarkRow* row : {&whole, &result_.rows.naive_gpu_kernel}) row->rounds.push_back(frame);
        whole.seconds.push_back(seconds);
        result_.rows.naive_gpu_kernel.seconds.push_back(times.kernel);
        const auto add = [&](const char* name, double value) { phase(whole, name).seconds.push_back(value); };
        add("allocate", times.allocate);
        add("random states", times.random_init);
        add("kernel", times.kernel);
        add("copy", times.download);
        add("free", times.release);
        add("text", text);
    }

    void run_cpu(std::int32_t frame) {
        TimedFrame timed = render_timed(*cpu_, scene_, job(frame));
        record(result_.rows.cpu, frame, timed.stats.seconds.render, timed);
        if (!gpu_) write_files(frame, timed);
        cpu_film_ = std::move(timed.film);
    }

    void run_gpu(std::int32_t frame) {
        TimedFrame timed = render_timed(*gpu_, scene_, job(frame));
        record(result_.rows.gpu, frame, timed.stats.seconds.render, timed);
        write_files(frame, timed);
        gpu_film_ = std::move(timed.film);
    }

    /// The rows that continue from the film to a file; one after the other.
    void write_files(std::int32_t frame, const TimedFrame& timed) {
        const ImageMetadata metadata = describe_picture(job(frame), output_backend().name());
        record(result_.rows.whole, frame, timed.everything, timed);
        const auto write = [&](BenchmarkRow& row, const std::string& path) {
            const Stopwatch watch;
            write_picture(path, timed.film, metadata, scene_.display);
            const double seconds = watch.seconds();
            record(row, frame, timed.everything + seconds, timed);
            phase(row, "encode and write").seconds.push_back(seconds);
        };
        write(result_.rows.text, text_path_);
        write(result_.rows.png, fmt::format("{}/frame-{:04}.png", frames_folder_, frame));
    }

    void compare_films(std::int32_t frame) {
        const auto add = [&](ResidualSeries& series, const char* label, const Film& a, const Film& b) {
            series.label = label;
            series.frames.push_back(frame);
            series.differences.push_back(compare(a, b));
        };
        if (cpu_ && gpu_) add(result_.cpu_gpu, "Tandem, CPU against GPU", cpu_film_, gpu_film_);
        if (!std::binary_search(repeated_.begin(), repeated_.end(), frame)) return;
        add(result_.rasterised, "Rasteriser against Tandem", rasterised_film_, output_film());
        const Film other_noise = render_timed(output_backend(), scene_, job(frame, 1)).film;
        add(result_.noise, "Tandem, one seed against another: noise alone", output_film(), other_noise);
        std::vector<float> rgb = picture_buffer();
        naive_render(naive_o3, naive_job(frame, 1), threads_, rgb.data());
        const Film other_sequence = naive_film(rgb);
        if (result_.has_naive_gpu) {
            add(result_.naive_arithmetic, "Paper's method, CPU against GPU, the same random numbers", naive_cpu_film_,
                naive_gpu_film_);
            add(result_.naive_paper, "Paper's method, CPU against GPU, different random numbers: as in the paper",
                other_sequence, naive_gpu_film_);
        } else {
            add(result_.naive_paper, "Paper's method, CPU alone, different random numbers", other_sequence,
                naive_cpu_film_);
        }
    }

    /// The animation at full speed, which shows how busy the GPU is. Without a GPU only a part of it, with PNG.
    void render_sequences() {
        const std::string text_folder = options_.out + "/ppm-text";
        FrameRange frames = options_.frames;
        if (!gpu_) frames.last = std::min(frames.last, frames.first + repeated_frames_without_gpu - 1);
        const auto run = [&](const char* label, SequenceOutput output, const std::string& folder) {
            log_progress(fmt::format("paper: the whole animation, {}", label));
            result_.sequences.push_back(
                {label, render_sequence(output_backend(), scene_, job(0), {frames, output, folder, 0, 3})});
        };
        if (gpu_) run("without files", SequenceOutput::none, "");
        run("PNG files, by other threads", SequenceOutput::png, frames_folder_);
        if (!gpu_) return;
        std::filesystem::create_directories(text_folder);
        run("PPM text, by other threads", SequenceOutput::ppm_text, text_folder);
        std::filesystem::remove_all(text_folder);
    }

    const PaperOptions& options_;
    Scene scene_;
    int threads_;
    std::string frames_folder_;
    std::string text_path_;
    std::unique_ptr<Backend> cpu_;
    std::unique_ptr<Backend> gpu_;
    std::vector<Variant> variants_;
    std::vector<std::int32_t> repeated_;  ///< frames that are also rendered with other random numbers
    Film cpu_film_, gpu_film_, naive_cpu_film_, naive_gpu_film_, rasterised_film_;  ///< of the current frame
    PaperMeasurements result_;
};

}  // namespace

std::vector<BenchmarkRow*> PaperRows::all() {
    return {
        &naive_o0, &naive_o3, &naive_o3_threads, &rasterised, &naive_gpu_kernel, &naive_gpu_frame, &cpu, &gpu, &whole,
        &text,     &png};
}

std::vector<std::int32_t> spread_frames(const FrameRange& range, int count) {
    std::vector<std::int32_t> frames;
    const std::int32_t taken = std::min<std::int32_t>(count, range.count());
    frames.reserve(static_cast<std::size_t>(std::max(taken, 0)));
    for (std::int32_t i = 0; i < taken; ++i) {
        frames.push_back(range.first + static_cast<std::int32_t>(std::int64_t{i} * range.count() / taken));
    }
    return frames;
}

PaperMeasurements measure_paper(const PaperOptions& options, const BackendSource& source, Report& report) {
    return PaperRun(options, source, report).measure();
}

}  // namespace tandem::bench
