// tandem-bench measures Tandem and checks that CPU and GPU agree. docs/reading-results.md explains every number.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "accuracy.h"
#include "accuracy/accuracy_report.h"
#include "accuracy/report_blocks.h"
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

void add_output_options(CLI::App& app, OutputOptions& output) {
    app.add_option("--json", output.json, "Write a JSON file with every measurement; - is standard output");
    app.add_option("--csv", output.csv, "Write a CSV file with one line per row");
    app.add_option("--html", output.html, "Write a self-contained HTML page");
}

template <class Options>
void add_picture_options(CLI::App& app, Texts& texts, Options& options) {
    app.add_option("--size", texts.size,
                   fmt::format("Width and height in pixels; default {}x{}", options.size.width, options.size.height));
    app.add_option("--spp", options.samples, "Samples per pixel")->capture_default_str()->check(CLI::Range(1, 1 << 24));
}

template <class Options>
void add_frames_option(CLI::App& app, Texts& texts, Options& options) {
    app.add_option("--frames", texts.frames,
                   fmt::format("First and last frame; default {}-{}", options.frames.first, options.frames.last));
}

template <class Options>
void add_backends_option(CLI::App& app, Options& options) {
    app.add_option("--backends", options.backends, "Backends to run")->delimiter(',')->capture_default_str();
}

template <class Options>
void add_tiers_option(CLI::App& app, Options& options) {
    app.add_option("--tiers,--tier", options.tiers, "Accuracy tiers to run")->delimiter(',')->capture_default_str();
}

template <class Options>
void add_round_options(CLI::App& app, Options& options) {
    app.add_option("--threads", options.threads, "CPU threads; 0 is one per core")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    app.add_option("--repetitions", options.repetitions, "Rounds of measurements")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    app.add_option("--seed", options.seed, "Seed of the random numbers")->capture_default_str();
}

CLI::App* add_parity(CLI::App& app, Everything& all) {
    CLI::App* command =
        app.add_subcommand("parity", "Compare the films of all backends and variants. Status 1 if they differ");
    command->add_option("SCENE", all.parity.scenes, "glTF files or named:NAME")->capture_default_str();
    add_backends_option(*command, all.parity);
    add_tiers_option(*command, all.parity);
    add_frames_option(*command, all.texts, all.parity);
    add_picture_options(*command, all.texts, all.parity);
    command->add_option("--seed", all.parity.seed, "Seed of the random numbers")->capture_default_str();
    return command;
}

CLI::App* add_versus(CLI::App& app, Everything& all) {
    CLI::App* command =
        app.add_subcommand("versus", "Time the backends against each other: frames phase by phase, or rays per second");
    command->add_option("SCENE", all.versus.scene, "A glTF file or named:NAME")->capture_default_str();
    add_backends_option(*command, all.versus);
    command->add_option("--tier", all.versus.tier, "Accuracy tier: fast, strict or precise")->capture_default_str();
    add_picture_options(*command, all.texts, all.versus);
    command->add_option("--frame", all.versus.frame, "Frame of the animation")
        ->capture_default_str()
        ->check(CLI::NonNegativeNumber);
    command->add_option("--rays", all.texts.rays, "Trace rays instead of rendering: coherent or random");
    command->add_option("--ray-edge", all.versus.ray_edge, "Rays per side of a square: trace this number squared")
        ->capture_default_str()
        ->check(CLI::Range(1, 16384));
    add_round_options(*command, all.versus);
    return command;
}

/// The options of the sweep alone.
void add_sweep_options(CLI::App& command, SweepOptions& sweep) {
    command
        .add_option("--vary", sweep.axes,
                    "Axes of the sweep: samples, sampler, filter, tier, effects, depth, tessellation, rasterised, "
                    "denoised")
        ->delimiter(',')
        ->capture_default_str();
    command.add_option("--levels", sweep.levels, "Levels of tessellation: spheres of 20 * 4^level triangles")
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::Range(0, 8));
    command.add_option("--samples", sweep.samples, "Samples per pixel of the sweep")
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::Range(1, 1 << 24));
    command
        .add_option("--seeds", sweep.seeds, "Images per point of the sweep, each with a seed; 32 or more for intervals")
        ->capture_default_str()
        ->check(CLI::Range(2, 100'000));
    command.add_option("--references", sweep.reference_folder,
                       "Folder that keeps the references of the sweep; without it they are rendered each time");
    command
        .add_option("--reference-samples", sweep.reference_samples,
                    "Samples per pixel of each reference; 0 means 16 times the most of --samples")
        ->capture_default_str()
        ->check(CLI::Range(0, 1 << 24));
    command
        .add_option("--denoiser", sweep.denoiser,
                    "The library of Open Image Denoise, if the system's loader does not find it")
        ->type_name("FILE");
    command.add_flag("--rebuild-references", sweep.rebuild_references,
                     "Only render the references of the scenes into the folder again");
}

CLI::App* add_accuracy(CLI::App& app, Everything& all) {
    CLI::App* command =
        app.add_subcommand("accuracy",
                           "Measure what one more digit costs: time and error of samples, tiers, effects, "
                           "depth and tessellation");
    AccuracyChoice& choice = all.accuracy_choice;
    command->add_option("SCENE", choice.scenes,
                        "glTF files, named:NAME, closed:furnace/PERCENT or closed:glass. Default: named:paper for the "
                        "sweep, four scenes for the frames");
    command
        ->add_option("--parts", choice.parts,
                     "Parts of the report: sweep (error against time), rays and frames (every tier against the "
                     "oracle and precise)")
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::IsMember({"sweep", "rays", "frames"}));
    command->add_flag("--list", choice.list, "List the fixed scenes, one easy and one hard for each axis");
    command->add_flag("--all", choice.all, "Sweep all scenes of the list; run it in the repository");
    add_backends_option(*command, all.accuracy);
    add_tiers_option(*command, all.accuracy);
    command->add_option(
        "--size", all.texts.size,
        fmt::format("Width and height in pixels; default {}x{} for the sweep and {}x{} for frames",
                    all.sweep.size.width, all.sweep.size.height, all.accuracy.size.width, all.accuracy.size.height));
    add_sweep_options(*command, all.sweep);
    command->add_option("--spp", all.accuracy.samples, "Samples per pixel of the frames")
        ->capture_default_str()
        ->check(CLI::Range(1, 1 << 24));
    command->add_option("--rays", all.accuracy.rays, "Rays per kind of primitive")
        ->capture_default_str()
        ->check(CLI::Range(1, 1 << 26));
    add_round_options(*command, all.accuracy);
    return command;
}

CLI::App* add_paper(CLI::App& app, Everything& all) {
    CLI::App* command = app.add_subcommand("paper", "Audit the paper's speed-up: images and a report");
    command->add_option("--out", all.paper.out, "Folder for the images, report.html, report.json and report.csv")
        ->capture_default_str();
    add_backends_option(*command, all.paper);
    add_frames_option(*command, all.texts, all.paper);
    add_picture_options(*command, all.texts, all.paper);
    command
        ->add_option("--slow-frames", all.paper.slow_frames,
                     "Frames that the paper's unoptimised CPU program renders; optimised, on one thread, it renders "
                     "three times as many. 0 means 3 with a GPU and 1 without")
        ->capture_default_str()
        ->check(CLI::Range(0, 1000));
    command->add_option("--threads", all.paper.threads, "CPU threads; 0 is one per core")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    command->add_option("--seed", all.paper.seed, "Seed of the random numbers")->capture_default_str();
    return command;
}

CLI::App* add_targets(CLI::App& app, Everything& all) {
    CLI::App* command = app.add_subcommand("targets", "Check the performance targets. Status 1 if one is missed");
    command->add_option("--only", all.targets.only, "Ids of the targets to measure; default all")->delimiter(',');
    command->add_flag("--list", all.list_targets, "List the targets of this machine without measuring");
    add_frames_option(*command, all.texts, all.targets);
    add_picture_options(*command, all.texts, all.targets);
    command->add_option("--ray-edge", all.targets.ray_edge, "Rays per side of a square: trace this number squared")
        ->capture_default_str()
        ->check(CLI::Range(1, 16384));
    command->add_option("--repetitions", all.targets.repetitions, "Rounds of measurements")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    command->add_option("--out", all.targets.folder, "Folder for the images of the animation")->capture_default_str();
    return command;
}

CLI::App* add_hard(CLI::App& app, Everything& all) {
    CLI::App* command =
        app.add_subcommand("hard", "Check hard cases against exact answers. Status 1 if an error bound is exceeded");
    command->add_option("--cases", all.hard.cases, "Cases to run, such as A1,B*; default all")->delimiter(',');
    add_backends_option(*command, all.hard);
    command->add_option("--tiers", all.hard.tiers, "Accuracy tiers to run: fast, strict, precise; default all")
        ->delimiter(',');
    command->add_option("--rays", all.hard.rays, "Rays per case")
        ->capture_default_str()
        ->check(CLI::Range(16, 100'000'000));
    command->add_option("--export", all.hard.export_folder,
                        "Only write scenes, rays and correct answers to this folder");
    command->add_option("--check", all.hard.answers, "Only score another renderer's answers in FOLDER/answers");
    return command;
}

CLI::App* add_effects(CLI::App& app, Everything& all) {
    CLI::App* command =
        app.add_subcommand("effects", "Measure what each effect of a scene costs and how it changes the image");
    command->add_option("SCENE", all.effects.scenes, "glTF files or named:NAME");
    add_backends_option(*command, all.effects);
    add_tiers_option(*command, all.effects);
    add_picture_options(*command, all.texts, all.effects);
    add_round_options(*command, all.effects);
    return command;
}

CLI::App* add_scale(CLI::App& app, Everything& all) {
    CLI::App* command =
        app.add_subcommand("scale", "Measure how times depend on the numbers of primitives, threads and GPUs");
    command
        ->add_option(
            "--parts", all.scale.parts,
            "Parts of the report: rays (builds and rays by the number of primitives), frames (by the number of GPUs) "
            "and instances (rays through meshes that are kept once, on a GPU)")
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::IsMember({"rays", "frames", "instances"}));
    command->add_option("--kinds", all.scale.kinds, "Kinds of named scenes: spheres, boxes, triangles, quads, mixed")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--from", all.scale.least, "Smallest number of primitives")->capture_default_str();
    command->add_option("--to", all.scale.most, "Largest number of primitives, up to 1e8")->capture_default_str();
    command->add_option("--steps", all.scale.steps, "Numbers of primitives per factor of ten")
        ->capture_default_str()
        ->check(CLI::Range(1, 10));
    command->add_option("--rays", all.scale.rays, "Sets of rays: coherent, random, bounce, shadow")
        ->delimiter(',')
        ->capture_default_str();
    add_backends_option(*command, all.scale);
    command->add_option("--threads", all.scale.threads, "Numbers of CPU threads to measure; 0 is one per core")
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    command
        ->add_option("--gpus", all.scale.gpus,
                     "Numbers of GPUs to measure, together as one backend; 0 is 1, 2 and so on to all")
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    command->add_option("--scenes", all.scale.scenes, "Scenes of the frames: glTF files or named:NAME")
        ->delimiter(',')
        ->capture_default_str();
    add_picture_options(*command, all.texts, all.scale);
    command->add_option("--tier", all.scale.tier, "Accuracy tier: fast, strict or precise")->capture_default_str();
    command->add_option("--ray-edge", all.scale.ray_edge, "Rays per side of a square: trace this number squared")
        ->capture_default_str()
        ->check(CLI::Range(1, 16384));
    command->add_option("--repetitions", all.scale.repetitions, "Rounds of measurements")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    return command;
}

CLI::App* add_coverage(CLI::App& app, Everything& all) {
    CLI::App* command = app.add_subcommand(
        "coverage",
        "Render to a target many times, and check the stated errors and the forecasts. Status 1 if the errors fail");
    CoverageOptions& coverage = all.coverage;
    command->add_option("SCENE", coverage.scenes, "glTF files, named:NAME, closed:furnace/PERCENT or closed:glass")
        ->required();
    command->add_option("--metric", coverage.metric, "Metric of the error: rmse, relmse or flip")
        ->capture_default_str()
        ->check(CLI::IsMember({"rmse", "relmse", "flip"}));
    command->add_option(
        "--size", all.texts.size,
        fmt::format("Width and height in pixels; default {}x{}", coverage.size.width, coverage.size.height));
    command->add_option("--trials", coverage.trials, "Renders of each scene, each with a seed of its own")
        ->capture_default_str()
        ->check(CLI::Range(1, 100'000));
    command
        ->add_option("--equal-samples", coverage.equal_samples,
                     "A target for each: the error of an image with as many samples in every pixel")
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::Range(1, 1 << 20));
    command
        ->add_option("--reference-samples", coverage.reference_samples,
                     "Samples per pixel of each of the two references that give the targets")
        ->capture_default_str()
        ->check(CLI::Range(2, 1 << 24));
    command
        ->add_option("--reference-factor", coverage.reference_factor,
                     "Samples of the references of the trials, over those of a render to the finest target")
        ->capture_default_str()
        ->check(CLI::Range(2, 1 << 12));
    command->add_flag("!--no-plans", coverage.plans, "Make no forecast before the trials");
    command->add_option("--most-samples", coverage.most_samples, "Most samples per pixel of a render to the target")
        ->capture_default_str()
        ->check(CLI::Range(16, 1 << 24));
    command->add_option("--backend", coverage.backend, "Backend: cpu, cuda or oracle")->capture_default_str();
    command->add_option("--threads", coverage.threads, "CPU threads; 0 is one per core")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    command->add_option("--seed", coverage.seed, "Seed of the first render")->capture_default_str();
    command->add_option("--clock", coverage.clock, "Clock of the times: wall; or process, for machines with other load")
        ->capture_default_str()
        ->check(CLI::IsMember({"wall", "process"}));
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
    CLI::App app{"Measures Tandem: time and error, phase by phase, every number with its spread.", "tandem-bench"};
    app.require_subcommand(1);
    Everything all;
    const CLI::App* parity = add_parity(app, all);
    const CLI::App* versus = add_versus(app, all);
    const CLI::App* accuracy = add_accuracy(app, all);
    const CLI::App* paper = add_paper(app, all);
    const CLI::App* targets = add_targets(app, all);
    const CLI::App* hard = add_hard(app, all);
    const CLI::App* effects = add_effects(app, all);
    const CLI::App* scale = add_scale(app, all);
    const CLI::App* coverage = add_coverage(app, all);
    for (CLI::App* command : app.get_subcommands({})) add_output_options(*command, all.output);
    try {
        app.parse(count, words);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exit_done : exit_bad_input;
    }

    const BackendSource source;
    Report report;
    report.command = command_line(count, words);
    report.machine = describe_machine();
    bool satisfied = true;
    if (parity->parsed()) {
        take_texts(all.texts, all.parity);
        satisfied = run_parity(all.parity, source, report);
    } else if (versus->parsed()) {
        take_texts(all.texts, all.versus);
        if (!all.texts.rays.empty()) all.versus.rays = parse_ray_set(all.texts.rays);
        satisfied = run_versus(all.versus, source, report);
    } else if (accuracy->parsed()) {
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
    } else if (paper->parsed()) {
        take_texts(all.texts, all.paper);
        satisfied = run_paper(all.paper, source, report);
        const std::string start = all.paper.out + "/report.";
        write_report(report, {start + "json", start + "csv", start + "html"});
    } else if (targets->parsed()) {
        if (all.list_targets) {
            print_targets();
            return exit_done;
        }
        take_texts(all.texts, all.targets);
        satisfied = run_targets(all.targets, source, report);
    } else if (hard->parsed()) {
        satisfied = run_hard(all.hard, source, report);
    } else if (effects->parsed()) {
        take_texts(all.texts, all.effects);
        satisfied = run_effects(all.effects, source, report);
    } else if (scale->parsed()) {
        take_texts(all.texts, all.scale);
        satisfied = run_scale(all.scale, source, report);
    } else if (coverage->parsed()) {
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
