#include "targets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <span>
#include <thread>

#include "baseline/naive_renderer.h"
#include "beside_mitsuba.h"
#include "first_picture.h"
#include "frame_timing.h"
#include "gpu_scale.h"
#include "instance_rates.h"
#include "output.h"
#include "run_program.h"
#include "second_rays.h"
#include "sequence.h"
#include "tandem/base/error.h"
#include "tandem/base/seconds.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/report/format_number.h"
#include "versus.h"

namespace tandem::bench {

namespace {

constexpr const char* million_spheres = "named:spheres/1000000";
constexpr const char* million_boxes = "named:boxes/1000000";
constexpr const char* ten_million_spheres = "named:spheres/10000000";
constexpr int mitsuba_threads = 2;

/// The glTF files in a folder, in the order of their names.
std::vector<std::string> gltf_files(const std::string& folder) {
    std::vector<std::string> files;
    if (!std::filesystem::is_directory(folder)) return files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".gltf") files.push_back(entry.path().string());
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// A target: what it needs and how it is measured.
struct Target {
    TargetResult description;
    int needed_gpus = 0;
    std::function<void(class TargetRun&, TargetResult&)> measure;
};

class TargetRun {
  public:
    TargetRun(const TargetOptions& options, const BackendSource& source, Report& report)
        : options_(options), source_(source), report_(report), paper_(load_scene("named:paper")) {}

    /// Sample rate of the kernel of a tier divided by that of the naive kernel.
    void gpu_kernel(TargetResult& result, Tier tier, bool culls_pixels) {
        const std::unique_ptr<Backend> gpu = make("cuda", {.culls_pixels = culls_pixels});
        RenderJob job = paper_job();
        job.tier = tier;
        compare(
            result, "paper's kernel on the GPU", [&] { return naive_gpu_render(naive_job(), buffer().data()).kernel; },
            "Tandem GPU, kernel", [&] { return render_seconds(*gpu, job); });
    }

    /// Sample rate of our CPU renderer divided by that of a build of the naive one, on the same number of threads.
    void cpu_against(TargetResult& result, const NaiveBuild& build, int threads) {
        const std::unique_ptr<Backend> cpu = make("cpu", {.threads = threads});
        const RenderJob job = paper_job();
        compare(
            result, fmt::format("naive loops, {}, {} threads", build.flags, threads),
            [&] {
                const Stopwatch watch;
                naive_render(build, naive_job(), threads, buffer().data());
                return watch.seconds();
            },
            fmt::format("Tandem CPU, {} threads", threads), [&] { return render_seconds(*cpu, job); });
    }

    /// Our rays per second divided by raw Embree's.
    void cpu_rays(TargetResult& result, RaySet set) {
        const RayTiming timing = time_rays(ray_options(million_spheres, set), {"cpu"}, source_, report_);
        add_rows(timing.rows);
        finish(result, ratio_of_medians(timing.rows.back().seconds, timing.rows.front().seconds));
    }

    /// Our rays per second on the GPU.
    void gpu_rays(TargetResult& result, const char* scene, RaySet set) {
        const RayTiming timing = time_rays(ray_options(scene, set), {"cuda"}, source_, report_);
        add_rows(timing.rows);
        finish_rays(result, timing.rows[0]);
    }

    /// Our rays per second in a city of instances, divided by those in a block of them that is written out.
    void gpu_city_rays(TargetResult& result, RaySet set) {
        const InstanceRateOptions options{.ray_edge = options_.ray_edge, .repetitions = options_.repetitions};
        const InstanceRates rates = time_instances(set, options, source_, report_);
        add_rows({rates.written, rates.kept, rates.city});
        finish(result, ratio_of_medians(rates.written.seconds, rates.city.seconds));
    }

    /// Rays from the points that coherent rays hit to a point light, in a million spheres: any hit ends them.
    void gpu_shadow_rays(TargetResult& result) {
        const std::unique_ptr<Backend> gpu = make("cuda", {});
        const PreparedScene scene = prepare(load_scene(million_spheres), {0, {}, Vec3d{0, 0, 0}});
        const auto resident = gpu->load(scene);
        const std::vector<Ray<float>> first = make_rays(RaySet::coherent, options_.ray_edge);
        std::vector<Hit> hits(first.size());
        (void)gpu->trace(*resident, {.rays = first, .hits = hits});
        const RaysToTrace rays = second_rays(first, hits, options_.ray_edge, true);
        BenchmarkRow row;
        row.label = result.id;
        row.scene = fmt::format("{}, shadow rays", million_spheres);
        row.backend = "cuda";
        row.rays = static_cast<double>(first.size());
        const TraceJob job = rays.job(hits, row.counters);
        (void)gpu->trace(*resident, job);  // warms up
        for (int round = 0; round < options_.repetitions; ++round) {
            row.seconds.push_back(gpu->trace(*resident, job));
            row.rounds.push_back(round);
        }
        add_rows({row});
        finish_rays(result, row);
    }

    /// Rays per second of the tier fast divided by those of strict: the price of exactness.
    void price_of_strict(TargetResult& result, const char* scene) {
        VersusOptions options = ray_options(scene, RaySet::random);
        BenchmarkRow rows[2];
        for (const Tier tier : {Tier::fast, Tier::strict}) {
            options.tier = to_string(tier);
            rows[tier == Tier::fast ? 0 : 1] = time_rays(options, {"cuda"}, source_, report_).rows[0];
        }
        add_rows({rows[0], rows[1]});
        finish_at_most(result, ratio_of_medians(rows[1].seconds, rows[0].seconds));
    }

    /// The time of a frame in strict over that in fast: the worst of all scenes.
    void frame_price(TargetResult& result, const std::string& backend) {
        std::vector<std::string> scenes = gltf_files(options_.scenes);
        if (scenes.empty()) {
            result.why_not = fmt::format("not run: there are no scenes in {} here", options_.scenes);
            return;
        }
        scenes.insert(scenes.end(), {million_spheres, "named:icosphere/8", "named:triangles/1000000", million_boxes});
        const std::unique_ptr<Backend> renderer = make(backend, {});
        Ratio worst;
        std::string where;
        for (const std::string& scene : scenes) {
            const std::array rows = time_frames(*renderer, scene, {Tier::fast, Tier::strict});
            add_rows({rows[0], rows[1]});
            const Ratio ratio = ratio_of_medians(rows[1].seconds, rows[0].seconds);
            if (worst.pairs != 0 && !(ratio.value > worst.value)) continue;
            worst = ratio;
            where = scene;
        }
        finish_at_most(result, worst);
        result.shown += ", " + where;
    }

    /// Samples per second of whitted.gltf in strict.
    void whitted_rate(TargetResult& result) {
        const std::string scene = options_.scenes + "/whitted.gltf";
        if (!std::filesystem::exists(scene)) {
            result.why_not = fmt::format("not run: there is no {} here", scene);
            return;
        }
        const std::array rows = time_frames(*make("cuda", {}), scene, {Tier::strict});
        add_rows({rows[0]});
        const Summary frame = summarize(rows[0].seconds);
        result.measured = rows[0].samples / frame.median;
        result.shown = format_count(result.measured) + " samples/s, kernel " + format_summary(frame);
        result.verdict = result.measured >= result.required ? Verdict::met : Verdict::missed;
    }

    /// Samples per second of whitted.gltf in strict on the CPU, divided by those of a variant of Mitsuba.
    void beside_mitsuba(TargetResult& result, const char* variant) {
        const std::string program = find_renderer(result);
        if (program.empty()) return;
        const BesideMitsuba times = time_beside_mitsuba(
            {options_.mitsuba_script, program, variant, options_.folder, mitsuba_threads, options_.repetitions});
        result.why_not = times.why_not;
        if (!times.why_not.empty()) return;
        add_rows({times.rows.begin(), times.rows.end()});
        finish(result, ratio_of_medians(times.rows[0].seconds, times.rows[1].seconds));
    }

    /// Primitives per second of a build on the GPU whose memory is there from the build before.
    void gpu_build(TargetResult& result) {
        const std::unique_ptr<Backend> gpu = make("cuda", {.refits_hierarchies = false});
        const PreparedScene scene = prepare(load_scene(ten_million_spheres), {});
        const double count = static_cast<double>(primitive_count(scene));
        BenchmarkRow row;
        row.label = result.id;
        row.scene = ten_million_spheres;
        row.backend = "cuda";
        for (int round = 0; round <= options_.repetitions; ++round) {
            const double seconds = gpu->load(scene)->load_times().build;
            if (round == 0) {
                report_.properties.emplace_back("first build of " + row.scene, format_seconds(seconds));
                continue;
            }
            row.seconds.push_back(seconds);
            row.rounds.push_back(round - 1);
        }
        add_rows({row});
        const Summary build = summarize(row.seconds);
        result.measured = count / build.median;
        result.shown = format_count(result.measured) + " spheres/s, build " + format_summary(build);
        result.verdict = result.measured >= result.required ? Verdict::met : Verdict::missed;
    }

    /// Seconds from the start of tandem-render until its picture is written.
    void gpu_first_picture(TargetResult& result) {
        const std::string program = find_renderer(result);
        if (program.empty()) return;
        BenchmarkRow row =
            time_first_picture({program, ten_million_spheres, "cuda", options_.folder, options_.repetitions});
        (void)make("cuda", {});  // only now: a driver at work makes the others start faster
        row.label = result.id;
        const Summary start = summarize(row.seconds);
        add_rows({std::move(row)});
        result.measured = start.median;
        result.shown = format_summary(start);
        result.verdict = result.measured <= result.required ? Verdict::met : Verdict::missed;
    }

    /// The least efficiency of several GPUs among two scenes.
    void gpu_scale(TargetResult& result, int gpus) {
        GpuScaleOptions options{
            {}, {gpus}, options_.scale_size, options_.scale_samples, "strict", options_.repetitions};
        Ratio least;
        for (const char* scene : {"named:paper", million_spheres}) {
            options.scene = scene;
            GpuScale scale = time_gpus(options, source_, report_);
            add_rows({scale.in_bands});
            for (const GpuScaleStep& step : scale.steps) add_rows({step.row});
            const Ratio& efficiency = scale.steps.back().efficiency;
            if (least.pairs == 0 || efficiency.value < least.value) least = efficiency;
        }
        finish(result, least);
        result.shown = format_ratio(least);
    }

    /// Share of the animation's wall-clock time that is kernel time: the median of some runs behind a first one, which
    /// links the kernel and allocates memory.
    void render_share(TargetResult& result) {
        const std::unique_ptr<Backend> gpu = make("cuda", {});
        std::filesystem::create_directories(options_.folder);
        const auto run = [&](SequenceOutput output) {
            SequenceTimes times =
                render_sequence(*gpu, paper_, paper_job(), {options_.frames, output, options_.folder, 0, 3});
            report_.counters += times.counters;
            return times;
        };
        const SequenceTimes first = run(SequenceOutput::png);
        std::vector<SequenceTimes> png;
        for (int round = 0; round < options_.repetitions; ++round) png.push_back(run(SequenceOutput::png));
        const SequenceTimes text = run(SequenceOutput::ppm_text);
        for (std::int32_t frame = options_.frames.first; frame <= options_.frames.last; ++frame) {
            std::filesystem::remove(fmt::format("{}/frame-{:04}.ppm", options_.folder, frame));
        }
        std::sort(png.begin(), png.end(),
                  [](const auto& a, const auto& b) { return a.render_share() < b.render_share(); });
        const SequenceTimes& median = png[(png.size() - 1) / 2];  // the lower one of two
        result.measured = median.render_share();
        result.shown =
            fmt::format("{} ({} to {} in {} runs)", format_share(result.measured),
                        format_share(png.front().render_share()), format_share(png.back().render_share()), png.size());
        result.verdict = result.measured >= result.required ? Verdict::met : Verdict::missed;
        report_.blocks.emplace_back(Callout{Callout::Kind::note, "PNG files: " + describe_bottleneck(median)});
        report_.blocks.emplace_back(
            Callout{Callout::Kind::note, "PNG files, the first run: " + describe_bottleneck(first)});
        report_.blocks.emplace_back(Callout{Callout::Kind::note, "PPM text instead: " + describe_bottleneck(text)});
    }

  private:
    std::unique_ptr<Backend> make(const std::string& name, const BackendOptions& options) {
        std::unique_ptr<Backend> backend = source_.make(name, options);
        describe_backend(*backend, report_);
        return backend;
    }

    /// Empty if tandem-render is not there; then `result` says so.
    static std::string find_renderer(TargetResult& result) {
        std::string program = renderer_beside();
        if (program.empty()) result.why_not = "not run: there is no tandem-render beside this program";
        return program;
    }

    /// Times frames of a scene in each tier, in turns, after one round of warm-up.
    template <std::size_t count>
    std::array<BenchmarkRow, count> time_frames(Backend& backend, const std::string& path, const Tier (&tiers)[count]) {
        const PreparedScene scene = prepare(load_scene(path), {});
        std::array<std::shared_ptr<ResidentScene>, count> resident;
        std::array<BenchmarkRow, count> rows;
        const int samples = backend.name() == "cuda" ? options_.gpu_frame_samples : options_.cpu_frame_samples;
        RenderJob job{options_.size.width, options_.size.height, samples, 0, 0};
        for (std::size_t i = 0; i < count; ++i) {
            resident[i] = backend.load(scene, tiers[i]);
            rows[i].label = fmt::format("{}, {}", backend.name(), to_string(tiers[i]));
            rows[i].scene = path;
            rows[i].backend = backend.name();
            rows[i].samples = sample_count(job);
        }
        const auto measure = [&](std::size_t i) {
            job.tier = tiers[i];
            const RenderResult timed = backend.render(resident[i], job);
            report_.counters += timed.stats.counters;
            return timed.stats.seconds.render;
        };
        for (std::size_t i = 0; i < count; ++i) (void)measure(i);  // warms up
        time_in_turns(rows, measure);
        return rows;
    }

    double render_seconds(Backend& backend, const RenderJob& job) {
        const TimedFrame timed = render_timed(backend, paper_, job);
        report_.counters += timed.stats.counters;
        return timed.stats.seconds.render;
    }
    RenderJob paper_job() const {
        return {options_.size.width, options_.size.height, options_.samples, 0, 0, Tier::strict};
    }
    NaiveJob naive_job() const { return {options_.size.width, options_.size.height, options_.samples, 0, 0}; }
    std::vector<float>& buffer() {
        buffer_.resize(static_cast<std::size_t>(3 * sample_count(paper_job()) / options_.samples));
        return buffer_;
    }

    VersusOptions ray_options(const char* scene, RaySet set) const {
        VersusOptions versus;
        versus.scene = scene;
        versus.rays = set;
        versus.ray_edge = options_.ray_edge;
        versus.repetitions = options_.repetitions;
        return versus;
    }

    /// Times both in turns, after one round of warm-up; the measured value is the baseline's time over ours.
    void compare(TargetResult& result, const std::string& their_name, const std::function<double()>& theirs,
                 const std::string& our_name, const std::function<double()>& ours) {
        BenchmarkRow rows[2];
        const std::function<double()>* measures[2] = {&theirs, &ours};
        rows[0].label = their_name;
        rows[1].label = our_name;
        (void)theirs();
        (void)ours();
        time_in_turns(rows, [&](std::size_t i) { return (*measures[i])(); });
        for (BenchmarkRow& row : rows) {
            row.scene = "named:paper";
            row.samples = sample_count(paper_job());
        }
        add_rows({rows[0], rows[1]});
        finish(result, ratio_of_medians(rows[0].seconds, rows[1].seconds));
    }

    void add_rows(const std::vector<BenchmarkRow>& rows) {
        report_.rows.insert(report_.rows.end(), rows.begin(), rows.end());
    }

    static void finish_rays(TargetResult& result, const BenchmarkRow& row) {
        result.measured = rays_per_second(row);
        result.shown = format_count(result.measured) + " rays/s, trace " + format_summary(summarize(row.seconds));
        result.verdict = result.measured >= result.required ? Verdict::met : Verdict::missed;
    }

    static void finish(TargetResult& result, const Ratio& ratio) {
        result.measured = ratio.value;
        result.shown = format_ratio(ratio) + " times";
        result.verdict = ratio.value >= result.required ? Verdict::met : Verdict::missed;
    }

    static void finish_at_most(TargetResult& result, const Ratio& ratio) {
        finish(result, ratio);
        result.verdict = ratio.value <= result.required ? Verdict::met : Verdict::missed;
    }

    /// Times all measures in turns, into a row for each.
    void time_in_turns(std::span<BenchmarkRow> rows, const std::function<double(std::size_t)>& measure) const {
        for (int round = 0; round < options_.repetitions; ++round) {
            for (const std::size_t i : interleaved_order(rows.size(), static_cast<std::size_t>(round))) {
                rows[i].seconds.push_back(measure(i));
                rows[i].rounds.push_back(round);
            }
        }
    }

    const TargetOptions& options_;
    const BackendSource& source_;
    Report& report_;
    Scene paper_;
    std::vector<float> buffer_;
};

std::string command_of(const std::string& id) { return "tandem-bench targets --only " + id; }

Target target(const std::string& id, const std::string& statement, double required, int needed_gpus,
              std::function<void(TargetRun&, TargetResult&)> measure) {
    Target made;
    made.description.id = id;
    made.description.statement = statement;
    made.description.required = required;
    made.description.command = command_of(id);
    made.needed_gpus = needed_gpus;
    made.measure = std::move(measure);
    return made;
}

/// The thread counts to measure on a machine with `cores` cores: 1, 2 and 16, as far as it has them.
std::vector<int> thread_counts(int cores) {
    std::vector<int> counts;
    for (const int count : {1, 2, 16}) {
        if (count <= cores) counts.push_back(count);
    }
    return counts;
}

/// Nearest hits through trace(), in the tier strict; rates in G rays/s.
struct GpuRays {
    const char* suffix;
    const char* what;
    const char* scene;
    double coherent, random;
    double fast_over_strict;  ///< at most, for random rays
};
constexpr std::array gpu_rays = {
    GpuRays{"", "A million spheres", million_spheres, 7.0, 2.8, 1.10},
    GpuRays{"-mesh", "A mesh of 1.3 million triangles", "named:icosphere/8", 7.2, 3.0, 1.35},
    GpuRays{"-triangles", "A million loose triangles", "named:triangles/1000000", 2.5, 1.05, 1.10},
    GpuRays{"-boxes", "A million turned boxes", million_boxes, 5.0, 2.1, 1.10},
};

std::vector<Target> all_targets(int cores) {
    std::vector<Target> targets;
    for (const Tier tier : {Tier::strict, Tier::fast}) {
        const double rate = tier == Tier::strict ? 1.25 : 2;
        targets.push_back(target(
            fmt::format("gpu-paper{}", tier == Tier::strict ? "" : "-" + to_string(tier)),
            fmt::format("Paper's scene, GPU, {}, kernel time: at least {} times the sample rate of the naive kernel, "
                        "which has the scene in its code",
                        to_string(tier), rate),
            rate, 1, [tier](TargetRun& run, TargetResult& result) { run.gpu_kernel(result, tier, true); }));
    }
    targets.push_back(target(
        "gpu-paper-unculled",
        "The same in strict, where each pixel tests all primitives, as the naive kernel does: at least 0.8 times", 0.8,
        1, [](TargetRun& run, TargetResult& result) { run.gpu_kernel(result, Tier::strict, false); }));
    for (const int threads : thread_counts(cores)) {
        const char* plural = threads == 1 ? "" : "s";
        targets.push_back(target(
            fmt::format("cpu-paper-{}", threads),
            fmt::format("Paper's scene, CPU, {} thread{}: at least 0.5 times the naive loops with -O3", threads,
                        plural),
            0.5, 0, [threads](TargetRun& run, TargetResult& result) { run.cpu_against(result, naive_o3, threads); }));
    }
    targets.push_back(target(
        "cpu-paper-o0",
        fmt::format("Paper's scene, CPU, one thread per core ({}): at least 4 times the naive loops with -O0", cores),
        4, 0, [cores](TargetRun& run, TargetResult& result) { run.cpu_against(result, naive_o0, cores); }));
    targets.push_back(target("cpu-rays-coherent", "A million spheres, CPU, coherent rays: at least 2 times raw Embree",
                             2, 0, [](TargetRun& run, TargetResult& r) { run.cpu_rays(r, RaySet::coherent); }));
    targets.push_back(target("cpu-rays-random", "A million spheres, CPU, random rays: at least 1 times raw Embree", 1,
                             0, [](TargetRun& run, TargetResult& r) { run.cpu_rays(r, RaySet::random); }));
    for (const GpuRays& rays : gpu_rays) {
        const auto add = [&](RaySet set, double rate) {
            targets.push_back(
                target(fmt::format("gpu-rays-{}{}", to_string(set), rays.suffix),
                       fmt::format("{}, GPU (H200), {} rays: at least {} G rays/s", rays.what, to_string(set), rate),
                       rate * 1e9, 1,
                       [&rays, set](TargetRun& run, TargetResult& result) { run.gpu_rays(result, rays.scene, set); }));
        };
        add(RaySet::coherent, rays.coherent);
        add(RaySet::random, rays.random);
        targets.push_back(target(fmt::format("gpu-fast-random{}", rays.suffix),
                                 fmt::format("{}, GPU, random rays: fast at most {} times as fast as strict", rays.what,
                                             rays.fast_over_strict),
                                 rays.fast_over_strict, 1, [&rays](TargetRun& run, TargetResult& result) {
                                     run.price_of_strict(result, rays.scene);
                                 }));
    }
    for (const RaySet set : {RaySet::coherent, RaySet::random}) {
        targets.push_back(target(fmt::format("gpu-city-{}", to_string(set)),
                                 fmt::format("A city of 100,489 instances of a mesh, GPU, {} rays: at least 0.2 times "
                                             "the rate in a block of 125 that is written out",
                                             to_string(set)),
                                 0.2, 1, [set](TargetRun& run, TargetResult& r) { run.gpu_city_rays(r, set); }));
    }
    targets.push_back(target("gpu-rays-shadow", "A million spheres, GPU (H200), shadow rays: at least 3 G rays/s", 3e9,
                             1, [](TargetRun& run, TargetResult& result) { run.gpu_shadow_rays(result); }));
    targets.push_back(target("gpu-whitted", "whitted.gltf, GPU (H200), strict: at least 1.4 G samples/s", 1.4e9, 1,
                             [](TargetRun& run, TargetResult& result) { run.whitted_rate(result); }));
    for (const char* backend : {"cuda", "cpu"}) {
        const bool on_gpu = backend == std::string("cuda");
        targets.push_back(target(
            fmt::format("{}-frame-price", on_gpu ? "gpu" : "cpu"),
            fmt::format(
                "Frames of the scenes of assets/scenes and of a million primitives, {}: strict takes at most 1.10 "
                "times as long as fast",
                on_gpu ? "GPU" : "CPU"),
            1.10, on_gpu ? 1 : 0,
            [backend](TargetRun& run, TargetResult& result) { run.frame_price(result, backend); }));
    }
    for (const auto& [suffix, variant, rate] :
         {std::tuple{"scalar", "scalar_rgb", 6.0}, {"llvm", "llvm_ad_rgb", 2.5}}) {
        targets.push_back(
            target(fmt::format("cpu-mitsuba-{}", suffix),
                   fmt::format("whitted.gltf, CPU, {} threads, strict: at least {} times the sample rate of "
                               "Mitsuba 3's {}",
                               mitsuba_threads, rate, variant),
                   rate, 0, [name = variant](TargetRun& run, TargetResult& r) { run.beside_mitsuba(r, name); }));
    }
    targets.push_back(target("gpu-build", "Ten million spheres, GPU (H200), build: at least 1 G spheres/s", 1e9, 1,
                             [](TargetRun& run, TargetResult& result) { run.gpu_build(result); }));
    targets.push_back(target(
        "gpu-first-picture",
        "Ten million spheres, GPU: at most 2 s from the start of tandem-render until its picture is written and it has "
        "ended, with kernels in the cache",
        2, 1, [](TargetRun& run, TargetResult& result) { run.gpu_first_picture(result); }));
    targets.push_back(target(
        "gpu-share", "Paper's animation on the GPU with PNG files: at least 95 % of the wall-clock time is kernel time",
        least_render_share, 1, [](TargetRun& run, TargetResult& result) { run.render_share(result); }));
    for (const auto& [gpus, efficiency] : {std::pair{2, 0.95}, std::pair{4, 0.9}}) {
        targets.push_back(target(
            fmt::format("gpu-scale-{}", gpus),
            fmt::format("4K frames of the paper's scene and of a million spheres, 64 samples, "
                        "strict, {} GPUs: efficiency at least {}",
                        gpus, efficiency),
            efficiency, gpus, [count = gpus](TargetRun& run, TargetResult& result) { run.gpu_scale(result, count); }));
    }
    return targets;
}

const char* in_words(Verdict verdict) {
    switch (verdict) {
        case Verdict::met:
            return "met";
        case Verdict::missed:
            return "MISSED";
        case Verdict::not_measured:
            return "not measured";
    }
    return "";
}

void check_ids(const std::vector<std::string>& wanted, const std::vector<Target>& targets) {
    std::vector<std::string> known;
    known.reserve(targets.size());
    for (const Target& one : targets) known.push_back(one.description.id);
    for (const std::string& id : wanted) {
        if (std::find(known.begin(), known.end(), id) == known.end()) {
            throw InputError(fmt::format("--only: there is no target '{}' on this machine; the targets are {}", id,
                                         fmt::join(known, ", ")));
        }
    }
}

int core_count() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

void report_results(const std::vector<TargetResult>& results, Report& report) {
    Table table{"The measured value decides; its 95 % interval is in brackets",
                {{"Target"}, {"Requirement"}, {"Measured", true}, {"Verdict"}},
                {}};
    std::size_t missed = 0, met = 0;
    for (const TargetResult& result : results) {
        const bool measured = result.verdict != Verdict::not_measured;
        table.rows.push_back(
            {result.id, result.statement, measured ? result.shown : result.why_not, in_words(result.verdict)});
        missed += result.verdict == Verdict::missed ? 1 : 0;
        met += result.verdict == Verdict::met ? 1 : 0;
        report.properties.emplace_back("target " + result.id, in_words(result.verdict));
        if (measured) report.properties.emplace_back("measured " + result.id, fmt::format("{}", result.measured));
        report.properties.emplace_back("required " + result.id, fmt::format("{}", result.required));
        report.properties.emplace_back("command " + result.id, result.command);
    }
    report.blocks.emplace_back(std::move(table));
    report.blocks.emplace_back(Callout{missed == 0 ? Callout::Kind::good : Callout::Kind::bad,
                                       fmt::format("{} targets met, {} missed, {} not measurable on this machine.", met,
                                                   missed, results.size() - met - missed)});
}

}  // namespace

std::vector<TargetResult> list_targets(int cores) {
    std::vector<TargetResult> results;
    for (Target& one : all_targets(cores)) results.push_back(std::move(one.description));
    return results;
}

bool run_targets(const TargetOptions& options, const BackendSource& source, Report& report) {
    report.title = "Targets";
    report.summary =
        fmt::format("Performance targets, measured in one run: {} rounds in alternating order.", options.repetitions);
    std::vector<Target> targets = all_targets(core_count());
    check_ids(options.only, targets);
    const std::string no_gpu = source.why_unavailable("cuda");
    std::vector<TargetResult> results;
    TargetRun run(options, source, report);
    for (Target& one : targets) {
        TargetResult& result = one.description;
        if (!options.only.empty() &&
            std::find(options.only.begin(), options.only.end(), result.id) == options.only.end()) {
            continue;
        }
        if (one.needed_gpus > 0 && !no_gpu.empty()) {
            result.why_not = "no GPU: " + no_gpu;
        } else if (one.needed_gpus > 1 && source.gpu_count() < one.needed_gpus) {
            const int there = source.gpu_count();
            result.why_not = "not run: " + (there == 1 ? "one GPU" : gpus_in_words(there));
        } else {
            log_progress("targets: " + result.id);
            one.measure(run, result);
        }
        results.push_back(std::move(result));
    }
    report_results(results, report);
    return std::none_of(results.begin(), results.end(),
                        [](const TargetResult& result) { return result.verdict == Verdict::missed; });
}

}  // namespace tandem::bench
