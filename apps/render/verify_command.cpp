#include "render/verify_command.h"

#include <fmt/format.h>

#include <cstdio>

#include "common/run_main.h"
#include "tandem/base/error.h"
#include "tandem/base/version.h"
#include "tandem/effects/names.h"
#include "tandem/images/image_io.h"

namespace tandem {

namespace {

SceneSource source_of(const VerifyCommand& command, const ImageMetadata& metadata) {
    SceneSource source;
    if (!metadata.scene_source.empty()) source = scene_source_from(metadata.scene_source);
    if (!command.scene.empty()) source.scene = command.scene;
    if (!command.environment.empty()) source.environment = command.environment;
    if (source.scene.empty()) {
        throw InputError("it does not name its scene; give the scene after the image");
    }
    return source;
}

std::string where(const FilmWindow& window) {
    return fmt::format("{} x {} pixels at ({}, {})", window.width, window.height, window.left, window.top);
}

void print(const VerifyCommand& command, const Verdict& verdict, const ImageMetadata& metadata,
           const Backend& backend) {
    std::string text = fmt::format("{}: rendered {} of {} tiles again with {}, {} of {} pixels: ", command.image,
                                   verdict.drawn, verdict.tiles, backend.name(), verdict.drawn_pixels, verdict.pixels);
    if (verdict.differing_pixels > 0) {
        text += fmt::format("{} pixels differ, in {} tiles, such as {}", verdict.differing_pixels,
                            verdict.differing.size(), where(verdict.differing.front()));
    } else if (!verdict.matches()) {
        text += "the pixels match, but the hash of the film differs from that in the metadata";
    } else if (verdict.has_film) {
        text += "all match, and so does the hash of the film";
    } else {
        text += fmt::format(
            "all match. Other tiles may still differ: if more than {:.3g} % did, 95 % of such checks would find one "
            "(--all renders every tile; --pick {} these)",
            100 * verdict.largest_unseen_share(), command.how.seed);
    }
    if (!verdict.matches() && metadata.version != version()) {
        text += fmt::format(". Tandem {} wrote it, and this is {}: bits may change from version to version",
                            metadata.version, version());
    }
    std::puts(text.c_str());
}

}  // namespace

int run_verify(const VerifyCommand& command, Backend& backend) {
    const DecodedImage image = read_image(command.image);
    try {
        const ImageMetadata metadata = image.metadata.value_or(ImageMetadata{});
        if (!image.metadata) throw InputError("it has no metadata of tandem-render");
        const SceneSource source = source_of(command, metadata);
        const double aspect = static_cast<double>(image.image.width) / image.image.height;
        const OpenedScene opened = open_scene(source, aspect);
        const PrepareOptions options{.frame = static_cast<std::int32_t>(metadata.frame),
                                     .camera = source.camera,
                                     .effects = parse_effects(metadata.forced_effects)};
        const Verdict verdict = verify_image(backend, opened.scene, options, image, command.how);
        if (!command.quiet || !verdict.matches()) print(command, verdict, metadata, backend);
        return verdict.matches() ? exit_done : exit_short_of_target;
    } catch (const InputError& error) {
        throw InputError(fmt::format("cannot verify '{}': {}", command.image, error.what()));
    }
}

}  // namespace tandem
