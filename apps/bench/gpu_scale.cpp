#include "gpu_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "output.h"
#include "tandem/base/seconds.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/render/combined_backend.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

constexpr int warm_ups = 2;  // the first has larger buffers made than the second needs

/// One way to render the frame.
struct GpuContender {
    std::unique_ptr<Backend> backend;
    std::shared_ptr<ResidentScene> resident{};
    BenchmarkRow row{};
    std::string hash{};
};

void measure(GpuContender& contender, const RenderJob& job, int round) {
    const Stopwatch watch;
    const RenderResult result = contender.backend->render(contender.resident, job);
    const double seconds = watch.seconds();
    if (round < 0) {
        contender.hash = film_hash(result.film);
        return;
    }
    contender.row.seconds.push_back(seconds);
    contender.row.rounds.push_back(round);
    contender.row.variant = result.stats.variant;
    contender.row.counters += result.stats.counters;
    phase(contender.row, "render").seconds.push_back(result.stats.seconds.render);
}

std::string shares_of(const Capabilities& capabilities) {
    double all = 0;
    for (const MemberWork& work : capabilities.members) all += static_cast<double>(work.samples);
    std::string text;
    for (const MemberWork& work : capabilities.members) {
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", work.name,
                            format_share(all > 0 ? static_cast<double>(work.samples) / all : 0));
    }
    return text;
}

Ratio efficiency_of(const BenchmarkRow& one, const BenchmarkRow& several, int gpus) {
    Ratio ratio = ratio_of_medians(one.seconds, several.seconds);
    ratio.value /= gpus;
    if (ratio.interval) ratio.interval = {ratio.interval->low / gpus, ratio.interval->high / gpus};
    return ratio;
}

}  // namespace

GpuScale time_gpus(const GpuScaleOptions& options, const BackendSource& source, Report& report) {
    const Scene scene = load_scene(options.scene);
    const PreparedScene prepared = prepare(scene, {});
    RenderJob job;
    job.width = options.size.width;
    job.height = options.size.height;
    job.samples = options.samples;
    job.tier = parse_tier(options.tier);

    std::set<int> counts(options.gpus.begin(), options.gpus.end());
    counts.insert(1);
    std::vector<GpuContender> contenders;
    const auto add = [&](std::unique_ptr<Backend> backend, int gpus, const std::string& label) {
        GpuContender& contender = contenders.emplace_back(GpuContender{std::move(backend)});
        describe_backend(*contender.backend, report);
        contender.resident = contender.backend->load(prepared, job.tier);
        BenchmarkRow& row = contender.row;
        row.label = fmt::format("{}, {}", options.scene, label);
        row.scene = options.scene;
        row.backend = contender.backend->name();
        row.tier = options.tier;
        row.samples = static_cast<double>(job.width) * job.height * job.samples;
        row.figures.emplace_back("gpus", gpus);
    };
    for (const int count : counts) {
        add(source.make("cuda", {.gpus = {.count = count}}), count, gpus_in_words(count));
    }
    std::vector<CombinedMember> alone;
    alone.push_back({"GPU 0", source.make("cuda", {})});
    add(make_combined_backend(std::move(alone)), 1, "1 GPU in bands");

    for (int round = -warm_ups; round < options.repetitions; ++round) {
        const int turn = round + warm_ups;
        for (const std::size_t i : interleaved_order(contenders.size(), static_cast<std::size_t>(turn))) {
            measure(contenders[i], job, round);
        }
    }

    GpuScale scale;
    scale.in_bands = std::move(contenders.back().row);
    const std::string& hash = contenders.front().hash;
    for (const GpuContender& contender : contenders) scale.are_equal = scale.are_equal && contender.hash == hash;
    const BenchmarkRow at_once = contenders.front().row;
    const bool bands_win = summarize(scale.in_bands.seconds).median < summarize(at_once.seconds).median;
    const BenchmarkRow& one = bands_win ? scale.in_bands : at_once;
    std::size_t i = 0;
    for (const int count : counts) {
        GpuContender& contender = contenders[i++];
        GpuScaleStep step{count, std::move(contender.row), {}};
        step.efficiency = efficiency_of(one, step.row, count);
        step.shares = shares_of(contender.backend->capabilities());
        step.row.figures.emplace_back("efficiency", step.efficiency.value);
        if (step.efficiency.interval) {
            step.row.figures.emplace_back("efficiency low", step.efficiency.interval->low);
            step.row.figures.emplace_back("efficiency high", step.efficiency.interval->high);
        }
        step.row.note = step.shares;
        scale.steps.push_back(std::move(step));
    }
    report.properties.emplace_back("film " + options.scene, scale.are_equal ? hash : "differs");
    return scale;
}

bool run_gpu_scale(GpuScaleOptions options, const std::vector<std::string>& scenes, const BackendSource& source,
                   Report& report) {
    report.blocks.emplace_back(Heading{"Frames by number of GPUs"});
    Table table{
        fmt::format("Frames of {} x {}, {} samples, {}: wall-clock times from the loaded scene to the film in "
                    "host memory, medians of {} rounds in turns. Efficiency: the time of one GPU, at once or in "
                    "bands, whichever is faster, over the time and the number of GPUs",
                    options.size.width, options.size.height, options.samples, options.tier, options.repetitions),
        {{"Scene"}, {"GPUs"}, {"Frame", true}, {"Samples/s", true}, {"Efficiency", true}, {"Shares"}},
        {}};
    LinePlot rates{"Samples per second by number of GPUs", {"GPUs", true}, {"samples/s", true}, {}, {}};
    LinePlot efficiencies{"Efficiency by number of GPUs", {"GPUs", false}, {"efficiency", false}, {}, {{"all", 1}}};
    bool are_equal = true;
    for (const std::string& scene : scenes) {
        log_progress(fmt::format("scale: frames of {}", scene));
        options.scene = scene;
        GpuScale scale = time_gpus(options, source, report);
        are_equal = are_equal && scale.are_equal;
        const auto add = [&](const BenchmarkRow& row, const std::string& gpus, const std::string& efficiency,
                             const std::string& shares) {
            table.rows.push_back({scene, gpus, format_summary(summarize(row.seconds)),
                                  format_count(samples_per_second(row)), efficiency, shares});
            report.rows.push_back(row);
        };
        Line rate{scene, {}}, efficiency{scene, {}};
        add(scale.in_bands, "1, in bands", "", "");
        for (const GpuScaleStep& step : scale.steps) {
            add(step.row, std::to_string(step.gpus), format_ratio(step.efficiency), step.shares);
            rate.points.push_back({double(step.gpus), samples_per_second(step.row)});
            efficiency.points.push_back({double(step.gpus), step.efficiency.value});
        }
        rates.lines.push_back(std::move(rate));
        efficiencies.lines.push_back(std::move(efficiency));
    }
    report.blocks.emplace_back(std::move(table));
    if (!rates.lines.empty() && rates.lines.front().points.size() > 1) {
        report.blocks.emplace_back(std::move(rates));
        report.blocks.emplace_back(std::move(efficiencies));
    }
    const bool must_agree = parse_tier(options.tier) != Tier::fast;
    report.blocks.emplace_back(are_equal ? Callout{Callout::Kind::good, "All films are equal, bit for bit."}
                                         : Callout{must_agree ? Callout::Kind::bad : Callout::Kind::note,
                                                   "Films differ by the number of GPUs."});
    return are_equal || !must_agree;
}

}  // namespace tandem::bench
