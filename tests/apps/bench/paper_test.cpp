#include "paper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "loop_backend.h"
#include "paper_figures.h"
#include "support/temporary_folder.h"
#include "tandem/base/error.h"
#include "tandem/images/image_io.h"
#include "tandem/report/html_writer.h"
#include "tandem/report/json_writer.h"
#include "tandem/report/text_writer.h"

namespace tandem::bench {
namespace {

class Paper : public testing::Test {
  protected:
    Paper() {
        options_.out = folder_.file("paper");
        options_.frames = {0, 8};
        options_.size = {40, 36};
        options_.samples = 2;
        options_.slow_frames = 1;
        options_.threads = 2;
    }

    const BenchmarkRow* row(const std::string& part) const {
        const auto found = std::find_if(report_.rows.begin(), report_.rows.end(), [&](const BenchmarkRow& one) {
            return one.label.find(part) != std::string::npos;
        });
        return found == report_.rows.end() ? nullptr : &*found;
    }

    test::TemporaryFolder folder_;  // of its own: cases run side by side
    PaperOptions options_;
    Report report_;
};

TEST(PaperFrames, SlowRowsMeasureSomeOfTheFramesOfFastOnes) {
    EXPECT_EQ(spread_frames({0, 119}, 3), (std::vector<std::int32_t>{0, 40, 80}));
    EXPECT_EQ(spread_frames({5, 7}, 10), (std::vector<std::int32_t>{5, 6, 7}));
    for (const FrameRange range : {FrameRange{0, 119}, FrameRange{3, 40}, FrameRange{0, 10}}) {
        const auto few = spread_frames(range, 3), more = spread_frames(range, 9);
        EXPECT_TRUE(std::includes(more.begin(), more.end(), few.begin(), few.end()))
            << range.first << '-' << range.last;
    }
}

TEST(PaperFigures, FollowFromWhatItPrinted) {
    EXPECT_NEAR(paper::factor, 156.6, 0.05);
    EXPECT_NEAR(paper::frames_per_second, 212, 0.5);
    EXPECT_NEAR(paper::frames_per_minute, paper::claimed_frames_per_second, 1);
    EXPECT_NEAR(paper::share_outside_kernel, 0.979, 0.0005);
}

TEST_F(Paper, MeasuresEveryRungOfTheLadder) {
    EXPECT_TRUE(run_paper(options_, loop_source(), report_)) << prose_of(report_);
    ASSERT_NE(row("-O0, 1 thread"), nullptr);
    EXPECT_EQ(row("-O0, 1 thread")->seconds.size(), 1U);
    EXPECT_EQ(row("-O3, 1 thread")->seconds.size(), 3U);
    EXPECT_EQ(row("-O3, 2 threads")->seconds.size(), 9U);
    ASSERT_NE(row("Rasteriser (no rays)"), nullptr);
    EXPECT_EQ(row("Rasteriser (no rays)")->seconds.size(), 9U);
    EXPECT_NE(prose_of(report_).find("A plain rasteriser on all threads"), std::string::npos);
    for (const char* label :
         {"Tandem CPU, 2 threads", "Tandem GPU, kernel", "Tandem GPU, scene to film", "and PPM text", "and PNG"}) {
        ASSERT_NE(row(label), nullptr) << label;
        EXPECT_EQ(row(label)->seconds.size(), 9U);
        ASSERT_TRUE(row(label)->factor.has_value());
        EXPECT_EQ(row(label)->factor->over, row("-O0, 1 thread")->label);
    }
    // Each of these does what the one before does, and more, to the very same frames.
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_GT(row("scene to film")->seconds[i], row("GPU, kernel")->seconds[i]);
        EXPECT_GT(row("and PNG")->seconds[i], row("scene to film")->seconds[i]);
        EXPECT_GT(row("and PPM text")->seconds[i], row("scene to film")->seconds[i]);
    }
    EXPECT_EQ(property_of(report_, "pixels that differ between CPU and GPU"), "0");
    EXPECT_EQ(property_of(report_, "pixels compared"), "12960");
    EXPECT_EQ(property_of(report_, "film frame 8").size(), 64U);
    EXPECT_NE(prose_of(report_).find("12,960 pixels"), std::string::npos) << prose_of(report_);
    EXPECT_EQ(read_image(options_.out + "/frames/frame-0008.png").display, (Display{TransferFunction::linear}))
        << "the paper's own mapping";
    EXPECT_FALSE(std::filesystem::exists(options_.out + "/frame.ppm"));
    EXPECT_FALSE(std::filesystem::exists(options_.out + "/ppm-text"));
}

TEST_F(Paper, ThePageStandsAlone) {
    ASSERT_TRUE(run_paper(options_, loop_source(), report_));
    const std::string html = to_html(report_);
    for (const char* part : {"35,329.4 ms", "225.6 ms", "4.72 ms", "12,711", "at least 139 times", "97.9 %", "figure 4",
                             "figure 6", "figure 7", "figure 9", "figure 10", "data:image/png;base64,"}) {
        EXPECT_NE(html.find(part), std::string::npos) << part;
    }
    EXPECT_EQ(html.find("http"), std::string::npos);
    EXPECT_EQ(html.find("nan"), std::string::npos);
    EXPECT_TRUE(nlohmann::json::accept(to_json(report_)));
    EXPECT_EQ(to_text(report_).find("an unknown factor"), std::string::npos);
}

TEST_F(Paper, ASpoiledPictureIsFound) {
    const auto spoils = [](const std::string& name, const BackendOptions&) { return name == "cuda"; };
    EXPECT_FALSE(run_paper(options_, loop_source(spoils), report_));
    EXPECT_EQ(property_of(report_, "pixels that differ between CPU and GPU"), "9");
}

TEST_F(Paper, WithoutAGpuThePageSaysWhatItLacks) {
    EXPECT_TRUE(run_paper(options_, loop_source([](const auto&, const auto&) { return false; }, "cuda"), report_));
    EXPECT_EQ(row("Tandem GPU"), nullptr);
    EXPECT_NE(row("Rasteriser (no rays)"), nullptr);
    EXPECT_NE(row("Tandem CPU, and PNG"), nullptr);
    EXPECT_NE(prose_of(report_).find("No GPU took part"), std::string::npos);
    EXPECT_EQ(property_of(report_, "pixels compared"), "");
    EXPECT_EQ(to_html(report_).find("nan"), std::string::npos);
}

TEST_F(Paper, RefusesWhatItCannotCompare) {
    options_.backends = {"oracle"};
    EXPECT_THROW((void)run_paper(options_, loop_source(), report_), InputError);
    options_.backends = {"cuda"};
    EXPECT_THROW(
        (void)run_paper(options_, loop_source([](const auto&, const auto&) { return false; }, "cuda"), report_),
        EnvironmentError);
}

}  // namespace
}  // namespace tandem::bench
