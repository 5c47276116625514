// tandem-bench measures Tandem and checks that CPU and GPU agree. docs/reading-results.md explains every number.
#include <fmt/format.h>

#include <algorithm>

#include "accuracy.h"
#include "accuracy/accuracy_report.h"
#include "accuracy/report_blocks.h"
#include "common/command_line.h"
#include "common/run_main.h"
#include "coverage.h"
#include "effects.h"
#include "hard.h"
#include "output.h"
#include "paper.h"
#include "parity.h"
#include "ray_sets.h"
#include "scale.h"
#include "targets.h"
#include "versus.h"

namespace tandem::bench {

namespace {

/// Texts as typed; they become options once all are read.
struct Texts {
    std::string size;
    std::string frames;
    std::string rays;
};

/// The parts of the accuracy report to make, and the options that several of them share.
struct AccuracyChoice {
    std::vector<std::string> parts = {"sweep"};
    std::vector<std::string> scenes;
    bool list = false;
    bool all = false;
};

struct Everything {
    Texts texts;
    OutputOptions output;
    AccuracyChoice accuracy_choice;
    AccuracyOptions accuracy;
    SweepOptions sweep;
    ParityOptions parity;
    VersusOptions versus;
    PaperOptions paper;
    TargetOptions targets;
    HardOptions hard;
    EffectsOptions effects;
    ScaleOptions scale;
    CoverageOptions coverage;
    bool list_targets = false;
};

void add_output_options(CommandLine& app, OutputOptions& output) {
    app.option("--json", &output.json, "Write a JSON file with every measurement; - is standard output");
    app.option("--csv", &output.csv, "Write a CSV file with one line per row");
    app.option("--html", &output.html, "Write a self-contained HTML page");
}

template <class Options>
void add_picture_options(CommandLine& app, Texts& texts, Options& options) {
    app.option("--size", &texts.size,
               fmt::format("Width and height in pixels; default {}x{}", options.size.width, options.size.height));
    app.option("--spp", &options.samples, "Samples per pixel").shows_default().within(1, 1 << 24);
}

template <class Options>
void add_frames_option(CommandLine& app, Texts& texts, Options& options) {
    app.option("--frames", &texts.frames,
               fmt::format("First and last frame; default {}-{}", options.frames.first, options.frames.last));
}

template <class Options>
void add_backends_option(CommandLine& app, Options& options) {
    app.option("--backends", &options.backends, "Backends to run").separated_by_commas().shows_default();
}

template <class Options>
void add_tiers_option(CommandLine& app, Options& options) {
    app.option("--tiers,--tier", &options.tiers, "Accuracy tiers to run").separated_by_commas().shows_default();
}

template <class Options>
void add_round_options(CommandLine& app, Options& options) {
    app.option("--threads", &options.threads, "CPU threads; 0 is one per core").shows_default().within(0, 1024);
    app.option("--repetitions", &options.repetitions, "Rounds of measurements").shows_default().within(1, 1000);
    app.option("--seed", &options.seed, "Seed of the random numbers").shows_default();
}

CommandLine add_parity(CommandLine& app, Everything& all) {
    CommandLine command =
        app.command("parity", "Compare the films of all backends and variants. Status 1 if they differ");
    command.option("SCENE", &all.parity.scenes, "glTF files or named:NAME").shows_default();
    add_backends_option(command, all.parity);
    add_tiers_option(command, all.parity);
    add_frames_option(command, all.texts, all.parity);
    add_picture_options(command, all.texts, all.parity);
    command.option("--seed", &all.parity.seed, "Seed of the random numbers").shows_default();
    return command;
}

CommandLine add_versus(CommandLine& app, Everything& all) {
    CommandLine command =
        app.command("versus", "Time the backends against each other: frames phase by phase, or rays per second");
    command.option("SCENE", &all.versus.scene, "A glTF file or named:NAME").shows_default();
    add_backends_option(command, all.versus);
    command.option("--tier", &all.versus.tier, "Accuracy tier: fast, strict or precise").shows_default();
    add_picture_options(command, all.texts, all.versus);
    command.option("--frame", &all.versus.frame, "Frame of the animation").shows_default().at_least_zero();
    command.option("--rays", &all.texts.rays, "Trace rays instead of rendering: coherent or random");
    command.option("--ray-edge", &all.versus.ray_edge, "Rays per side of a square: trace this number squared")
        .shows_default()
        .within(1, 16384);
    add_round_options(command, all.versus);
    return command;
}

/// The options of the sweep alone.
void add_sweep_options(CommandLine& command, SweepOptions& sweep) {
    command
        .option("--vary", &sweep.axes,
                "Axes of the sweep: samples, sampler, filter, tier, effects, depth, tessellation, rasterised, "
                "denoised")
        .separated_by_commas()
        .shows_default();
    command.option("--levels", &sweep.levels, "Levels of tessellation: spheres of 20 * 4^level triangles")
        .separated_by_commas()
        .shows_default()
        .within(0, 8);
    command.option("--samples", &sweep.samples, "Samples per pixel of the sweep")
        .separated_by_commas()
        .shows_default()
        .within(1, 1 << 24);
    command.option("--seeds", &sweep.seeds, "Images per point of the sweep, each with a seed; 32 or more for intervals")
        .shows_default()
        .within(2, 100'000);
    command.option("--references", &sweep.reference_folder,
                   "Folder that keeps the references of the sweep; without it they are rendered each time");
    command
        .option("--reference-samples", &sweep.reference_samples,
                "Samples per pixel of each reference; 0 means 16 times the most of --samples")
        .shows_default()
        .within(0, 1 << 24);
    command
        .option("--denoiser", &sweep.denoiser,
                "The library of Open Image Denoise, if the system's loader does not find it")
        .shows_type("FILE");
    command.flag("--rebuild-references", &sweep.rebuild_references,
                 "Only render the references of the scenes into the folder again");
}

CommandLine add_accuracy(CommandLine& app, Everything& all) {
    CommandLine command = app.command("accuracy",
                                      "Measure what one more digit costs: time and error of samples, tiers, effects, "
                                      "depth and tessellation");
    AccuracyChoice& choice = all.accuracy_choice;
    command.option("SCENE", &choice.scenes,
                   "glTF files, named:NAME, closed:furnace/PERCENT or closed:glass. Default: named:paper for the "
                   "sweep, four scenes for the frames");
    command
        .option("--parts", &choice.parts,
                "Parts of the report: sweep (error against time), rays and frames (every tier against the "
                "oracle and precise)")
        .separated_by_commas()
        .shows_default()
        .one_of({"sweep", "rays", "frames"});
    command.flag("--list", &choice.list, "List the fixed scenes, one easy and one hard for each axis");
    command.flag("--all", &choice.all, "Sweep all scenes of the list; run it in the repository");
    add_backends_option(command, all.accuracy);
    add_tiers_option(command, all.accuracy);
    command.option(
        "--size", &all.texts.size,
        fmt::format("Width and height in pixels; default {}x{} for the sweep and {}x{} for frames",
                    all.sweep.size.width, all.sweep.size.height, all.accuracy.size.width, all.accuracy.size.height));
    add_sweep_options(command, all.sweep);
    command.option("--spp", &all.accuracy.samples, "Samples per pixel of the frames")
        .shows_default()
        .within(1, 1 << 24);
    command.option("--rays", &all.accuracy.rays, "Rays per kind of primitive").shows_default().within(1, 1 << 26);
    add_round_options(command, all.accuracy);
    return command;
}

CommandLine add_paper(CommandLine& app, Everything& all) {
    CommandLine command = app.command("paper", "Audit the paper's speed-up: images and a report");
    command.option("--out", &all.paper.out, "Folder for the images, report.html, report.json and report.csv")
        .shows_default();
    add_backends_option(command, all.paper);
    add_frames_option(command, all.texts, all.paper);
    add_picture_options(command, all.texts, all.paper);
    command
        .option("--slow-frames", &all.paper.slow_frames,
                "Frames that the paper's unoptimised CPU program renders; optimised, on one thread, it renders "
                "three times as many. 0 means 3 with a GPU and 1 without")
        .shows_default()
        .within(0, 1000);
    command.option("--threads", &all.paper.threads, "CPU threads; 0 is one per core").shows_default().within(0, 1024);
    command.option("--seed", &all.paper.seed, "Seed of the random numbers").shows_default();
    return command;
}

CommandLine add_targets(CommandLine& app, Everything& all) {
    CommandLine command = app.command("targets", "Check the performance targets. Status 1 if one is missed");
    command.option("--only", &all.targets.only, "Ids of the targets to measure; default all").separated_by_commas();
    command.flag("--list", &all.list_targets, "List the targets of this machine without measuring");
    add_frames_option(command, all.texts, all.targets);
    add_picture_options(command, all.texts, all.targets);
    command.option("--ray-edge", &all.targets.ray_edge, "Rays per side of a square: trace this number squared")
        .shows_default()
        .within(1, 16384);
    command.option("--repetitions", &all.targets.repetitions, "Rounds of measurements").shows_default().within(1, 1000);
    command.option("--out", &all.targets.folder, "Folder for the images of the animation").shows_default();
    return command;
}

CommandLine add_hard(CommandLine& app, Everything& all) {
    CommandLine command =
        app.command("hard", "Check hard cases against exact answers. Status 1 if an error bound is exceeded");
    command.option("--cases", &all.hard.cases, "Cases to run, such as A1,B*; default all").separated_by_commas();
    add_backends_option(command, all.hard);
    command.option("--tiers", &all.hard.tiers, "Accuracy tiers to run: fast, strict, precise; default all")
        .separated_by_commas();
    command.option("--rays", &all.hard.rays, "Rays per case").shows_default().within(16, 100'000'000);
    command.option("--export", &all.hard.export_folder, "Only write scenes, rays and correct answers to this folder");
    command.option("--check", &all.hard.answers, "Only score another renderer's answers in FOLDER/answers");
    return command;
}

CommandLine add_effects(CommandLine& app, Everything& all) {
    CommandLine command =
        app.command("effects", "Measure what each effect of a scene costs and how it changes the image");
    command.option("SCENE", &all.effects.scenes, "glTF files or named:NAME");
    add_backends_option(command, all.effects);
    add_tiers_option(command, all.effects);
    add_picture_options(command, all.texts, all.effects);
    add_round_options(command, all.effects);
    return command;
}

CommandLine add_scale(CommandLine& app, Everything& all) {
    CommandLine command =
        app.command("scale", "Measure how times depend on the numbers of primitives, threads and GPUs");
    command
        .option(
            "--parts", &all.scale.parts,
            "Parts of the report: rays (builds and rays by the number of primitives), frames (by the number of GPUs) "
            "and instances (rays through meshes that are kept once, on a GPU)")
        .separated_by_commas()
        .shows_default()
        .one_of({"rays", "frames", "instances"});
    command.option("--kinds", &all.scale.kinds, "Kinds of named scenes: spheres, boxes, triangles, quads, mixed")
        .separated_by_commas()
        .shows_default();
    command.option("--from", &all.scale.least, "Smallest number of primitives").shows_default();
    command.option("--to", &all.scale.most, "Largest number of primitives, up to 1e8").shows_default();
    command.option("--steps", &all.scale.steps, "Numbers of primitives per factor of ten")
        .shows_default()
        .within(1, 10);
    command.option("--rays", &all.scale.rays, "Sets of rays: coherent, random, bounce, shadow")
        .separated_by_commas()
        .shows_default();
    add_backends_option(command, all.scale);
    command.option("--threads", &all.scale.threads, "Numbers of CPU threads to measure; 0 is one per core")
        .separated_by_commas()
        .shows_default()
        .within(0, 1024);
    command
        .option("--gpus", &all.scale.gpus,
                "Numbers of GPUs to measure, together as one backend; 0 is 1, 2 and so on to all")
        .separated_by_commas()
        .shows_default()
        .within(0, 1024);
    command.option("--scenes", &all.scale.scenes, "Scenes of the frames: glTF files or named:NAME")
        .separated_by_commas()
        .shows_default();
    add_picture_options(command, all.texts, all.scale);
    command.option("--tier", &all.scale.tier, "Accuracy tier: fast, strict or precise").shows_default();
    command.option("--ray-edge", &all.scale.ray_edge, "Rays per side of a square: trace this number squared")
        .shows_default()
        .within(1, 16384);
    command.option("--repetitions", &all.scale.repetitions, "Rounds of measurements").shows_default().within(1, 1000);
    return command;
}

CommandLine add_coverage(CommandLine& app, Everything& all) {
    CommandLine command = app.command(
        "coverage",
        "Render to a target many times, and check the stated errors and the forecasts. Status 1 if the errors fail");
    CoverageOptions& coverage = all.coverage;
    command.option("SCENE", &coverage.scenes, "glTF files, named:NAME, closed:furnace/PERCENT or closed:glass")
        .required();
    command.option("--metric", &coverage.metric, "Metric of the error: rmse, relmse or flip")
        .shows_default()
        .one_of({"rmse", "relmse", "flip"});
    command.option("--size", &all.texts.size,
                   fmt::format("Width and height in pixels; default {}x{}", coverage.size.width, coverage.size.height));
    command.option("--trials", &coverage.trials, "Renders of each scene, each with a seed of its own")
        .shows_default()
        .within(1, 100'000);
    command
        .option("--equal-samples", &coverage.equal_samples,
                "A target for each: the error of an image with as many samples in every pixel")
        .separated_by_commas()
        .shows_default()
        .within(1, 1 << 20);
    command
        .option("--reference-samples", &coverage.reference_samples,
                "Samples per pixel of each of the two references that give the targets")
        .shows_default()
        .within(2, 1 << 24);
    command
        .option("--reference-factor", &coverage.reference_factor,
                "Samples of the references of the trials, over those of a render to the finest target")
        .shows_default()
        .within(2, 1 << 12);
    command.flag("!--no-plans", &coverage.plans, "Make no forecast before the trials");
    command.option("--most-samples", &coverage.most_samples, "Most samples per pixel of a render to the target")
        .shows_default()
        .within(16, 1 << 24);
    command.option("--backend", &coverage.backend, "Backend: cpu, cuda or oracle").shows_default();
    command.option("--threads", &coverage.threads, "CPU threads; 0 is one per core").shows_default().within(0, 1024);
    command.option("--seed", &coverage.seed, "Seed of the first render").shows_default();
    command.option("--clock", &coverage.clock, "Clock of the times: wall; or process, for machines with other load")
        .shows_default()
        .one_of({"wall", "process"});
    return command;
}

/// The command line as it can be typed again.
std::string command_line(int count, const char* const* words) {
    std::string line = "tandem-bench";
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const bool plain = word.find_first_not_of(
                               "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                               "-_=.,:/+") == std::string::npos;
        line += ' ';
        line += plain && !word.empty() ? word : "'" + word + "'";
    }
    return line;
}

template <class Options>
void take_texts(const Texts& texts, Options& options) {
    if (!texts.size.empty()) options.size = parse_size(texts.size);
    if constexpr (requires { options.frames; }) {
        if (!texts.frames.empty()) options.frames = parse_frames(texts.frames);
    }
}

void print_targets() {
    for (const TargetResult& target : list_targets(describe_machine().cores)) {
        fmt::print("{:18} {}\n", target.id, target.statement);
    }
}

bool run_accuracy_parts(Everything& all, const BackendSource& source, Report& report) {
    const AccuracyChoice& choice = all.accuracy_choice;
    const auto has = [&](const char* part) {
        return std::find(choice.parts.begin(), choice.parts.end(), part) != choice.parts.end();
    };
    take_texts(all.texts, all.accuracy);
    take_texts(all.texts, all.sweep);
    std::vector<std::string> scenes = choice.all ? listed_scene_names() : std::vector<std::string>();
    scenes.insert(scenes.end(), choice.scenes.begin(), choice.scenes.end());
    if (!scenes.empty()) all.accuracy.scenes = scenes;
    bool holds = true;
    if (has("sweep")) {
        all.sweep.scenes = scenes;
        all.sweep.backends = all.accuracy.backends;
        all.sweep.tiers = all.accuracy.tiers;
        all.sweep.seed = all.accuracy.seed;
        all.sweep.threads = all.accuracy.threads;
        holds = run_sweep(all.sweep, source, report);
    }
    if (has("rays") || has("frames")) {
        all.accuracy.with_rays = has("rays");
        all.accuracy.with_frames = has("frames");
        holds = run_accuracy(all.accuracy, source, report) && holds;
    }
    return holds;
}

int run(int count, char** words) {
    CommandLine app{"Measures Tandem: time and error, phase by phase, every number with its spread.", "tandem-bench"};
    Everything all;
    const CommandLine parity = add_parity(app, all);
    const CommandLine versus = add_versus(app, all);
    const CommandLine accuracy = add_accuracy(app, all);
    const CommandLine paper = add_paper(app, all);
    const CommandLine targets = add_targets(app, all);
    const CommandLine hard = add_hard(app, all);
    const CommandLine effects = add_effects(app, all);
    const CommandLine scale = add_scale(app, all);
    const CommandLine coverage = add_coverage(app, all);
    for (CommandLine command : app.commands()) add_output_options(command, all.output);
    if (const auto status = app.parse(count, words)) return *status;

    const BackendSource source;
    Report report;
    report.command = command_line(count, words);
    report.machine = describe_machine();
    bool satisfied = true;
    if (parity.is_given()) {
        take_texts(all.texts, all.parity);
        satisfied = run_parity(all.parity, source, report);
    } else if (versus.is_given()) {
        take_texts(all.texts, all.versus);
        if (!all.texts.rays.empty()) all.versus.rays = parse_ray_set(all.texts.rays);
        satisfied = run_versus(all.versus, source, report);
    } else if (accuracy.is_given()) {
        if (all.accuracy_choice.list) {
            Report list;
            list.title = "Scenes of the accuracy report";
            list.summary =
                "At least one easy and one hard scene for each axis. Files of ../shared are left out where they are "
                "not there.";
            list.blocks.emplace_back(scene_table());
            print_report(list);
            return exit_done;
        }
        satisfied = run_accuracy_parts(all, source, report);
    } else if (paper.is_given()) {
        take_texts(all.texts, all.paper);
        satisfied = run_paper(all.paper, source, report);
        const std::string start = all.paper.out + "/report.";
        write_report(report, {start + "json", start + "csv", start + "html"});
    } else if (targets.is_given()) {
        if (all.list_targets) {
            print_targets();
            return exit_done;
        }
        take_texts(all.texts, all.targets);
        satisfied = run_targets(all.targets, source, report);
    } else if (hard.is_given()) {
        satisfied = run_hard(all.hard, source, report);
    } else if (effects.is_given()) {
        take_texts(all.texts, all.effects);
        satisfied = run_effects(all.effects, source, report);
    } else if (scale.is_given()) {
        take_texts(all.texts, all.scale);
        satisfied = run_scale(all.scale, source, report);
    } else if (coverage.is_given()) {
        take_texts(all.texts, all.coverage);
        satisfied = run_coverage(all.coverage, source, report);
    }
    if (!write_report(report, all.output)) print_report(report);
    return satisfied ? exit_done : exit_short_of_target;
}

}  // namespace

}  // namespace tandem::bench

int main(int count, char** words) {
    return tandem::run_main("tandem-bench", [&] { return tandem::bench::run(count, words); });
}
