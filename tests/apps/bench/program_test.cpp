// The program itself: exit statuses, and what goes to which stream.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/temporary_folder.h"
#include "tandem/backends/make_backend.h"

namespace tandem::bench {
namespace {

struct Outcome {
    int status = -1;
    std::string output;
};

/// Runs tandem-bench with `arguments`; standard error is dropped.
Outcome run_bench(const std::string& arguments) {
    Outcome outcome;
    std::FILE* pipe = popen((std::string(TANDEM_BENCH) + " " + arguments + " 2>/dev/null").c_str(), "r");
    if (pipe == nullptr) return outcome;
    std::array<char, 4096> part{};
    while (std::fgets(part.data(), part.size(), pipe) != nullptr) outcome.output += part.data();
    const int status = pclose(pipe);
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
}

TEST(BenchProgram, BadUsageIsStatusTwo) {
    for (const char* arguments : {"",
                                  "nonsense",
                                  "versus --size 12",
                                  "versus named:nothing",
                                  "parity --frames 5-4",
                                  "versus --rays parallel",
                                  "versus --backends tape",
                                  "targets --only nothing",
                                  "paper --spp 0",
                                  "hard --cases Z1",
                                  "hard --check /nowhere/answers",
                                  "hard --rays 1",
                                  "effects",
                                  "coverage",
                                  "coverage named:paper --metric psnr",
                                  "effects /nowhere/scene.gltf",
                                  "effects named:paper --tier sloppy",
                                  "effects named:paper --repetitions 0",
                                  "accuracy --vary colour",
                                  "accuracy --seeds 1",
                                  "accuracy --parts all",
                                  "accuracy closed:furnace/100",
                                  "accuracy --samples 0",
                                  "accuracy --rebuild-references"}) {
        EXPECT_EQ(run_bench(arguments).status, 2) << arguments;
    }
}

TEST(BenchProgram, HelpAndListsAreStatusZero) {
    for (const char* arguments : {"--help", "parity --help", "versus --help", "paper --help", "targets --help",
                                  "hard --help", "effects --help", "accuracy --help", "accuracy --list"}) {
        EXPECT_EQ(run_bench(arguments).status, 0) << arguments;
    }
    const Outcome list = run_bench("targets --list");
    EXPECT_EQ(list.status, 0);
    EXPECT_NE(list.output.find("gpu-share"), std::string::npos);
}

TEST(BenchProgram, JsonOnStandardOutputIsAllThereIs) {
    const Outcome outcome =
        run_bench("versus named:paper --backends cpu --size 20x18 --spp 1 --repetitions 3 --json -");
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    const auto json = nlohmann::json::parse(outcome.output);
    EXPECT_EQ(json["rows"][0]["backend"], "cpu");
    EXPECT_EQ(json["rows"][0]["seconds"].size(), 3U);
    EXPECT_EQ(json["command"],
              "tandem-bench versus named:paper --backends cpu --size 20x18 --spp 1 --repetitions 3 --json -");
}

TEST(BenchProgram, EffectsOfAScenePassAndSayTheirPrice) {
    const Outcome outcome =
        run_bench("effects " TANDEM_SCENES "/mirrors.gltf --backends cpu --size 16x12 --spp 1 --repetitions 1");
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    for (const char* part : {"without reflection", "shadows alone", "Mean FLIP", "The price of not specialising"}) {
        EXPECT_NE(outcome.output.find(part), std::string::npos) << part << "\n" << outcome.output;
    }
}

TEST(BenchProgram, AccuracySweepsASceneAndKeepsItsReferences) {
    const test::TemporaryFolder folder;
    const std::string command =
        "accuracy named:paper --backends cpu --vary samples,tier,tessellation,rasterised --size 20x18 --samples 1,4 "
        "--seeds 6 --references " +
        folder.file("references") + " --json -";
    const Outcome outcome = run_bench(command);
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    const auto json = nlohmann::json::parse(outcome.output);
    EXPECT_EQ(json["rows"].size(), 2U * (3 + 3 + 1)) << "three tiers, three tessellations and the rasteriser";
    EXPECT_GT(json["rows"][0]["figures"]["RMSE"], 0);
    EXPECT_EQ(json["rows"][0]["series"]["mean FLIP"].size(), 6U);
    EXPECT_TRUE(std::filesystem::exists(folder.file("references/named_paper-20x18-a.pfm.txt")));
    EXPECT_EQ(run_bench(command + " --reference-samples 3").status, 2) << "they have another number of samples";
    EXPECT_EQ(run_bench(command + " --reference-samples 3 --rebuild-references").status, 0);
    EXPECT_EQ(run_bench(command + " --reference-samples 3").status, 0);
}

TEST(BenchProgram, WithoutAGpuCudaAloneIsStatusThree) {
    if (why_unavailable("cuda").empty()) GTEST_SKIP() << "there is a GPU";
    EXPECT_EQ(run_bench("versus --backends cuda --size 20x18 --spp 1").status, 3);
}

TEST(BenchProgram, ParityOfTheRealBackendsHolds) {
    const Outcome outcome = run_bench("parity named:paper named:mixed/50 --frames 0-1 --size 40x36 --spp 2");
    EXPECT_EQ(outcome.status, 0) << outcome.output;
}

}  // namespace
}  // namespace tandem::bench
