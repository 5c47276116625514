#include "common/arguments.h"

#include <gtest/gtest.h>

#include "render/frame_pattern.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"

namespace tandem {
namespace {

using test::thrown_message;

TEST(Arguments, Size) {
    EXPECT_EQ(parse_size("1000x900").width, 1000);
    EXPECT_EQ(parse_size("1000x900").height, 900);
    for (const char* text :
         {"", "x", "10", "10x", "x10", "10X10", "10 x 10", "10x10x10", "-1x5", "1.5x2", "9999999999x1"}) {
        const auto message = thrown_message<InputError>([&] { (void)parse_size(text); });
        EXPECT_NE(message.find("--size"), std::string::npos) << text;
    }
}

TEST(Arguments, Frames) {
    const auto frames = [&](const char* text) {
        const FrameRange range = parse_frames(text);
        return std::pair(range.first, range.last);
    };
    EXPECT_EQ(frames("7"), std::pair(7, 7));
    EXPECT_EQ(frames("0-119"), std::pair(0, 119));
    EXPECT_EQ(frames("5-5"), std::pair(5, 5));
    for (const char* text : {"", "-", "-3", "3-", "3-2", "a-b", "1-2-3", "1,2", "2147483648"}) {
        const auto message = thrown_message<InputError>([&] { (void)parse_frames(text); });
        EXPECT_NE(message.find("--frames"), std::string::npos) << text;
    }
}

TEST(Arguments, Exposure) {
    EXPECT_EQ(parse_exposure("auto"), (ExposureChoice{true, 0}));
    EXPECT_EQ(parse_exposure("-6.3"), (ExposureChoice{false, -6.3}));
    EXPECT_EQ(parse_exposure("+2"), (ExposureChoice{false, 2}));
    EXPECT_EQ(parse_exposure("100"), (ExposureChoice{false, 100}));
    for (const char* text : {"", "+", "+-1", "-", "Auto", "1 ", "1,5", "100.1", "-1e3", "nan", "inf"}) {
        const auto message = thrown_message<InputError>([&] { (void)parse_exposure(text); });
        EXPECT_NE(message.find("--exposure is '"), std::string::npos) << text;
    }
}

TEST(FramePatterns, OnePlaceInTheFileName) {
    const auto path = [](const char* pattern) { return FramePattern(pattern).path(42); };
    EXPECT_EQ(path("a-%d.png"), "a-42.png");
    EXPECT_EQ(path("a-%04d.png"), "a-0042.png");
    EXPECT_EQ(path("%01d.png"), "42.png");
    EXPECT_EQ(path("a/####b.png"), "a/0042b.png");
    EXPECT_EQ(path("#.png"), "42.png");
    EXPECT_EQ(path("a##/b%d/c.png"), "a##/b%d/c.png") << "folders keep their names";
    EXPECT_EQ(path("100%.png"), "100%.png");
    EXPECT_EQ(FramePattern("##.png").path(123456), "123456.png");
    EXPECT_EQ(FramePattern("%09d.png").path(0xFFFFFFFF), "4294967295.png");
    EXPECT_FALSE(FramePattern("a##/b.png").has_frame());
    EXPECT_TRUE(FramePattern("a##/b#.png").has_frame());
}

TEST(FramePatterns, TwoPlacesAreAnError) {
    for (const char* pattern : {"#a#.png", "%d-%d.png", "##%02d.png"}) {
        EXPECT_THROW(FramePattern{pattern}, InputError) << pattern;
    }
}

}  // namespace
}  // namespace tandem
