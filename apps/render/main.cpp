/// tandem-render: frames of a scene as image files. docs/images.md has the formats, names and resumption.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>

#include "common/arguments.h"
#include "common/run_main.h"
#include "render/interrupt.h"
#include "render/render_command.h"
#include "tandem/backends/make_backend.h"
#include "tandem/base/error.h"
#include "tandem/base/version.h"
#include "tandem/effects/names.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/scene/framing.h"
#include "tandem/scene/named_scenes.h"

namespace {

using namespace tandem;

/// What is typed and needs more than a conversion.
struct Words {
    std::string size = "1000x900";
    int frame = 0;
    std::string frames;  // empty: the one above
    std::string tier = "strict";
    std::string effects;
    std::string limits = to_string(PathLimits{});
    std::string light = "default";
    std::string backend = "cpu";
    std::string specialise = "always";
    int instants = 0;                               // 0: as the cameras say
    std::optional<std::string> exposure, transfer;  // as the scene says if not given
};

void declare(CLI::App& app, RenderCommand& command, Words& words, BackendOptions& backend) {
    SequenceOptions& sequence = command.sequence;
    std::string scenes;
    for (const std::string& name : scene_names()) scenes += " named:" + name;
    app.set_version_flag("--version", version());
    app.add_option("SCENE", command.scene, "a glTF file, or one of" + scenes)->required();
    app.add_option("-o,--output", sequence.output,
                   "image file: .png, .ppm, .pfm or .exr; the name may hold the frame number as %04d or ####")
        ->required();
    app.add_option("--size", words.size, "width and height in pixels")->type_name("WxH")->capture_default_str();
    auto* const samples = app.add_option("--spp", sequence.job.samples,
                                         "samples per pixel; if not given, fewer where rays are very much work")
                              ->capture_default_str();
    app.callback([&sequence, samples] { sequence.fewer_samples = samples->empty(); });
    app.add_option("--seed", sequence.job.seed, "of the random numbers")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    auto* const frame = app.add_option("--frame", words.frame, "one frame")
                            ->type_name("K")
                            ->check(CLI::NonNegativeNumber)
                            ->capture_default_str();
    app.add_option("--frames", words.frames, "from A to B, both included, or all of the animation")
        ->type_name("A-B|all")
        ->excludes(frame);
    app.add_option("--camera", sequence.camera,
                   "name of the camera's node, or a view of the whole scene where no camera has that name: " +
                       view_names() + ". If not given, the scene's first camera, or auto where there is none")
        ->type_name("NAME");
    app.add_option("--light", words.light,
                   "what lights a file in which nothing gives light: default, a sky and a light from the upper left of "
                   "the camera; or none")
        ->check(CLI::IsMember({"default", "none"}))
        ->capture_default_str();
    app.add_option("--effects", words.effects,
                   "force effects on or off, as in -shadows,+refraction; all or none. What the scene calls for if not "
                   "given");
    app.add_option("--shutter-instants", words.instants,
                   "at how many moments of an open shutter a frame is rendered, but no more than samples; what the "
                   "camera says if not given")
        ->type_name("N")
        ->check(CLI::Range(1, 1024));
    app.add_option("--limits", words.limits, "how often a path may be reflected, refracted and scattered")
        ->type_name("R,T,D")
        ->capture_default_str();
    app.add_option("--backend", words.backend, "cpu, cuda or oracle")->capture_default_str();
    app.add_option("--tier", words.tier, "accuracy tier")->capture_default_str();
    app.add_option("--threads", backend.threads, "of the CPU backends; 0: one per core")
        ->check(CLI::Range(0, 4096))
        ->capture_default_str();
    app.add_option("--specialise", words.specialise, "GPU: make a kernel for the scene always, or never")
        ->capture_default_str();
    app.add_option(
           "--exposure", words.exposure,
           "of .png and .ppm: stops by which the picture is made brighter, or auto: the first frame decides for "
           "all; what the scene says if not given")
        ->type_name("STOPS|auto");
    app.add_option(
           "--transfer", words.transfer,
           "of .png and .ppm: the function from light to the values of the file, srgb or linear; what the scene "
           "says if not given")
        ->type_name("srgb|linear");
    app.add_option("--json", command.json, "write times, hashes and counts there; - is standard output");
    app.add_flag("--ppm-text", sequence.write.ppm_text, "write .ppm as P3 text instead of P6");
    app.add_option("--png-level", sequence.write.png_level, "compression of .png, 0 to 9")
        ->check(CLI::Range(0, 9))
        ->capture_default_str();
    app.add_flag("--force", sequence.force, "render frames again whose files are there with the same metadata");
    app.add_flag("--quiet", command.quiet, "print no lines and no progress, only errors");
}

FrameRange frames_of(const Words& words, const Scene& scene) {
    if (words.frames.empty()) return {words.frame, words.frame};
    if (words.frames != "all") return parse_frames(words.frames);
    const std::int32_t count = frame_count(scene);
    if (count == std::numeric_limits<std::int32_t>::max()) {
        throw InputError(
            "--frames all: the animation has no last frame that could be numbered; name frames, as in 0-99");
    }
    return {0, count - 1};
}

/// Nothing that a file asks for is left out in silence; tandem-gltf info has the whole report.
void say_what_is_not_rendered(const ImportReport& report) {
    for (const ImportNote& note : report.notes()) {
        if (note.treatment == Treatment::rendered) continue;
        std::fprintf(stderr, "tandem-render: %s\n", to_string(note).c_str());
    }
}

void say_what_the_format_leaves_out(const SequenceOptions& options) {
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
    if (words.exposure) sequence.exposure = parse_exposure(*words.exposure);
    if (words.transfer) sequence.transfer = parse_transfer(*words.transfer);
    check(sequence.job);

    const std::atomic<bool>& interrupted = watch_interrupts();
    ImportReport import;
    Scene scene = load_scene(
        command.scene, &import,
        {.camera = sequence.camera, .aspect = aspect_of({width, height}), .default_light = words.light == "default"});
    if (words.instants > 0) set_shutter_instants(scene, words.instants);
    if (!command.quiet) say_what_is_not_rendered(import);
    sequence.frames = frames_of(words, scene);
    check_output(sequence);
    if (!command.quiet) say_what_the_format_leaves_out(sequence);
    backend_options.specialise = parse_specialise(words.specialise);
    const std::unique_ptr<Backend> backend = make_backend(words.backend, backend_options);
    return run_render(command, scene, *backend, interrupted);
}

}  // namespace

int main(int argc, char** argv) {
    return tandem::run_main("tandem-render", [&] { return render(argc, argv); });
}
