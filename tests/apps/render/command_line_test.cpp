/// The program itself, as far as it goes without rendering.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "run_render.h"
#include "support/temporary_folder.h"
#include "tandem/base/version.h"
#include "tandem/base/whole_file.h"
#include "tandem/images/image_io.h"

namespace tandem {
namespace {

using test::Finished;
using test::tandem_render;

TEST(CommandLine, HelpAndVersion) {
    const Finished help = tandem_render("--help");
    EXPECT_EQ(help.status, 0);
    for (const char* word :
         {"SCENE",      "--frames",       "--ppm-text",    "--force",        "--shutter-instants", "--exposure",
          "--transfer", "--aov",          "albedo",        "--env",          "named:paper",        "--checkpoint",
          "--resume",   "--target-error", "--time-budget", "--plan",         "--denoise",          "verify",
          "--sampler",  "sobol_blue",     "--filter",      "blackman_harris"}) {
        EXPECT_NE(help.printed.find(word), std::string::npos) << word;
    }
    const Finished shown = tandem_render("--version");
    EXPECT_EQ(shown.status, 0);
    EXPECT_NE(shown.printed.find(version()), std::string::npos);
}

TEST(CommandLine, BadUsageIsStatusTwoAndNamesTheReason) {
    const test::TemporaryFolder folder;
    const std::string out = " -o '" + folder.file("a.png") + "'";
    const std::string picture_of_bytes = folder.file("sky.png");
    write_image(picture_of_bytes, FloatImage{1, 1, {{1, 1, 1}}}, {});
    const std::string lit_by_bytes = "named:paper --env '" + picture_of_bytes + "'";
    using Case = std::pair<std::string, const char*>;
    for (const auto& [arguments, reason] :
         {Case{"", "SCENE"},
          Case{"named:paper", "--output"},
          Case{"named:paper --nonsense" + out, "nonsense"},
          Case{"named:paper --size 10" + out, "--size"},
          Case{"named:paper --size 0x10" + out, "--size"},
          Case{"named:paper --spp 0" + out, "samples"},
          Case{"named:paper --spp many" + out, "--spp"},
          Case{"named:paper --seed -1" + out, "--seed"},
          Case{"named:paper --frame -1" + out, "--frame"},
          Case{"named:paper --frames 3-1" + out, "--frames"},
          Case{"named:paper --frame 1 --frames 1-2" + out, "--frame"},
          Case{"named:paper --frames 0-1" + out, "frame number"},
          Case{"named:paper --tier best" + out, "best"},
          Case{"named:paper --sampler halton" + out, "the samplers are random, sobol, sobol_blue"},
          Case{"named:paper --filter sinc" + out, "the filters are box, tent, gaussian, blackman_harris"},
          Case{"named:paper --sampler sobol --target-error 0.1" + out, "use --sampler random"},
          Case{"named:paper --sampler sobol --time-budget 9" + out, "use --sampler random"},
          Case{"named:paper --sampler sobol --aov variance -o '" + folder.file("a.pfm") + "'", "variance"},
          Case{"named:paper --backend abacus" + out, "abacus"},
          Case{"named:paper --backend cuda --gpus none" + out, "--gpus: GPUs are chosen by"},
          Case{"named:paper --backend cpu --gpus 0,1" + out, "'cpu' has none"},
          Case{"named:paper --backend cuda:1 --gpus 2" + out, "already names"},
          Case{"named:paper --backend cuda:one" + out, "cuda:1 is GPU 1"},
          Case{"named:nothing" + out, "nothing"},
          Case{"named:paper -o a.jpg", ".png"},
          Case{"named:paper -o '" + folder.file("none/a.png") + "'", "none"},
          Case{"named:paper --threads -1" + out, "--threads"},
          Case{"named:paper --resume" + out, "--checkpoint"},
          Case{"named:paper --checkpoint a --checkpoint-every -1" + out, "--checkpoint-every"},
          Case{"named:paper --checkpoint '" + folder.file("none/c") + "'" + out, "no folder"},
          Case{"named:paper --target-error 0" + out, "--target-error"},
          Case{"named:paper --target-error 0.1 --spp 1" + out, "allow 2 or more"},
          Case{"named:paper --target-error 0.1 --metric psnr" + out, "psnr"},
          Case{"named:paper --metric relmse" + out, "--target-error"},
          Case{"named:paper --time-budget -1" + out, "--time-budget"},
          Case{"verify", "IMAGE"},
          Case{"verify '" + folder.file("none.png") + "'", "none.png"},
          Case{"verify '" + picture_of_bytes + "'", "cannot verify"},
          Case{"verify '" + picture_of_bytes + "' --all --tiles 3", "--all"},
          Case{"named:paper --env '" + folder.file("none.hdr") + "'" + out, "none.hdr"},
          Case{lit_by_bytes + out, "8 bits"},
          Case{"named:paper --env-rotation 90" + out, "--env"},
          Case{"named:paper --env a.hdr --env-intensity -1" + out, "--env-intensity"},
          Case{"named:paper --exposure bright" + out, "--exposure is 'bright'"},
          Case{"named:paper --exposure -101" + out, "--exposure is '-101'"},
          Case{"named:paper --exposure ''" + out, "--exposure"},
          Case{"named:paper --transfer gamma" + out, "'gamma'"},
          Case{"named:paper --camera under" + out, "front, back, left"},
          Case{"named:paper --light dim" + out, "--light"},
          Case{"named:paper --aov light" + out, "'light'"},
          Case{"named:paper --aov depth" + out, "a .pfm, with one file for each"},
          Case{"named:paper --aov variance --spp 1 -o '" + folder.file("a.pfm") + "'", "raise --spp"},
          Case{"named:paper --png-level 10" + out, "--png-level"}}) {
        const Finished run = tandem_render(arguments);
        EXPECT_EQ(run.status, 2) << arguments << "\n" << run.printed;
        EXPECT_NE(run.printed.find(reason), std::string::npos) << arguments << "\n" << run.printed;
    }
    EXPECT_EQ(folder.names().size(), 1U) << "picture_of_bytes alone";
}

// The film is the picture, turned and scaled, and the lights of a file without light are not added.
TEST(CommandLine, LightsByAPicture) {
    const test::TemporaryFolder folder;
    const std::string sky = folder.file("sky.pfm"), out = folder.file("a.pfm"), file = folder.file("a.gltf");
    write_image(sky, FloatImage{2, 1, {{1, 2, 4}, {1, 2, 4}}}, {});
    write_file(file, R"({"asset": {"version": "2.0"}, "nodes": [{"camera": 0}], "scenes": [{"nodes": [0]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}]})");
    const Finished run = tandem_render("'" + file + "' --env '" + sky +
                                       "' --env-rotation 30 --env-intensity 2 --size 4x3 --spp 1 -o '" + out + "'");
    EXPECT_EQ(run.status, 0) << run.printed;
    EXPECT_EQ(run.printed.find("no light"), std::string::npos) << run.printed;
    const FloatImage film = read_image(out).image;
    for (const Vec3f& pixel : film.pixels) EXPECT_EQ(pixel, Vec3f(2, 4, 8));
}

// A file that asks for indirect light, and the same without that line.
TEST(CommandLine, AsksForIndirectLight) {
    const test::TemporaryFolder folder;
    std::ifstream stored(std::string(TANDEM_SOURCE_DIR) + "/assets/scenes/metals.gltf");
    std::string text((std::istreambuf_iterator<char>(stored)), std::istreambuf_iterator<char>());
    const auto hash_of = [&](const char* name, const std::string& options) {
        write_file(folder.file(name), text);
        const Finished run =
            tandem_render("'" + folder.file(name) + "' --size 8x7 --spp 1 -o '" + folder.file("a.pfm") + "'" + options);
        EXPECT_EQ(run.status, 0) << run.printed;
        const std::size_t at = run.printed.find("frame 0  ");
        return at == std::string::npos ? run.printed : run.printed.substr(at + 9, 64);
    };
    const std::string with = hash_of("with.gltf", "");
    const std::size_t at = text.find("\"indirect\": true");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, 16, "\"indirect\": false");
    EXPECT_NE(hash_of("without.gltf", " --force"), with);
    EXPECT_EQ(hash_of("without.gltf", " --force --indirect"), with);
}

}  // namespace
}  // namespace tandem
