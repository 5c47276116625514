#include "tandem/film/tone_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tandem {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TEST(ToneCurve, EveryLevelComesBackFromItsLinearValue) {
    for (int level = 0; level < 256; ++level) EXPECT_EQ(to_level(static_cast<float>(level) / 255.0F), level);
}

TEST(ToneCurve, ClampsWithoutGamma) {
    EXPECT_EQ(to_level(0.0F), 0);
    EXPECT_EQ(to_level(-0.0F), 0);
    EXPECT_EQ(to_level(-1.0F), 0);
    EXPECT_EQ(to_level(-infinity), 0);
    EXPECT_EQ(to_level(1.0F), 255);
    EXPECT_EQ(to_level(std::nextafter(1.0F, 2.0F)), 255);
    EXPECT_EQ(to_level(1e30F), 255);
    EXPECT_EQ(to_level(infinity), 255);
    EXPECT_EQ(to_level(std::numeric_limits<float>::denorm_min()), 0);
    EXPECT_EQ(to_level(0.25F), 64);  // 63.75: linear, where sRGB would give 137
}

TEST(ToneCurve, RoundsToTheNearestLevelAndItsOneTieUp) {
    EXPECT_EQ(to_level(0.5F), 128);
    EXPECT_EQ(to_level(std::nextafter(0.5F, 0.0F)), 127);
    for (int level = 0; level < 255; ++level) {
        // the float nearest to the border between two levels and its neighbours, against exact integer arithmetic
        float x = static_cast<float>((2 * level + 1) / 510.0);
        x = std::nextafter(std::nextafter(x, 0.0F), 0.0F);
        for (int step = 0; step < 5; ++step, x = std::nextafter(x, 1.0F)) {
            const bool above = static_cast<long double>(x) * 510.0L >= static_cast<long double>(2 * level + 1);
            EXPECT_EQ(to_level(x), level + (above ? 1 : 0)) << std::hexfloat << x;
        }
    }
}

TEST(ToneCurve, CountsEveryNaNAndMakesItBlack) {
    EXPECT_EQ(to_level(nan), 0);
    const ToneMapped mapped = tone_map({2, 1, {{nan, 1.0F, -nan}, {0.5F, infinity, nan}}});
    EXPECT_EQ(mapped.nan_values, 3U);
    EXPECT_EQ(mapped.image.width, 2);
    EXPECT_EQ(mapped.image.height, 1);
    EXPECT_EQ(mapped.image.values, (std::vector<std::uint8_t>{0, 255, 0, 128, 255, 0}));
}

TEST(ToneCurve, TakesAFilmAsItTakesTheImageOfItsMeans) {
    Film film(257, 3, 7);  // more than one block, and a part of one
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        film.sums()[i] = {0.009 * static_cast<double>(i), i % 5 == 0 ? nan : 3.5, 7.0};
    }
    const ToneMapped direct = tone_map(film), through_image = tone_map(film_to_image(film));
    EXPECT_EQ(direct.image.width, 257);
    EXPECT_EQ(direct.image.height, 3);
    EXPECT_EQ(direct.image.values, through_image.image.values);
    EXPECT_EQ(direct.nan_values, 155U);
    EXPECT_EQ(through_image.nan_values, 155U);
}

TEST(FilmToImage, GivesTheMeansRoundedOnce) {
    Film film(2, 1, 3);
    film.sums()[0] = {1, 2, 3};
    film.sums()[1] = {-0.0, 0.1, 1e300};
    const FloatImage image = film_to_image(film);
    ASSERT_EQ(image.pixels.size(), 2U);
    EXPECT_EQ(image.pixels[0].x, static_cast<float>(1.0 / 3.0));
    EXPECT_EQ(image.pixels[0].z, 1.0F);
    EXPECT_TRUE(std::signbit(image.pixels[1].x));
    EXPECT_EQ(image.pixels[1].y, static_cast<float>(0.1 / 3.0));
    EXPECT_EQ(image.pixels[1].z, infinity);
}

}  // namespace
}  // namespace tandem
