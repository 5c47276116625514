#include "target_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "beside_mitsuba.h"
#include "first_picture.h"
#include "frame_timing.h"
#include "gpu_scale.h"
#include "instance_rates.h"
#include "output.h"
#include "run_program.h"
#include "second_rays.h"
#include "sequence.h"
#include "tandem/base/seconds.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

constexpr const char* ten_million_spheres = "named:spheres/10000000";

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

}  // namespace

TargetRun::TargetRun(const TargetOptions& options, const BackendSource& source, Report& report)
    : options_(options), source_(source), report_(report), paper_(load_scene("named:paper")) {}

void TargetRun::gpu_kernel(TargetResult& result, Tier tier, bool culls_pixels) {
    const std::unique_ptr<Backend> gpu = make("cuda", {.culls_pixels = culls_pixels});
    RenderJob job = paper_job();
    job.tier = tier;
    compare(
        result, "paper's kernel on the GPU", [&] { return naive_gpu_render(naive_job(), buffer().data()).kernel; },
        "Tandem GPU, kernel", [&] { return render_seconds(*gpu, job); });
}

void TargetRun::cpu_against(TargetResult& result, const NaiveBuild& build, int threads) {
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

void TargetRun::cpu_rays(TargetResult& result, RaySet set) {
    const RayTiming timing = time_rays(ray_options(million_spheres, set), {"cpu"}, source_, report_);
    add_rows(timing.rows);
    finish(result, ratio_of_medians(timing.rows.back().seconds, timing.rows.front().seconds));
}

void TargetRun::gpu_rays(TargetResult& result, const char* scene, RaySet set) {
    const RayTiming timing = time_rays(ray_options(scene, set), {"cuda"}, source_, report_);
    add_rows(timing.rows);
    finish_rays(result, timing.rows[0]);
}

void TargetRun::gpu_city_rays(TargetResult& result, RaySet set) {
    const InstanceRateOptions options{.ray_edge = options_.ray_edge, .repetitions = options_.repetitions};
    const InstanceRates rates = time_instances(set, options, source_, report_);
    add_rows({rates.written, rates.kept, rates.city});
    finish(result, ratio_of_medians(rates.written.seconds, rates.city.seconds));
}

void TargetRun::hard_rays(TargetResult& result, const char* backend, RaySet set, const char* scene,
                          const char* ordinary) {
    const auto time = [&](const char* name) {
        VersusOptions options = ray_options(name, set);
        if (std::string_view(backend) == "cpu") options.ray_edge /= 4;  // millions of slow rays would take minutes
        return time_rays(options, {backend}, source_, report_).rows[0];
    };
    const BenchmarkRow base = time(ordinary), hard = time(scene);
    add_rows({base, hard});
    finish(result, ratio_of_medians(base.seconds, hard.seconds));
}

void TargetRun::gpu_shadow_rays(TargetResult& result) {
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

void TargetRun::price_of_strict(TargetResult& result, const char* scene) {
    VersusOptions options = ray_options(scene, RaySet::random);
    BenchmarkRow rows[2];
    for (const Tier tier : {Tier::fast, Tier::strict}) {
        options.tier = to_string(tier);
        rows[tier == Tier::fast ? 0 : 1] = time_rays(options, {"cuda"}, source_, report_).rows[0];
    }
    add_rows({rows[0], rows[1]});
    finish_at_most(result, ratio_of_medians(rows[1].seconds, rows[0].seconds));
}

void TargetRun::frame_price(TargetResult& result, const std::string& backend) {
    std::vector<std::string> scenes = gltf_files(options_.scenes);
    if (scenes.empty()) {
        result.why_not = fmt::format("not run: there are no scenes in {} here", options_.scenes);
        return;
    }
    scenes.insert(scenes.end(), {million_spheres, "named:icosphere/8", million_triangles, million_boxes});
    const std::unique_ptr<Backend> renderer = make(backend, {});
    Ratio worst;
    std::string where;
    for (const std::string& scene : scenes) {
        const std::vector rows = time_frames(*renderer, scene, {Tier::fast, Tier::strict});
        add_rows({rows[0], rows[1]});
        const Ratio ratio = ratio_of_medians(rows[1].seconds, rows[0].seconds);
        if (worst.pairs != 0 && !(ratio.value > worst.value)) continue;
        worst = ratio;
        where = scene;
    }
    finish_at_most(result, worst);
    result.shown += ", " + where;
}

void TargetRun::whitted_rate(TargetResult& result) {
    const std::string scene = options_.scenes + "/whitted.gltf";
    if (!std::filesystem::exists(scene)) {
        result.why_not = fmt::format("not run: there is no {} here", scene);
        return;
    }
    const std::vector rows = time_frames(*make("cuda", {}), scene, {Tier::strict});
    add_rows({rows[0]});
    const Summary frame = summarize(rows[0].seconds);
    result.measured = rows[0].samples / frame.median;
    result.shown = format_count(result.measured) + " samples/s, kernel " + format_summary(frame);
    result.verdict = result.measured >= result.required ? Verdict::met : Verdict::missed;
}

void TargetRun::beside_mitsuba(TargetResult& result, const char* variant) {
    const std::string program = find_renderer(result);
    if (program.empty()) return;
    const BesideMitsuba times = time_beside_mitsuba(
        {options_.mitsuba_script, program, variant, options_.folder, mitsuba_threads, options_.repetitions});
    result.why_not = times.why_not;
    if (!times.why_not.empty()) return;
    add_rows({times.rows.begin(), times.rows.end()});
    finish(result, ratio_of_medians(times.rows[0].seconds, times.rows[1].seconds));
}

void TargetRun::gpu_build(TargetResult& result) {
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

void TargetRun::gpu_first_picture(TargetResult& result) {
    const std::string program = find_renderer(result);
    if (program.empty()) return;
    BenchmarkRow row =
        time_first_picture({program, ten_million_spheres, "cuda", options_.folder, options_.repetitions});
    (void)make("cuda", {});  // only now: programs start faster while another one uses the driver
    row.label = result.id;
    const Summary start = summarize(row.seconds);
    add_rows({std::move(row)});
    result.measured = start.median;
    result.shown = format_summary(start);
    result.verdict = result.measured <= result.required ? Verdict::met : Verdict::missed;
}

void TargetRun::gpu_scale(TargetResult& result, int gpus) {
    GpuScaleOptions options{{}, {gpus}, options_.scale_size, options_.scale_samples, "strict", options_.repetitions};
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

void TargetRun::render_share(TargetResult& result) {
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
    png.reserve(static_cast<std::size_t>(options_.repetitions));
    for (int round = 0; round < options_.repetitions; ++round) png.push_back(run(SequenceOutput::png));
    const SequenceTimes text = run(SequenceOutput::ppm_text);
    for (std::int32_t frame = options_.frames.first; frame <= options_.frames.last; ++frame) {
        std::filesystem::remove(fmt::format("{}/frame-{:04}.ppm", options_.folder, frame));
    }
    std::sort(png.begin(), png.end(), [](const auto& a, const auto& b) { return a.render_share() < b.render_share(); });
    const SequenceTimes& median = png[(png.size() - 1) / 2];  // the lower one of two
    result.measured = median.render_share();
    result.shown =
        fmt::format("{} ({} to {} in {} runs)", format_share(result.measured), format_share(png.front().render_share()),
                    format_share(png.back().render_share()), png.size());
    result.verdict = result.measured >= result.required ? Verdict::met : Verdict::missed;
    report_.blocks.emplace_back(Callout{Callout::Kind::note, "PNG files: " + describe_bottleneck(median)});
    report_.blocks.emplace_back(
        Callout{Callout::Kind::note, "PNG files, the first run: " + describe_bottleneck(first)});
    report_.blocks.emplace_back(Callout{Callout::Kind::note, "PPM text instead: " + describe_bottleneck(text)});
}

std::unique_ptr<Backend> TargetRun::make(const std::string& name, const BackendOptions& options) {
    std::unique_ptr<Backend> backend = source_.make(name, options);
    describe_backend(*backend, report_);
    return backend;
}

std::string TargetRun::find_renderer(TargetResult& result) {
    std::string program = renderer_beside();
    if (program.empty()) result.why_not = "not run: there is no tandem-render beside this program";
    return program;
}

double TargetRun::render_seconds(Backend& backend, const RenderJob& job) {
    const TimedFrame timed = render_timed(backend, paper_, job);
    report_.counters += timed.stats.counters;
    return timed.stats.seconds.render;
}

RenderJob TargetRun::paper_job() const {
    return {options_.size.width, options_.size.height, options_.samples, 0, 0, Tier::strict};
}

NaiveJob TargetRun::naive_job() const { return {options_.size.width, options_.size.height, options_.samples, 0, 0}; }

std::vector<float>& TargetRun::buffer() {
    buffer_.resize(static_cast<std::size_t>(3 * sample_count(paper_job()) / options_.samples));
    return buffer_;
}

VersusOptions TargetRun::ray_options(const char* scene, RaySet set) const {
    VersusOptions versus;
    versus.scene = scene;
    versus.rays = set;
    versus.ray_edge = options_.ray_edge;
    versus.repetitions = options_.repetitions;
    return versus;
}

void TargetRun::compare(TargetResult& result, const std::string& their_name, const std::function<double()>& theirs,
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

void TargetRun::add_rows(const std::vector<BenchmarkRow>& rows) {
    report_.rows.insert(report_.rows.end(), rows.begin(), rows.end());
}

void TargetRun::finish_rays(TargetResult& result, const BenchmarkRow& row) {
    result.measured = rays_per_second(row);
    result.shown = format_count(result.measured) + " rays/s, trace " + format_summary(summarize(row.seconds));
    result.verdict = result.measured >= result.required ? Verdict::met : Verdict::missed;
}

void TargetRun::finish(TargetResult& result, const Ratio& ratio) {
    result.measured = ratio.value;
    result.shown = format_ratio(ratio) + " times";
    result.verdict = ratio.value >= result.required ? Verdict::met : Verdict::missed;
}

void TargetRun::finish_at_most(TargetResult& result, const Ratio& ratio) {
    finish(result, ratio);
    result.verdict = ratio.value <= result.required ? Verdict::met : Verdict::missed;
}

void TargetRun::time_in_turns(std::span<BenchmarkRow> rows, const std::function<double(std::size_t)>& measure) const {
    for (int round = 0; round < options_.repetitions; ++round) {
        for (const std::size_t i : interleaved_order(rows.size(), static_cast<std::size_t>(round))) {
            rows[i].seconds.push_back(measure(i));
            rows[i].rounds.push_back(round);
        }
    }
}

std::vector<BenchmarkRow> TargetRun::time_frames(Backend& backend, const std::string& path,
                                                 const std::vector<Tier>& tiers) {
    const PreparedScene scene = prepare(load_scene(path), {});
    std::vector<std::shared_ptr<ResidentScene>> resident;
    std::vector<BenchmarkRow> rows(tiers.size());
    const int samples = backend.name() == "cuda" ? options_.gpu_frame_samples : options_.cpu_frame_samples;
    RenderJob job{options_.size.width, options_.size.height, samples, 0, 0};
    for (std::size_t i = 0; i < tiers.size(); ++i) {
        resident.push_back(backend.load(scene, tiers[i]));
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
    for (std::size_t i = 0; i < tiers.size(); ++i) (void)measure(i);  // warms up
    time_in_turns(rows, measure);
    return rows;
}

}  // namespace tandem::bench
