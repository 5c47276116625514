#include "render/verify_main.h"

#include <limits>
#include <random>

#include "common/choose_gpus.h"
#include "common/command_line.h"
#include "common/run_main.h"
#include "render/verify_command.h"
#include "tandem/backends/make_backend.h"
#include "tandem/base/parallel.h"

namespace tandem {

int verify(int argc, char** argv) {
    CommandLine app(
        "Renders random tiles of an image again from its metadata, and reports whether they match: bits for "
        ".exr and .pfm, 8-bit values for .png and .ppm. Status 0: they match, 1: they differ.",
        "tandem-render verify");
    VerifyCommand command;
    BackendOptions backend_options;
    std::string backend = "cpu", gpus;
    bool all = false;
    app.option("IMAGE", &command.image, "image that tandem-render wrote").required();
    app.option("SCENE", &command.scene, "its scene, if it is not where the image says").shows_default();
    app.option("--env", &command.environment, "the picture of its environment, if it is not where the image says")
        .shows_type("FILE");
    const CommandOption tiles = app.option("--tiles", &command.how.tiles, "number of tiles to render")
                                    .within(1, std::numeric_limits<int>::max())
                                    .shows_default();
    app.flag("--all", &all, "render every tile, and check the hash of the film").excludes(tiles);
    const CommandOption pick =
        app.option("--pick", &command.how.seed, "seed of the choice of tiles; random by default").at_least_zero();
    app.option("--backend", &backend, "backend: cpu, cuda or oracle; cuda:1 is the GPU of that number").shows_default();
    app.option("--gpus", &gpus, "GPUs of the backend cuda: all, how many, or a list of numbers such as 0,1")
        .shows_type("all|N|LIST");
    app.option("--threads", &backend_options.threads,
               "threads for the CPU backends and for preparing scenes; 0 is one per core")
        .within(0, 4096)
        .shows_default();
    app.flag("--quiet", &command.quiet, "print only differences and errors");
    if (const auto status = app.parse(argc - 1, argv + 1)) return *status;
    if (all) command.how.tiles = std::numeric_limits<std::size_t>::max();
    if (!pick.is_given()) command.how.seed = std::random_device{}();
    choose_gpus(backend_options, gpus, "tandem-render");
    set_thread_limit(backend_options.threads);
    return run_verify(command, *make_backend(backend, backend_options));
}

}  // namespace tandem
