#include "render/progress.h"

#include <gtest/gtest.h>

namespace tandem {
namespace {

TEST(Progress, TimeLeftComesFromTheFramesThatWereRendered) {
    EXPECT_EQ(progress_line(0, 0, 4, 9), "[>                             ] 0/4");
    EXPECT_EQ(progress_line(2, 1, 4, 10), "[===============>              ] 2/4, 0:20 left");
    EXPECT_EQ(progress_line(2, 0, 4, 10), "[===============>              ] 2/4") << "all were there before";
    EXPECT_EQ(progress_line(4, 4, 4, 10), "[==============================] 4/4");
    EXPECT_EQ(progress_line(1, 1, 1001, 3.7), "[>                             ] 1/1001, 1:01:40 left");
}

}  // namespace
}  // namespace tandem
