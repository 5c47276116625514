/// tandem-render renders frames of a scene to image files. docs/images.md describes formats, names and resuming.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "common/arguments.h"
#include "common/run_main.h"
#include "render/interrupt.h"
#include "render/render_command.h"
#include "tandem/backends/make_backend.h"
#include "tandem/base/error.h"
#include "tandem/base/version.h"
#include "tandem/effects/names.h"
#include "tandem/film/plane_names.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/scene/framing.h"
#include "tandem/scene/named_scenes.h"
#include "tandem/scene/read_environment.h"

namespace {

using namespace tandem;

/// Arguments that need more than a conversion.
struct Words {
    std::string size = "1000x900";
    int frame = 0;
    std::string frames;  // empty: the one above
    std::string tier = "strict";
    std::string effects;
    std::string limits = to_string(PathLimits{});
    std::string planes;  // empty: the colour alone
    std::string light = "default";
    std::string environment;  // a file; empty: the background of the scene
    bool indirect = false;
    double rotation = 0;  // of its picture, degrees
    float intensity = 1;
    std::string backend = "cpu";
    std::string specialise = "always";
    int instants = 0;                               // 0: as the cameras say
    std::optional<std::string> exposure, transfer;  // as the scene says if not given
};

void declare(CLI::App& app, RenderCommand& command, Words& words, BackendOptions& backend) {
    // Input, output and frames
    SequenceOptions& sequence = command.sequence;
    std::string scenes;
    for (const std::string& name : scene_names()) scenes += " named:" + name;
    app.set_version_flag("--version", version());
    app.add_option("SCENE", command.scene, "glTF file, or a built-in scene:" + scenes)->required();
    app.add_option("-o,--output", sequence.output,
                   "image file: .png, .ppm, .pfm or .exr; %04d or #### in the name stands for the frame number")
        ->required();
    app.add_option("--size", words.size, "width and height in pixels")->type_name("WxH")->capture_default_str();
    auto* const samples =
        app.add_option("--spp", sequence.job.samples,
                       "samples per pixel; if not given, fewer where large primitives overlap (docs/images.md)")
            ->capture_default_str();
    app.add_option("--seed", sequence.job.seed, "seed of the random numbers")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    auto* const frame = app.add_option("--frame", words.frame, "frame to render")
                            ->type_name("K")
                            ->check(CLI::NonNegativeNumber)
                            ->capture_default_str();
    app.add_option("--frames", words.frames, "frames A to B, both included, or the whole animation")
        ->type_name("A-B|all")
        ->excludes(frame);
    // Camera and lights
    app.add_option("--camera", sequence.camera,
                   "name of a camera's node or, if no camera has that name, a view of the whole scene: " +
                       view_names() + ". Default: the scene's first camera, or auto if there is none")
        ->type_name("NAME");
    app.add_option("--light", words.light,
                   "lights for a file without any: default adds a background, a light from the upper left of the "
                   "camera and one from the camera; none adds nothing")
        ->check(CLI::IsMember({"default", "none"}))
        ->capture_default_str();
    auto* const picture =
        app.add_option(
               "--env", words.environment,
               "light the scene by an equirectangular picture of its environment: .hdr, .exr or .pfm. It replaces "
               "the background and the default lights")
            ->type_name("FILE");
    app.add_option("--env-rotation", words.rotation,
                   "rotation of that picture about the vertical axis, counter-clockwise as seen from above, in degrees")
        ->type_name("DEG")
        ->needs(picture)
        ->check(CLI::Range(-36000.0, 36000.0))
        ->capture_default_str();
    app.add_option("--env-intensity", words.intensity, "factor of that picture's values")
        ->type_name("X")
        ->needs(picture)
        ->check(CLI::Range(0.0F, most_environment_intensity))
        ->capture_default_str();
    // What to simulate
    app.add_option(
        "--effects", words.effects,
        "force effects on or off, as in -shadows,+refraction; or all, or none. Default: the effects that the "
        "scene needs");
    app.add_option("--shutter-instants", words.instants,
                   "number of instants at which a frame with an open shutter is rendered, at most one per sample. "
                   "Default: that of the camera")
        ->type_name("N")
        ->check(CLI::Range(1, 1024));
    auto* const limits =
        app.add_option(
               "--limits", words.limits,
               "limits of the reflections, refractions and diffuse bounces of a path; if not given, lower where "
               "very many large primitives overlap (docs/images.md)")
            ->type_name("R,T,D")
            ->capture_default_str();
    app.callback([&sequence, samples, limits] {
        sequence.fewer_samples = samples->empty();
        sequence.shorter_paths = limits->empty() && samples->empty();
    });
    std::string planes;
    for (const PlaneInfo& info : plane_infos()) planes += std::string("; ") + info.name + ": " + info.help;
    app.add_option("--aov", words.planes,
                   "planes to write beside the colour, separated by commas, or all: layers of a .exr file, or files "
                   "beside a .pfm file" +
                       planes)
        ->type_name("LIST");
    app.add_flag("--indirect", words.indirect,
                 "simulate indirect light instead of ambient light, even if the file does not ask for it");
    // How to render
    app.add_option("--backend", words.backend, "backend: cpu, cuda or oracle")->capture_default_str();
    app.add_option("--tier", words.tier, "accuracy tier: fast, strict or precise")->capture_default_str();
    app.add_option("--threads", backend.threads, "threads of the CPU backends; 0 is one per core")
        ->check(CLI::Range(0, 4096))
        ->capture_default_str();
    app.add_option("--specialise", words.specialise, "whether to link a GPU kernel for the scene: always or never")
        ->capture_default_str();
    // Files and messages
    app.add_option(
           "--exposure", words.exposure,
           "exposure of .png and .ppm in stops, each of which doubles the brightness; auto derives it from the first "
           "frame. Default: that of the scene")
        ->type_name("STOPS|auto");
    app.add_option("--transfer", words.transfer,
                   "transfer function of .png and .ppm: srgb or linear. Default: that of the scene")
        ->type_name("srgb|linear");
    app.add_option("--json", command.json, "write times, hashes and counts to a JSON file; - is standard output");
    app.add_flag("--ppm-text", sequence.write.ppm_text, "write .ppm as text (P3) instead of binary (P6)");
    app.add_option("--png-level", sequence.write.png_level, "compression level of .png, 0 to 9; 1 is the fast one")
        ->check(CLI::Range(0, 9))
        ->capture_default_str();
    app.add_flag("--force", sequence.force, "render every frame, even if its file exists with the same metadata");
    app.add_flag("--quiet", command.quiet, "print only errors");
}

/// The picture of --env, if there is one.
std::optional<EnvironmentImage> environment_of(const Words& words, bool quiet) {
    if (words.environment.empty()) return std::nullopt;
    EnvironmentFile file = read_environment(words.environment);
    if (file.negative_texels > 0 && !quiet) {
        std::fprintf(stderr, "tandem-render: '%s' has %zu texels with negative values, which become 0\n",
                     words.environment.c_str(), file.negative_texels);
    }
    return EnvironmentImage{std::move(file.picture), words.rotation * (pi / 180), words.intensity};
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

/// Prints everything in the file that is not rendered as specified; tandem-gltf info prints the whole report.
void print_import_notes(const ImportReport& report) {
    for (const ImportNote& note : report.notes()) {
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
    CLI::App app("Renders frames of a scene and prints the SHA-256 of each film.");
    RenderCommand command;
    Words words;
    BackendOptions backend_options;
    declare(app, command, words, backend_options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    const auto [width, height] = parse_size(words.size);
    SequenceOptions& sequence = command.sequence;
    sequence.job.width = width;
    sequence.job.height = height;
    sequence.job.tier = parse_tier(words.tier);
    sequence.job.limits = parse_limits(words.limits);
    sequence.effects = parse_effects(words.effects);
    if (!words.planes.empty()) sequence.job.planes = parse_planes(words.planes);
    if (words.exposure) sequence.exposure = parse_exposure(*words.exposure);
    if (words.transfer) sequence.transfer = parse_transfer(*words.transfer);
    check(sequence.job);

    const std::atomic<bool>& interrupted = watch_interrupts();
    ImportReport import;
    std::optional<EnvironmentImage> environment = environment_of(words, command.quiet);
    Scene scene = load_scene(command.scene, &import,
                             {.camera = sequence.camera,
                              .aspect = aspect_of({width, height}),
                              .default_light = words.light == "default" && !environment});
    if (environment) light_by(scene, *std::move(environment));
    if (words.indirect) {
        scene.indirect_light = true;
        scene.environment.ambient = {0, 0, 0};
    }
    if (words.instants > 0) set_shutter_instants(scene, words.instants);
    if (!command.quiet) print_import_notes(import);
    sequence.frames = frames_of(words, scene);
    check_output(sequence);
    if (!command.quiet) print_ignored_display_options(sequence);
    backend_options.specialise = parse_specialise(words.specialise);
    const std::unique_ptr<Backend> backend = make_backend(words.backend, backend_options);
    return run_render(command, scene, *backend, interrupted);
}

}  // namespace

int main(int argc, char** argv) {
    return tandem::run_main("tandem-render", [&] { return render(argc, argv); });
}
