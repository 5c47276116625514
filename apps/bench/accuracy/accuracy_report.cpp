#include "accuracy/accuracy_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "accuracy/report_blocks.h"
#include "accuracy/report_words.h"
#include "output.h"
#include "tandem/base/error.h"
#include "tandem/render/pixel_filter_names.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

constexpr int enough_seeds = 32;

SweepOptions checked(SweepOptions options) {
    if (options.scenes.empty()) options.scenes = {"named:paper"};
    if (options.samples.empty()) throw InputError("accuracy needs numbers of samples: --samples 1,4,16,64");
    std::sort(options.samples.begin(), options.samples.end());
    options.samples.erase(std::unique(options.samples.begin(), options.samples.end()), options.samples.end());
    if (options.seeds < 2) {
        throw InputError(fmt::format("--seeds {}: an interval needs two images; give at least 2, better {}",
                                     options.seeds, enough_seeds));
    }
    if (options.rebuild_references && options.reference_folder.empty()) {
        throw InputError("--rebuild-references needs the folder of the references: --references FOLDER");
    }
    const Setting baseline;
    for (const int samples : options.samples) check(job_of(options, baseline, samples, options.seed));
    RenderJob reference = job_of(options, baseline, reference_options(options).samples, options.seed);
    check(reference);
    (void)varied_axes(options);
    return options;
}

std::vector<SweepBackend> make_backends(const SweepOptions& options, const BackendSource& source, Report& report) {
    std::vector<SweepBackend> backends;
    for (const std::string& name : available_backends(source, options.backends, report)) {
        backends.push_back({name, source.make(name, {.threads = options.threads, .instruction_set = {}})});
        describe_backend(*backends.back().backend, report);
    }
    if (backends.empty()) throw EnvironmentError("none of the requested backends can run on this machine");
    return backends;
}

void rebuild(const SweepOptions& options, const std::vector<SweepBackend>& backends, Report& report) {
    report.title = "Accuracy: references";
    report.summary =
        fmt::format("The references of the accuracy report in {}, rendered again.", options.reference_folder);
    for (const std::string& name : options.scenes) {
        const AccuracyScene scene = load_accuracy_scene(name, options.size);
        for (const PixelFilterInfo& info : pixel_filter_infos()) {
            if (info.filter != PixelFilter::box && !varied_axes(options).filters) continue;
            const DescribedReference described =
                make_reference(scene, reference_backend(backends), reference_options(options, info.filter));
            report.blocks.emplace_back(
                Paragraph{fmt::format("{}: {} RMSE of each, from their difference: {}.", name, described.description,
                                      format_number(described.reference.noise_floor()))});
        }
    }
}

/// False if a backend promises the bits of the baseline and has others.
bool bits_hold(const SceneSweep& sweep, const std::vector<SweepBackend>& backends, Report& report) {
    const Setting& baseline = sweep.plan.settings.front();
    if (baseline.tier == Tier::fast) return true;
    bool hold = true;
    for (const SweepBackend& backend : backends) {
        if (!backend.backend->capabilities().exact) continue;
        for (const SweepPoint* point : sweep.ladder(backend.name, baseline)) {
            if (point->differing == 0) continue;
            hold = false;
            report.blocks.emplace_back(
                Callout{Callout::Kind::bad,
                        fmt::format("{}: {} of the pixels of {} differ in a bit from those of {}.", sweep.scene.name,
                                    format_share(point->differing), point->row.label, backends.front().name)});
        }
    }
    return hold;
}

/// A paragraph for every sentence of every scene.
void add_sentences(const std::vector<SceneSweep>& sweeps, const std::vector<SweepBackend>& backends,
                   std::vector<std::string> (*words)(const SceneSweep&, const std::vector<SweepBackend>&),
                   Report& report) {
    for (const SceneSweep& sweep : sweeps) {
        const std::string scene = sweeps.size() > 1 ? sweep.scene.name + ": " : "";
        for (const std::string& sentence : words(sweep, backends)) {
            report.blocks.emplace_back(Paragraph{scene + sentence});
        }
    }
}

void add_answers(const std::vector<SceneSweep>& sweeps, const SweepOptions& options,
                 const std::vector<SweepBackend>& backends, Report& report) {
    report.blocks.emplace_back(Heading{"The answer"});
    add_sentences(sweeps, backends, answers, report);
    report.blocks.emplace_back(Heading{"How to read it"});
    report.blocks.emplace_back(Paragraph{meaning_of_words()});
    report.blocks.emplace_back(
        Heading{fmt::format("Each setting beside {}", sweeps.front().plan.settings.front().name)});
    add_sentences(sweeps, backends, comparisons, report);
    report.blocks.emplace_back(Heading{"What was not varied"});
    report.blocks.emplace_back(Paragraph{not_varied(options)});
    for (const SceneSweep& sweep : sweeps) {
        std::string text;
        for (const std::string& skipped : sweep.plan.skipped) text += " " + skipped;
        if (!text.empty()) report.blocks.emplace_back(Paragraph{sweep.scene.name + "." + text});
    }
}

void add_scene(const SceneSweep& sweep, const SweepOptions& options, const std::vector<SweepBackend>& backends,
               Report& report) {
    report.blocks.emplace_back(Heading{sweep.scene.name});
    report.blocks.emplace_back(Paragraph{sweep.reference.description});
    report.blocks.emplace_back(Paragraph{
        "A box is the 95 % interval of a point in both directions. Grey points are dominated: another point of "
        "the same backend is no slower and no worse, and its interval of one of the two is better. Their "
        "numbers are those of the table."});
    if (!sweep.filters.empty()) {
        report.blocks.emplace_back(Paragraph{
            "Points of filters are grey too, without a number, because their images approximate another image than "
            "the others do. Their errors are measured from references with the same filter, so they compare noise."});
    }
    for (const FilterReference& other : sweep.filters) {
        report.properties.emplace_back(
            fmt::format("difference of converged images {} {}", sweep.scene.name, to_string(other.filter)),
            in_words(other.difference));
    }
    for (const Metric metric : {Metric::rmse, Metric::trimmed, Metric::flip}) {
        report.blocks.emplace_back(pareto_plot(sweep, backends, metric));
    }
    report.blocks.emplace_back(equal_time_pictures(options, sweep, backends));
    report.blocks.emplace_back(equal_time_table(sweep, backends));
    report.blocks.emplace_back(equal_error_table(sweep, backends));
    report.blocks.emplace_back(convergence_table(sweep, backends));
    report.blocks.emplace_back(points_table(sweep));
    report.blocks.emplace_back(phases_table(sweep));
    for (const SweepBackend& backend : backends) {
        report.properties.emplace_back(fmt::format("price of a digit {} {}", sweep.scene.name, backend.name),
                                       fmt::format("{}", price_law(sweep, backend.name).price_of_a_digit()));
    }
    for (const SweepBackend& backend : backends) {
        for (const Setting& setting : sweep.plan.settings) {
            if (setting.axis != Axis::baseline && setting.axis != Axis::sampler) continue;
            const std::optional<Exponent> exponent = convergence(sweep, backend.name, setting);
            if (!exponent) continue;
            report.properties.emplace_back(
                fmt::format("exponent of samples {} {} {}", sweep.scene.name, backend.name, setting.name),
                in_words(*exponent));
        }
    }
    report.properties.emplace_back(fmt::format("reference {}", sweep.scene.name), sweep.reference.description);
    report.properties.emplace_back(fmt::format("reference noise {}", sweep.scene.name),
                                   fmt::format("{}", sweep.floor(Metric::rmse)));
}

}  // namespace

bool run_sweep(const SweepOptions& wanted, const BackendSource& source, Report& report) {
    const SweepOptions options = checked(wanted);
    const std::vector<SweepBackend> backends = make_backends(options, source, report);
    if (options.rebuild_references) {
        rebuild(options, backends, report);
        return true;
    }
    report.title = "Accuracy: what one more digit costs";
    report.summary = fmt::format(
        "Time and error of every setting at {} x {} pixels. Every point is {} images with a seed each; errors have "
        "95 % intervals of Student's t on the logarithm of the mean, times those of the median.",
        options.size.width, options.size.height, options.seeds);
    if (options.seeds < enough_seeds) {
        report.blocks.emplace_back(
            Callout{Callout::Kind::note,
                    fmt::format("{} seeds are few: intervals need {} to be trusted.", options.seeds, enough_seeds)});
    }
    bool equal = true;
    std::vector<SceneSweep> sweeps;
    for (const std::string& name : options.scenes) {
        sweeps.push_back(sweep_scene(options, name, backends));
        equal = bits_hold(sweeps.back(), backends, report) && equal;
    }
    add_answers(sweeps, options, backends, report);
    for (SceneSweep& sweep : sweeps) {
        add_scene(sweep, options, backends, report);
        for (SweepPoint& point : sweep.points) report.rows.push_back(std::move(point.row));
    }
    return equal;
}

}  // namespace tandem::bench
