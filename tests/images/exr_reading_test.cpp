/// EXR files of other programs: their layouts, channels, types and windows; and those that are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "images/exr_samples.h"
#include "images/sample_images.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"
#include "tandem/images/image_io.h"

namespace tandem {
namespace {

using namespace test;

const ExrLayout layouts[] = {ExrLayout::scan_lines, ExrLayout::tiles, ExrLayout::mip_map, ExrLayout::rip_map};

FloatImage decoded(const ExrOptions& options, const FloatImage& image = exr_ramp(11, 7)) {
    return decode_exr(write_exr(image, options), "memory").image;
}

std::string refusal(const Bytes& bytes) {
    return thrown_message<InputError>([&] { (void)decode_exr(bytes, "a/b.exr"); });
}

void expect_near(const FloatImage& a, const FloatImage& b, float relative) {
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        EXPECT_NEAR(a.pixels[i].x, b.pixels[i].x, relative * b.pixels[i].x) << "red of pixel " << i;
        EXPECT_NEAR(a.pixels[i].y, b.pixels[i].y, relative * b.pixels[i].y) << "green of pixel " << i;
        EXPECT_NEAR(a.pixels[i].z, b.pixels[i].z, relative * b.pixels[i].z) << "blue of pixel " << i;
    }
}

TEST(ExrReading, EveryCompressionAndLayout) {
    for (const std::string& compression : exr_compressions()) {
        const bool lossy = compression.starts_with("b44") || compression.starts_with("dwa");
        for (const ExrLayout layout : layouts) {
            // more lines than any of them has in a block, and no whole number of tiles
            const FloatImage image = layout == ExrLayout::scan_lines ? exr_ramp(3, 260) : exr_ramp(11, 7);
            for (const ExrValues values : {ExrValues::half, ExrValues::single}) {
                SCOPED_TRACE(compression + ", layout " + std::to_string(static_cast<int>(layout)) + ", values " +
                             std::to_string(static_cast<int>(values)));
                const ExrOptions options = {.compression = compression, .layout = layout, .values = values};
                expect_near(decoded(options, image), image, lossy ? 0.02F : 0);
            }
        }
    }
}

TEST(ExrReading, TheOrderInTheFileDoesNotMatter) {
    for (const ExrLayout layout : layouts) {
        EXPECT_TRUE(same_bits(decoded({.layout = layout, .bottom_up = true}), exr_ramp(11, 7)));
    }
}

TEST(ExrReading, OtherChannelsArePassedOver) {
    const std::vector<std::string> channels = {"R", "G", "B", "A", "C", "Z", "diffuse.R"};
    for (const ExrLayout layout : layouts) {
        EXPECT_TRUE(same_bits(decoded({.layout = layout, .channels = channels}), exr_ramp(11, 7)));
    }
}

TEST(ExrReading, TheOnlyChannelIsGrey) {
    FloatImage grey = exr_ramp(11, 7);
    for (Vec3f& pixel : grey.pixels) pixel = {pixel.x, pixel.x, pixel.x};
    for (const char* channel : {"Y", "Z", "depth.anything"}) {
        EXPECT_TRUE(same_bits(decoded({.channels = {channel}}), grey)) << channel;
    }
}

TEST(ExrReading, WholeNumbersAreTakenAsTheyAre) {
    const FloatImage image{3, 1, {{0, 1, 2}, {255, 65535, 65536}, {16777216, 2147483648.0F, 7}}};
    EXPECT_TRUE(same_bits(decoded({.values = ExrValues::whole}, image), image));
}

TEST(ExrReading, FloatsKeepEveryBit) {
    for (const char* compression : {"none", "rle", "zips", "zip", "piz"}) {
        const FloatImage image = sample_floats(33, 40);
        const ExrOptions options = {.compression = compression, .values = ExrValues::single};
        EXPECT_TRUE(same_bits(decoded(options, image), image)) << compression;
    }
}

TEST(ExrReading, ThePictureIsTheDataWindow) {
    for (const ExrLayout layout : layouts) {
        EXPECT_TRUE(same_bits(decoded({.layout = layout, .left = -3, .top = 98}), exr_ramp(11, 7)));
        EXPECT_TRUE(same_bits(decoded({.layout = layout, .left = 1 << 29, .top = -(1 << 29)}), exr_ramp(11, 7)));
    }
}

TEST(ExrReading, TheFirstOfSeveralParts) {
    for (const ExrLayout layout : layouts) {
        EXPECT_TRUE(same_bits(decoded({.layout = layout, .multipart = true}), exr_ramp(11, 7)));
    }
}

TEST(ExrReading, StartsNoThreads) {
    const auto threads = [] {
        return std::distance(std::filesystem::directory_iterator("/proc/self/task"),
                             std::filesystem::directory_iterator());
    };
    const auto before = threads();
    (void)decoded({});
    (void)encode_exr(exr_ramp(11, 7), {});
    EXPECT_EQ(threads(), before);
}

TEST(ExrReading, WhatItRefusesItNames) {
    const FloatImage image = exr_ramp(12, 8);
    for (const auto& [bytes, reason] :
         {std::pair{write_deep_exr(false), "deep"}, std::pair{write_deep_exr(true), "deep"},
          std::pair{write_exr(image, {.channels = {"R", "G"}}), "no channels R, G, B among its 2"},
          std::pair{write_exr(image, {.channels = {"r", "g", "b"}}), "no channels R, G, B among its 3"},
          std::pair{write_exr(image, {.sampling = 2}), "channel R does not have a value for every pixel"}}) {
        EXPECT_TRUE(refusal(bytes).starts_with("'a/b.exr' is not a readable EXR image: ")) << refusal(bytes);
        EXPECT_NE(refusal(bytes).find(reason), std::string::npos) << refusal(bytes);
    }
}

}  // namespace
}  // namespace tandem
