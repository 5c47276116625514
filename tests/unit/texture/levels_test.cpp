// The levels of sRGB against the definition in 400 decimal digits: each is the nearest float.
#include "tandem/texture/levels.h"

#include <gtest/gtest.h>

#include "support/exact_geometry.h"

namespace tandem {
namespace {

using test::Big;

Big srgb(int level) {
    const Big c = Big(level) / 255;
    if (c <= Big("0.04045")) return c / Big("12.92");
    return pow((c + Big("0.055")) / Big("1.055"), Big("2.4"));
}

TEST(Levels, AreTheNearestFloats) {
    const std::vector<float> levels = texture_levels();
    ASSERT_EQ(levels.size(), 512U);
    for (int level = 0; level < 256; ++level) {
        const auto at = static_cast<std::size_t>(level);
        EXPECT_EQ(levels[at], static_cast<float>(srgb(level))) << level;
        EXPECT_EQ(levels[256 + at], static_cast<float>(level) / 255.0F) << level;
    }
    EXPECT_EQ(levels[0], 0);
    EXPECT_EQ(levels[255], 1);
}

}  // namespace
}  // namespace tandem
