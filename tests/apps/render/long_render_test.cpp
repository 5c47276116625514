// Sequences with checkpoints and targets, and where scenes come from.
#include <gtest/gtest.h>

#include <filesystem>

#include "render/render_sequence.h"
#include "render/scene_source.h"
#include "render/verify_command.h"
#include "support/gradient_backend.h"
#include "support/input_error.h"
#include "support/interrupting_backend.h"
#include "support/noise_backend.h"
#include "support/temporary_folder.h"
#include "tandem/backends/make_backend.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using namespace test;

class LongRender : public testing::Test {
  protected:
    LongRender() {
        options.output = folder.file("a.pfm");
        options.job.width = 1100;
        options.job.height = 8;
        options.job.samples = 4;
        options.write.durability = Durability::written;
    }
    std::size_t render(Backend& backend) {
        records.clear();
        return render_sequence(scene, backend, options, interrupted,
                               [this](const FrameRecord& record) { records.push_back(record); });
    }

    TemporaryFolder folder;
    Scene scene = named_scene("paper");
    SequenceOptions options;
    std::vector<FrameRecord> records;
    std::atomic<bool> interrupted{false};
};

TEST_F(LongRender, AnInterruptedFrameGoesOnFromItsCheckpoint) {
    GradientBackend backend;
    options.checkpoint = CheckpointOptions{.file = folder.file("a.checkpoint"), .every = 1000};
    backend.on_submit = [&](const RenderJob&) { interrupted = true; };
    EXPECT_EQ(render(backend), 0U);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.checkpoint"}));
    interrupted = false;
    EXPECT_TRUE(contains(input_error([&] { render(backend); }), "--resume"));
    const int before = backend.submitted;
    backend.on_submit = [](const RenderJob&) {};
    options.checkpoint->resume = true;
    EXPECT_EQ(render(backend), 1U);
    EXPECT_EQ(backend.submitted - before, 1);  // of three tiles: two were in progress
    EXPECT_EQ(records[0].metadata.film_sha256, film_hash(gradient_film(options.job)));
    EXPECT_FALSE(std::filesystem::exists(options.checkpoint->file));
}

TEST_F(LongRender, AnInterruptedRenderToATargetGoesOnFromItsCheckpoint) {
    const auto backend = make_backend("cpu");
    options.job.samples = 4096;
    options.target = RenderTarget{.error = 0.003};
    EXPECT_EQ(render(*backend), 1U);
    const std::string expected = records[0].metadata.film_sha256;
    options.force = true;
    options.checkpoint = CheckpointOptions{.file = folder.file("a.checkpoint"), .resume = true};
    int runs = 0;
    for (std::size_t done = 0; done == 0 && runs < 100; ++runs) {
        interrupted = false;
        InterruptingBackend stopping(make_backend("cpu"), 3, interrupted);
        done = render(stopping);
    }
    EXPECT_GT(runs, 1);
    EXPECT_EQ(records[0].metadata.film_sha256, expected);
    EXPECT_EQ(records[0].metadata.target, "rmse 0.003");
    EXPECT_EQ(records[0].metadata.stopped_by, "target");
    EXPECT_FALSE(std::filesystem::exists(options.checkpoint->file));
}

TEST_F(LongRender, ACheckpointIsForOneFrame) {
    GradientBackend backend;
    options.checkpoint = CheckpointOptions{.file = folder.file("a.checkpoint")};
    options.output = folder.file("a#.pfm");
    options.frames = {0, 1};
    EXPECT_TRUE(contains(input_error([&] { render(backend); }), "one frame"));
    options.frames = {0, 0};
    options.checkpoint->file = folder.file("none/a.checkpoint");
    EXPECT_TRUE(contains(input_error([&] { render(backend); }), "no folder"));
}

TEST_F(LongRender, FlipNeedsAnExposure) {
    GradientBackend backend;
    options.job.samples = 64;
    options.target = RenderTarget{.error = 0.1, .metric = ErrorMetric::flip};
    options.exposure = ExposureChoice{.automatic = true};
    EXPECT_TRUE(contains(input_error([&] { render(backend); }), "--exposure auto"));
}

TEST_F(LongRender, TheMetadataSayHowATargetWasReached) {
    NoiseBackend backend(Noise::uniform);
    options.job.samples = 1024;
    options.target = RenderTarget{.error = 0.05};
    EXPECT_EQ(render(backend), 1U);
    const ImageMetadata metadata = read_image(options.output).metadata.value();
    EXPECT_EQ(metadata.target, "rmse 0.05");
    EXPECT_EQ(metadata.stopped_by, "target");
    EXPECT_TRUE(metadata.tile_samples.starts_with("16: ")) << metadata.tile_samples;
    EXPECT_TRUE(metadata.tile_samples.ends_with(" 24*34")) << metadata.tile_samples;  // the right half has no noise
    EXPECT_TRUE(metadata.error.starts_with("rmse 0.0")) << metadata.error;
    EXPECT_EQ(metadata.samples, 1024);
    EXPECT_GT(records[0].mean_samples, 44);
    EXPECT_LT(records[0].mean_samples, 60);
    render(backend);
    EXPECT_TRUE(records[0].skipped);
    options.target->error = 0.04;
    render(backend);
    EXPECT_FALSE(records[0].skipped);
}

TEST_F(LongRender, OneThatASignalStoppedIsNotFinished) {
    options.target = RenderTarget{.error = 1e-3};
    options.job.samples = 1 << 20;
    struct Interrupting : NoiseBackend {
        Interrupting(std::atomic<bool>& flag) : NoiseBackend(Noise::uniform), flag(flag) {}
        std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene, const RenderJob& job) override {
            flag = submitted > 2;  // after the first round
            return NoiseBackend::submit(std::move(scene), job);
        }
        std::atomic<bool>& flag;
    } interrupting(interrupted);
    EXPECT_EQ(render(interrupting), 1U);
    EXPECT_EQ(records[0].metadata.stopped_by, "interrupt");
    interrupted = false;
    interrupting.submitted = 0;
    options.job.samples = 1 << 20;
    render(interrupting);
    EXPECT_FALSE(records[0].skipped);
}

TEST_F(LongRender, AWrittenImageNamesItsSceneAndIsVerified) {
    const SceneSource source{.scene = "named:paper", .camera = "three-quarter", .instants = 2};
    const auto backend = make_backend("cpu");
    options.job.width = 40;
    options.job.height = 30;
    options.output = folder.file("a.png");
    scene = open_scene(source, 4.0 / 3).scene;
    options.camera = source.camera;
    options.scene_source = to_json(source);
    options.effects = parse_effects("-shadows");
    EXPECT_EQ(render(*backend), 1U);
    VerifyCommand command{.image = options.output, .scene = {}, .environment = {}, .how = {}, .quiet = true};
    EXPECT_EQ(run_verify(command, *backend), 0);
    command.scene = "named:spheres/7";
    EXPECT_TRUE(contains(input_error([&] { (void)run_verify(command, *backend); }), "cannot verify"));
    write_image(command.image, FloatImage{2, 2, std::vector<Vec3f>(4)}, {}, options.write);
    command.scene.clear();
    EXPECT_TRUE(contains(input_error([&] { (void)run_verify(command, *backend); }), "cannot verify"));
}

TEST(SceneSource, IsReadFromItsText) {
    const SceneSource all{.scene = "sch\xC3\xB6n \"1\".glb",
                          .camera = "a\\b",
                          .environment = "sky.hdr",
                          .rotation = 0.1,
                          .intensity = 0.3F,
                          .default_light = false,
                          .indirect = true,
                          .instants = 9};
    for (const char c : to_json(all)) EXPECT_TRUE(c >= ' ' && c <= '~');
    EXPECT_EQ(scene_source_from(to_json(all)), all);
    EXPECT_EQ(to_json({}), "{}");
    EXPECT_EQ(to_json({.scene = "named:paper"}), "{\"scene\":\"named:paper\"}");
    for (const char* bad : {"", "{", "[]x", "{\"scene\":3}", "{\"instants\":\"many\"}"}) {
        EXPECT_TRUE(contains(input_error([&] { (void)scene_source_from(bad); }), "where a scene comes from")) << bad;
    }
}

}  // namespace
}  // namespace tandem
