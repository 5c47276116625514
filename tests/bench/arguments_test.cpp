#include "arguments.h"

#include <gtest/gtest.h>

#include "tandem/error/error.h"

namespace tandem::bench {
namespace {

TEST(Arguments, SizesAreWidthByHeight) {
    EXPECT_EQ(parse_size("1000x900").width, 1000);
    EXPECT_EQ(parse_size("1000x900").height, 900);
    for (const char* wrong :
         {"", "1000", "x", "1000x", "x900", "0x9", "9x0", "-1x9", "1e3x9", "10x10x10", " 1x1", "70000x1"}) {
        EXPECT_THROW((void)parse_size(wrong), InputError) << wrong;
    }
}

TEST(Arguments, FramesAreOneOrARange) {
    EXPECT_EQ(parse_frames("0-119").count(), 120);
    EXPECT_EQ(parse_frames("7").first, 7);
    EXPECT_EQ(parse_frames("7").last, 7);
    for (const char* wrong : {"", "-", "3-", "-3", "5-4", "a-b", "1-2-3", "99999999999"}) {
        EXPECT_THROW((void)parse_frames(wrong), InputError) << wrong;
    }
}

}  // namespace
}  // namespace tandem::bench
