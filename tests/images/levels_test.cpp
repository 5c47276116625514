// The levels of sRGB against the definition in 400 decimal digits: each is the nearest float.
#include "tandem/images/levels.h"

#include <gtest/gtest.h>

#include "support/exact_srgb.h"

namespace tandem {
namespace {

TEST(Levels, AreTheNearestFloats) {
    const std::vector<float> levels = texture_levels();
    ASSERT_EQ(levels.size(), 512U);
    for (int level = 0; level < 256; ++level) {
        const auto at = static_cast<std::size_t>(level);
        EXPECT_EQ(levels[at], static_cast<float>(test::exact_linear_of_srgb(test::Big(level) / 255))) << level;
        EXPECT_EQ(levels[256 + at], static_cast<float>(level) / 255.0F) << level;
    }
    EXPECT_EQ(levels[0], 0);
    EXPECT_EQ(levels[255], 1);
}

}  // namespace
}  // namespace tandem
