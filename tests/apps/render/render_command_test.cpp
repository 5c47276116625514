#include "render/render_command.h"

#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "render/interrupt.h"
#include "support/gradient_backend.h"
#include "support/temporary_folder.h"
#include "tandem/base/error.h"
#include "tandem/render/combined_backend.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using namespace test;

class RenderCommandTest : public testing::Test {
  protected:
    RenderCommandTest() {
        command.scene = "named:paper";
        command.sequence.output = folder.file("f#.ppm");
        command.sequence.frames = {0, 2};
        command.sequence.job.width = 8;
        command.sequence.job.height = 8;
        command.sequence.write.durability = Durability::written;
    }

    /// What a run prints to standard output and to standard error.
    struct Printed {
        int status;
        std::string out, err;
    };
    Printed run(const std::atomic<bool>& interrupted) {
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        const int status = run_render(command, scene, backend, interrupted);
        return {status, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
    }
    Printed run() { return run(std::atomic<bool>(false)); }

    std::string line(std::uint32_t frame, const char* more) {
        RenderJob job = command.sequence.job;
        job.frame = frame;
        const std::string number = std::to_string(frame);
        return "frame " + number + "  " + film_hash(gradient_film(job)) + "  " + folder.file("f" + number + ".ppm") +
               more + "\n";
    }

    TemporaryFolder folder;
    Scene scene = named_scene("paper");
    GradientBackend backend;
    RenderCommand command;
};

TEST_F(RenderCommandTest, PrintsTheHashOfEveryFrame) {
    const Printed first = run();
    EXPECT_EQ(first.status, 0);
    EXPECT_EQ(first.out, line(0, "") + line(1, "  1 samples were NaN or infinite and left out") +
                             line(2, "  2 samples were NaN or infinite and left out"));
    EXPECT_EQ(first.err, "") << "no progress bar where there is no terminal";
    EXPECT_EQ(run().out, line(0, "  kept") + line(1, "  kept") + line(2, "  kept"));
}

TEST_F(RenderCommandTest, QuietPrintsNothing) {
    command.quiet = true;
    const Printed printed = run();
    EXPECT_EQ(printed.out + printed.err, "");
    EXPECT_EQ(folder.names().size(), 3U);
}

TEST_F(RenderCommandTest, SaysOnceWhichExposureItFound) {
    command.sequence.exposure = ExposureChoice{.automatic = true};
    const Printed first = run();
    std::ostringstream number;  // a tenth of a stop is short enough for it
    number << read_metadata(folder.file("f0.ppm"))->exposure_stops;
    const std::string stops = number.str();
    EXPECT_EQ(first.err, "tandem-render: the exposure is " + stops + " stops, derived from frame 0; --exposure " +
                             stops + " gives the same result\n");
    EXPECT_EQ(first.out, line(0, "") + line(1, "  1 samples were NaN or infinite and left out") +
                             line(2, "  2 samples were NaN or infinite and left out"));
    EXPECT_EQ(run().err, "tandem-render: the exposure is " + stops + " stops, taken from '" + folder.file("f0.ppm") +
                             "'; --exposure " + stops + " gives the same result\n");
    command.quiet = true;
    EXPECT_EQ(run().err, "");
}

TEST_F(RenderCommandTest, JsonOnStandardOutputStandsAlone) {
    command.json = "-";
    const auto json = nlohmann::json::parse(run().out);
    EXPECT_EQ(json["program"], "tandem-render");
    EXPECT_EQ(json["scene"], "named:paper");
    EXPECT_EQ(json["backend"], "gradient");
    EXPECT_EQ(json["interrupted"], false);
    ASSERT_EQ(json["frames"].size(), 3U);
    const auto& frame = json["frames"][2];
    EXPECT_EQ(frame["frame"], 2);
    EXPECT_EQ(frame["file"], folder.file("f2.ppm"));
    EXPECT_EQ(frame["film_sha256"].get<std::string>().size(), 64U);
    EXPECT_EQ(frame["scene_hash"].get<std::string>().size(), 64U);
    EXPECT_EQ(frame["width"], 8);
    EXPECT_EQ(frame["height"], 8);
    EXPECT_EQ(frame["samples"], 100);
    EXPECT_EQ(frame["seed"], 0);
    EXPECT_EQ(frame["tier"], "strict");
    EXPECT_EQ(frame["backend"], "gradient");
    EXPECT_EQ(frame["invalid_samples"], 2);
    EXPECT_EQ(frame["skipped"], false);
    EXPECT_EQ(frame["seconds"]["render"], 0.5);
    for (const char* phase : {"prepare", "build", "upload", "download", "hash", "encode", "write"}) {
        EXPECT_TRUE(frame["seconds"][phase].is_number()) << phase;
    }
    EXPECT_EQ(nlohmann::json::parse(run().out)["frames"][0]["skipped"], true);
}

TEST_F(RenderCommandTest, JsonInAFileKeepsTheLines) {
    command.json = folder.file("report.json");
    EXPECT_FALSE(run().out.empty());
    const Bytes bytes = read_file(command.json);
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    EXPECT_EQ(nlohmann::json::parse(text, text + bytes.size())["frames"].size(), 3U);
}

TEST_F(RenderCommandTest, JsonSaysWhichMembersTookWhichShare) {
    command.json = "-";
    EXPECT_FALSE(nlohmann::json::parse(run().out).contains("members")) << "of a single backend";
    command.sequence.force = true;
    std::vector<CombinedMember> members;
    members.push_back({"GPU 0", std::make_unique<GradientBackend>()});
    auto bad = std::make_unique<GradientBackend>();
    bad->on_get = [](const RenderJob&) { throw EnvironmentError("the memory is full"); };
    members.push_back({"GPU 1", std::move(bad)});
    const auto combined = make_combined_backend(std::move(members));
    testing::internal::CaptureStdout();
    EXPECT_EQ(run_render(command, scene, *combined, std::atomic<bool>(false)), 0);
    const auto json = nlohmann::json::parse(testing::internal::GetCapturedStdout());
    ASSERT_EQ(json["members"].size(), 2U);
    EXPECT_EQ(json["members"][0]["name"], "GPU 0");
    EXPECT_EQ(json["members"][0]["device"], "no device");
    EXPECT_EQ(json["members"][0]["samples"], 3 * 8 * 8 * 100);
    EXPECT_EQ(json["members"][0]["share"], 1.0);
    EXPECT_EQ(json["members"][1]["samples"], 0);
    const bool has_failed = json["members"][1].contains("failure");  // it had work only if it was as quick
    EXPECT_EQ(has_failed, json["frames"].dump().find("GPU 1 failed") != std::string::npos);
}

TEST_F(RenderCommandTest, ASignalStopsAfterTheFramesInFlight) {
    for (const int signal : {SIGINT, SIGTERM}) {
        command.sequence.force = true;
        command.json = folder.file("report.json");
        const std::atomic<bool>& interrupted = watch_interrupts();
        backend.on_submit = [&](const RenderJob& job) {
            if (job.frame == 1) std::raise(signal);
        };
        const Printed printed = run(interrupted);
        EXPECT_EQ(printed.status, 130);
        EXPECT_NE(printed.err.find("finishing what is in progress"), std::string::npos) << printed.err;
        EXPECT_NE(printed.err.find("2 of 3 frames are done. Run the same command again without --force"),
                  std::string::npos)
            << printed.err;
        EXPECT_EQ(folder.names(), (std::vector<std::string>{"f0.ppm", "f1.ppm", "report.json"}));
        const Bytes bytes = read_file(command.json);
        const auto* text = reinterpret_cast<const char*>(bytes.data());
        EXPECT_EQ(nlohmann::json::parse(text, text + bytes.size())["interrupted"], true);
    }
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

TEST(InterruptDeathTest, ASecondSignalEndsTheProgram) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto twice = [] {
        (void)watch_interrupts();
        std::raise(SIGINT);
        std::raise(SIGINT);
    };
    EXPECT_EXIT(twice(), testing::KilledBySignal(SIGINT), "finishing");
}

TEST(InterruptDeathTest, AnIgnoredSignalStaysIgnored) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto ignored = [] {
        std::signal(SIGINT, SIG_IGN);
        const std::atomic<bool>& interrupted = watch_interrupts();
        std::raise(SIGINT);
        std::exit(interrupted ? 1 : 0);
    };
    EXPECT_EXIT(ignored(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace tandem
