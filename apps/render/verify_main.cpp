#include "render/verify_main.h"

#include <CLI/CLI.hpp>
#include <limits>
#include <random>

#include "common/choose_gpus.h"
#include "common/run_main.h"
#include "render/verify_command.h"
#include "tandem/backends/make_backend.h"
#include "tandem/base/parallel.h"

namespace tandem {

int verify(int argc, char** argv) {
    CLI::App app(
        "Renders random tiles of an image again from its metadata, and reports whether they match: bits for "
        ".exr and .pfm, 8-bit values for .png and .ppm. Status 0: they match, 1: they differ.",
        "tandem-render verify");
    VerifyCommand command;
    BackendOptions backend_options;
    std::string backend = "cpu", gpus;
    bool all = false;
    app.add_option("IMAGE", command.image, "image that tandem-render wrote")->required();
    app.add_option("SCENE", command.scene, "its scene, if it is not where the image says")->capture_default_str();
    app.add_option("--env", command.environment, "the picture of its environment, if it is not where the image says")
        ->type_name("FILE");
    auto* const tiles = app.add_option("--tiles", command.how.tiles, "number of tiles to render")
                            ->check(CLI::Range(1, std::numeric_limits<int>::max()))
                            ->capture_default_str();
    app.add_flag("--all", all, "render every tile, and check the hash of the film")->excludes(tiles);
    auto* const pick = app.add_option("--pick", command.how.seed, "seed of the choice of tiles; random by default")
                           ->check(CLI::NonNegativeNumber);
    app.add_option("--backend", backend, "backend: cpu, cuda or oracle; cuda:1 is the GPU of that number")
        ->capture_default_str();
    app.add_option("--gpus", gpus, "GPUs of the backend cuda: all, how many, or a list of numbers such as 0,1")
        ->type_name("all|N|LIST");
    app.add_option("--threads", backend_options.threads,
                   "threads for the CPU backends and for preparing scenes; 0 is one per core")
        ->check(CLI::Range(0, 4096))
        ->capture_default_str();
    app.add_flag("--quiet", command.quiet, "print only differences and errors");
    try {
        app.parse(argc - 1, argv + 1);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exit_done : exit_bad_input;
    }
    if (all) command.how.tiles = std::numeric_limits<std::size_t>::max();
    if (pick->empty()) command.how.seed = std::random_device{}();
    choose_gpus(backend_options, gpus, "tandem-render");
    set_thread_limit(backend_options.threads);
    return run_verify(command, *make_backend(backend, backend_options));
}

}  // namespace tandem
