/// tandem-render renders frames of a scene to image files. docs/images.md describes formats, names and resuming.
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>

#include "common/arguments.h"
#include "common/choose_gpus.h"
#include "common/command_line.h"
#include "common/run_main.h"
#include "render/interrupt.h"
#include "render/plan_command.h"
#include "render/render_command.h"
#include "render/scene_source.h"
#include "render/verify_main.h"
#include "tandem/backends/backend_ahead.h"
#include "tandem/base/error.h"
#include "tandem/base/parallel.h"
#include "tandem/base/version.h"
#include "tandem/effects/names.h"
#include "tandem/film/plane_names.h"
#include "tandem/render/pixel_filter_names.h"
#include "tandem/render/sampler_names.h"
#include "tandem/scene/framing.h"
#include "tandem/scene/named_scenes.h"

namespace {

using namespace tandem;

/// Arguments that need more than a conversion.
struct Words {
    std::string size = "1000x900";
    int frame = 0;
    std::string frames;  // empty: the one above
    std::string tier = "strict";
    std::string sampler;  // empty: default_sampler()
    std::string filter = "box";
    std::string effects;
    std::string limits = to_string(PathLimits{});
    std::string planes;  // empty: the colour alone
    std::string light = "default";
    SceneSource source;
    std::string backend = "cpu";
    std::string gpus;  // empty: as the backend's name says, else the first
    std::string specialise = "always";
    CheckpointOptions checkpoint;  // no file: none
    double target_error = 0;       // 0: none
    std::string metric = "rmse";
    double time_budget = 0;  // seconds; 0: none
    bool plan = false;
    bool denoise = false;
    std::string denoiser;                           // empty: where the system's loader looks
    std::optional<std::string> exposure, transfer;  // as the scene says if not given
};

/// The sampler whose images have the least error for their time (docs/samplers.md), unless an error is estimated from
/// the samples.
Sampler default_sampler(const Words& words, const RenderJob& job) {
    const bool estimates = words.target_error > 0 || words.time_budget > 0 || job.planes.has(FilmPlane::variance);
    return estimates ? Sampler::random : Sampler::sobol;
}

/// The most samples per pixel for a target, if the user does not say.
constexpr int most_samples_of_target = 65536;

RenderTarget target_of(const Words& words) {
    RenderTarget target{.error = words.target_error, .metric = parse_metric(words.metric)};
    if (words.time_budget > 0) target.seconds = words.time_budget;
    return target;
}

void declare_target(CommandLine& app, Words& words) {
    const CommandOption error =
        app.option("--target-error", &words.target_error,
                   fmt::format("take samples where they help most until the image has this error "
                               "(docs/long-renders.md); --spp is then the most samples per pixel, {} if not given",
                               most_samples_of_target))
            .shows_type("E")
            .above_zero();
    app.option("--metric", &words.metric,
               "metric of that error: rmse, in units of radiance; relmse, the mean of relative squared errors; or "
               "flip, the difference that a person sees, from 0 to 1")
        .needs(error)
        .one_of({"rmse", "relmse", "flip"})
        .shows_default();
    app.option("--time-budget", &words.time_budget,
               "time budget of a frame, in seconds: a round of samples starts only if it will end in time")
        .shows_type("SECONDS")
        .above_zero();
}

void declare_denoiser(CommandLine& app, Words& words) {
    const CommandOption denoise =
        app.flag("--denoise", &words.denoise,
                 "denoise the image by Open Image Denoise, if it is installed (docs/denoising.md): fewer samples "
                 "look smooth, but the error is unknown, and the image cannot be verified. The hash that is printed "
                 "is that of the film before denoising");
    app.option("--denoiser", &words.denoiser, "the denoiser's library, if the system's loader does not find it")
        .shows_type("FILE")
        .needs(denoise);
}

void declare_checkpoint(CommandLine& app, Words& words) {
    const CommandOption file =
        app.option("--checkpoint", &words.checkpoint.file,
                   "render one frame in tiles, and write the finished ones to this file regularly "
                   "and when interrupted; it is removed when the image is written")
            .shows_type("FILE");
    app.option("--checkpoint-every", &words.checkpoint.every, "seconds from one checkpoint to the next")
        .shows_type("SECONDS")
        .needs(file)
        .within(0.0, 1e9)
        .shows_default();
    app.flag("--resume", &words.checkpoint.resume,
             "continue from the checkpoint file if it exists, on any backend and with the same bits")
        .needs(file);
}

/// Options whose absence has a meaning.
struct Declared {
    CommandOption samples;
    CommandOption limits;
};

Declared declare(CommandLine& app, RenderCommand& command, Words& words, BackendOptions& backend) {
    // Input, output and frames
    SequenceOptions& sequence = command.sequence;
    std::string scenes;
    for (const std::string& name : scene_names()) scenes += " named:" + name;
    app.version(version());
    app.option("SCENE", &words.source.scene, "glTF file, or a built-in scene:" + scenes).required();
    app.option("-o,--output", &sequence.output,
               "image file: .png, .ppm, .pfm or .exr; %04d or #### in the name stands for the frame number; not needed "
               "with --plan");
    app.option("--size", &words.size, "width and height in pixels").shows_type("WxH").shows_default();
    const CommandOption samples =
        app.option("--spp", &sequence.job.samples,
                   "samples per pixel; if not given, fewer where large primitives overlap (docs/images.md)")
            .shows_default();
    app.option("--seed", &sequence.job.seed, "seed of the random numbers").at_least_zero().shows_default();
    std::string samplers;
    for (const SamplerInfo& info : sampler_infos()) samplers += fmt::format("; {}: {}", info.name, info.help);
    app.option("--sampler", &words.sampler,
               "where the random numbers of samples come from" + samplers +
                   ". Default: sobol, but random with a target and for the plane variance, which need independent "
                   "samples (docs/samplers.md)")
        .shows_type("NAME");
    std::string filters;
    for (const PixelFilterInfo& info : pixel_filter_infos()) filters += fmt::format("; {}: {}", info.name, info.help);
    app.option(
           "--filter", &words.filter,
           "filter of the picture: which part of it a pixel shows, and with what weights (docs/filters.md)" + filters)
        .shows_type("NAME")
        .shows_default();
    const CommandOption frame =
        app.option("--frame", &words.frame, "frame to render").shows_type("K").at_least_zero().shows_default();
    app.option("--frames", &words.frames, "frames A to B, both included, or the whole animation")
        .shows_type("A-B|all")
        .excludes(frame);
    // Camera and lights
    app.option("--camera", &words.source.camera,
               "name of a camera's node or, if no camera has that name, a view of the whole scene: " + view_names() +
                   ". Default: the scene's first camera, or auto if there is none")
        .shows_type("NAME");
    app.option("--light", &words.light,
               "lights for a file without any: default adds a background, a light from the upper left of the "
               "camera and one from the camera; none adds nothing")
        .one_of({"default", "none"})
        .shows_default();
    const CommandOption picture =
        app.option("--env", &words.source.environment,
                   "light the scene by an equirectangular picture of its environment: .hdr, .exr or .pfm. It replaces "
                   "the background and the default lights")
            .shows_type("FILE");
    app.option("--env-rotation", &words.source.rotation,
               "rotation of that picture about the vertical axis, counter-clockwise as seen from above, in degrees")
        .shows_type("DEG")
        .needs(picture)
        .within(-36000.0, 36000.0)
        .shows_default();
    app.option("--env-intensity", &words.source.intensity, "factor of that picture's values")
        .shows_type("X")
        .needs(picture)
        .within(0.0F, most_environment_intensity)
        .shows_default();
    // What to simulate
    app.option("--effects", &words.effects,
               "force effects on or off, as in -shadows,+refraction; or all, or none. Default: the effects that the "
               "scene needs");
    app.option("--shutter-instants", &words.source.instants,
               "number of instants at which a frame with an open shutter is rendered, at most one per sample. "
               "Default: that of the camera")
        .shows_type("N")
        .within(1, 1024);
    const CommandOption limits =
        app.option("--limits", &words.limits,
                   "limits of the reflections, refractions and diffuse bounces of a path; if not given, lower where "
                   "very many large primitives overlap (docs/images.md)")
            .shows_type("R,T,D")
            .shows_default();
    declare_target(app, words);
    declare_denoiser(app, words);
    app.flag("--plan", &words.plan,
             "render nothing; print how many samples and how much time a frame will take, from a short probe, and "
             "whether that is within --time-budget (status 1 if not)");
    std::string planes;
    for (const PlaneInfo& info : plane_infos()) planes += std::string("; ") + info.name + ": " + info.help;
    app.option("--aov", &words.planes,
               "planes to write beside the colour, separated by commas, or all: layers of a .exr file, or files "
               "beside a .pfm file" +
                   planes)
        .shows_type("LIST");
    app.flag("--indirect", &words.source.indirect,
             "simulate indirect light instead of ambient light, even if the file does not ask for it");
    // How to render
    app.option("--backend", &words.backend, "backend: cpu, cuda or oracle; cuda:1 is the GPU of that number")
        .shows_default();
    app.option("--gpus", &words.gpus,
               "GPUs of the backend cuda that share each frame: all, how many, or a list of numbers such as 0,1; one "
               "if not given")
        .shows_type("all|N|LIST");
    app.option("--tier", &words.tier, "accuracy tier: fast, strict or precise").shows_default();
    app.option("--threads", &backend.threads,
               "threads for the CPU backends and for preparing scenes; 0 is one per core")
        .within(0, 4096)
        .shows_default();
    app.option("--specialise", &words.specialise, "whether to link a GPU kernel for the scene: always or never")
        .shows_default();
    declare_checkpoint(app, words);
    // Files and messages
    app.option(
           "--exposure", &words.exposure,
           "exposure of .png and .ppm in stops, each of which doubles the brightness; auto derives it from the first "
           "frame. Default: that of the scene")
        .shows_type("STOPS|auto");
    app.option("--transfer", &words.transfer,
               "transfer function of .png and .ppm: srgb or linear. Default: that of the scene")
        .shows_type("srgb|linear");
    app.option("--json", &command.json, "write times, hashes and counts to a JSON file; - is standard output");
    app.flag("--ppm-text", &sequence.write.ppm_text, "write .ppm as text (P3) instead of binary (P6)");
    app.option("--png-level", &sequence.write.png_level, "compression level of .png, 0 to 9; 1 is the fast one")
        .within(0, 9)
        .shows_default();
    app.flag("--force", &sequence.force, "render every frame, even if its file exists with the same metadata");
    app.flag("--quiet", &command.quiet, "print only errors");
    return {samples, limits};
}

/// What to render at most, from the options of samples and of the target.
void take_target(const Words& words, const Declared& declared, SequenceOptions& options) {
    const bool has_samples = declared.samples.is_given();
    if (words.target_error > 0 || words.time_budget > 0) {
        options.target = target_of(words);
        if (!has_samples && !(words.plan && words.target_error == 0)) options.job.samples = most_samples_of_target;
        return;
    }
    options.fewer_samples = !has_samples;
    options.shorter_paths = !has_samples && !declared.limits.is_given();
}

FrameRange frames_of(const Words& words, const Scene& scene) {
    if (words.frames.empty()) return {words.frame, words.frame};
    if (words.frames != "all") return parse_frames(words.frames);
    const std::int32_t count = frame_count(scene);
    if (count == std::numeric_limits<std::int32_t>::max()) {
        throw InputError("--frames all: the animation has too many frames to number; give a range, such as 0-99");
    }
    return {0, count - 1};
}

/// Prints everything in the files that is not rendered as specified; tandem-gltf info prints the whole report.
void print_import_notes(const OpenedScene& opened, const SceneSource& source) {
    if (opened.negative_texels > 0) {
        std::fprintf(stderr, "tandem-render: '%s' has %zu texels with negative values, which become 0\n",
                     source.environment.c_str(), opened.negative_texels);
    }
    for (const ImportNote& note : opened.import.notes()) {
        if (note.treatment == Treatment::rendered) continue;
        std::fprintf(stderr, "tandem-render: %s\n", to_string(note).c_str());
    }
}

void print_ignored_display_options(const SequenceOptions& options) {
    if (!holds_floats(format_of(options.output, options.write)) || (!options.exposure && !options.transfer)) return;
    std::fprintf(stderr,
                 "tandem-render: --exposure and --transfer do not change '%s': .pfm and .exr hold the linear film\n",
                 options.output.c_str());
}

int render(int argc, char** argv) {
    CommandLine app("Renders frames of a scene and prints the SHA-256 of each film.", "tandem-render");
    app.footer(
        "tandem-render verify IMAGE [SCENE] renders parts of an image again and reports whether they match "
        "(tandem-render "
        "verify --help). A scene file named 'verify' is ./verify.\nExit status: 0 done; 1 the frame did not reach its "
        "target; 2 wrong usage or input; 3 the machine lacks something; 130 interrupted.");
    RenderCommand command;
    Words words;
    BackendOptions backend_options;
    const Declared declared = declare(app, command, words, backend_options);
    if (const auto status = app.parse(argc, argv)) return *status;
    if (command.sequence.output.empty() && !words.plan) {
        throw InputError("no image file: name one with --output, such as -o image.png; only --plan needs none");
    }
    take_target(words, declared, command.sequence);
    const auto [width, height] = parse_size(words.size);
    SequenceOptions& sequence = command.sequence;
    sequence.job.width = width;
    sequence.job.height = height;
    sequence.job.tier = parse_tier(words.tier);
    sequence.job.limits = parse_limits(words.limits);
    sequence.effects = parse_effects(words.effects);
    if (!words.planes.empty()) sequence.job.planes = parse_planes(words.planes);
    sequence.job.sampler = words.sampler.empty() ? default_sampler(words, sequence.job) : parse_sampler(words.sampler);
    sequence.job.filter = parse_pixel_filter(words.filter);
    if (words.exposure) sequence.exposure = parse_exposure(*words.exposure);
    if (words.transfer) sequence.transfer = parse_transfer(*words.transfer);
    if (!words.checkpoint.file.empty()) sequence.checkpoint = words.checkpoint;
    check(sequence.job);
    if (words.denoise && !words.plan) {
        sequence.denoiser = std::make_shared<Denoiser>(words.denoiser, backend_options.threads);
    }

    const std::atomic<bool>& interrupted = watch_interrupts();
    words.source.default_light = words.light == "default";
    command.scene = words.source.scene;
    sequence.camera = words.source.camera;
    sequence.scene_source = to_json(words.source);
    backend_options.specialise = parse_specialise(words.specialise);
    choose_gpus(backend_options, words.gpus, "tandem-render");
    set_thread_limit(backend_options.threads);
    const std::unique_ptr<BackendAhead> backend = make_backend_ahead(words.backend, backend_options);
    const OpenedScene opened = open_scene(words.source, aspect_of({width, height}));
    backend->check_so_far();
    if (!command.quiet) print_import_notes(opened, words.source);
    const Scene& scene = opened.scene;
    sequence.frames = frames_of(words, scene);
    if (!words.plan) check_output(sequence);
    if (!command.quiet && !words.plan) print_ignored_display_options(sequence);
    if (words.plan) return run_plan(command, scene, *backend);
    return run_render(command, scene, *backend, interrupted);
}

}  // namespace

int main(int argc, char** argv) {
    const bool verifies = argc > 1 && std::string_view(argv[1]) == "verify";
    return tandem::run_main("tandem-render",
                            [&] { return verifies ? tandem::verify(argc, argv) : render(argc, argv); });
}
