#include "sequence.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "loop_backend.h"
#include "support/temporary_folder.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/compare.h"
#include "tandem/images/image_io.h"
#include "tandem/images/tone_curve.h"
#include "tandem/scene/named_scenes.h"

namespace tandem::bench {
namespace {

class Sequence : public testing::Test {
  protected:
    test::TemporaryFolder place_;  // of its own: cases run side by side
    std::string folder_ = place_.file("");
    LoopBackend backend_{"cpu", false, true};
    Scene scene_ = named_scene("paper");
    RenderJob job_{20, 18, 2, 3, 0, Tier::strict};
};

TEST_F(Sequence, WritesEveryFrameAndEachIsItsOwn) {
    const SequenceTimes times = render_sequence(backend_, scene_, job_, {{4, 14}, SequenceOutput::png, folder_, 2, 3});
    EXPECT_EQ(times.frames, 11);
    EXPECT_GT(times.render, 0);
    EXPECT_GT(times.encode, 0);
    EXPECT_GE(times.wall, times.render);
    EXPECT_LE(times.render_share(), 1);
    for (int frame = 4; frame <= 14; ++frame) {
        char path[32];
        std::snprintf(path, sizeof(path), "/frame-%04d.png", frame);
        const DecodedImage file = read_image(folder_ + path);
        ASSERT_TRUE(file.metadata.has_value());
        EXPECT_EQ(file.metadata->frame, static_cast<std::uint32_t>(frame));
        RenderJob job = job_;
        job.frame = static_cast<std::uint32_t>(frame);
        const Film film = backend_.render(backend_.load(prepare(scene_, {frame, {}}), job.tier), job).film;
        EXPECT_EQ(file.display, (Display{TransferFunction::linear})) << "the paper's mapping";
        EXPECT_EQ(tone_map(film, file.display).image.values, tone_map(file.image, file.display).image.values) << frame;
    }
}

TEST_F(Sequence, TextAndNothingAreOutputsToo) {
    (void)render_sequence(backend_, scene_, job_, {{0, 1}, SequenceOutput::none, "", 1, 1});
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
    (void)render_sequence(backend_, scene_, job_, {{0, 1}, SequenceOutput::ppm_text, folder_, 1, 1});
    EXPECT_EQ(read_image(folder_ + "/frame-0001.ppm").format, ImageFormat::ppm_text);
}

TEST_F(Sequence, AnErrorOfAnEncoderComesOut) {
    EXPECT_THROW(
        (void)render_sequence(backend_, scene_, job_, {{0, 9}, SequenceOutput::png, folder_ + "/missing", 2, 3}),
        InputError);
}

TEST(SequenceText, NamesTheBottleneck) {
    SequenceTimes times;
    times.frames = 10;
    times.encoders = 2;
    times.wall = 10;
    times.render = 4;
    times.download = 1;
    times.encode = 18;
    EXPECT_NE(describe_bottleneck(times).find("The bottleneck is encoding"), std::string::npos)
        << describe_bottleneck(times);
    times.download = 9.5;
    EXPECT_NE(describe_bottleneck(times).find("The bottleneck is copying"), std::string::npos)
        << describe_bottleneck(times);
    EXPECT_NE(describe_bottleneck(times).find("40 %"), std::string::npos);
}

}  // namespace
}  // namespace tandem::bench
