#include "tandem/images/tone_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "support/exact_srgb.h"
#include "support/random.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"

namespace tandem {
namespace {

using test::Big;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

constexpr TransferFunction both[] = {TransferFunction::srgb, TransferFunction::linear};

/// The light at which the levels from `level` on begin: half a level below it.
Big border_below(int level, TransferFunction transfer) {
    const Big share = (Big(level) - Big("0.5")) / 255;
    return transfer == TransferFunction::srgb ? test::exact_linear_of_srgb(share) : share;
}

TEST(ToneCurve, ClampsAndKeepsBlackAndWhite) {
    for (const TransferFunction transfer : both) {
        EXPECT_EQ(to_level(0.0F, transfer), 0);
        EXPECT_EQ(to_level(-0.0F, transfer), 0);
        EXPECT_EQ(to_level(-1.0F, transfer), 0);
        EXPECT_EQ(to_level(-infinity, transfer), 0);
        EXPECT_EQ(to_level(1.0F, transfer), 255);
        EXPECT_EQ(to_level(std::nextafter(1.0F, 2.0F), transfer), 255);
        EXPECT_EQ(to_level(1e30F, transfer), 255);
        EXPECT_EQ(to_level(infinity, transfer), 255);
        EXPECT_EQ(to_level(std::numeric_limits<float>::denorm_min(), transfer), 0);
        EXPECT_EQ(to_level(nan, transfer), 0);
        EXPECT_EQ(to_level(-nan, transfer), 0);
    }
    EXPECT_EQ(to_level(0.25F, TransferFunction::linear), 64);  // 63.75
    EXPECT_EQ(to_level(0.25F, TransferFunction::srgb), 137);   // 136.96
    EXPECT_EQ(to_level(0.18F, TransferFunction::srgb), 118);   // middle grey
}

TEST(ToneCurve, RoundsToTheNearestLevelAndItsOneTieUp) {
    EXPECT_EQ(to_level(0.5F, TransferFunction::linear), 128);
    EXPECT_EQ(to_level(std::nextafter(0.5F, 0.0F), TransferFunction::linear), 127);
    for (const TransferFunction transfer : both) {
        for (int level = 1; level < 256; ++level) {
            // the float nearest to the border between two levels and its neighbours
            const Big border = border_below(level, transfer);
            auto x = static_cast<float>(border);
            x = std::nextafter(std::nextafter(x, 0.0F), 0.0F);
            for (int step = 0; step < 5; ++step, x = std::nextafter(x, 1.0F)) {
                EXPECT_EQ(to_level(x, transfer), Big(x) >= border ? level : level - 1)
                    << to_string(transfer) << ' ' << std::hexfloat << x;
            }
        }
    }
}

// The levels of sRGB come from a table; these are the floats at which an entry of it begins, and those before.
TEST(ToneCurve, IsRightBetweenTheBordersToo) {
    std::vector<float> borders;
    for (int level = 1; level < 256; ++level) {
        const Big border = border_below(level, TransferFunction::srgb);
        const auto nearest = static_cast<float>(border);
        borders.push_back(Big(nearest) < border ? std::nextafter(nearest, 2.0F) : nearest);
    }
    const auto last = std::bit_cast<std::uint32_t>(2.0F);
    for (std::uint32_t bits = 0; bits <= last; bits += 1U << 12) {
        for (const std::uint32_t below : {0U, 1U}) {
            if (bits < below) continue;
            const auto x = std::bit_cast<float>(bits - below);
            const auto level = std::upper_bound(borders.begin(), borders.end(), x) - borders.begin();
            ASSERT_EQ(to_level(x, TransferFunction::srgb), level) << std::hexfloat << x;
        }
    }
}

TEST(ToneCurve, EveryLevelComesBackFromItsLinearValue) {
    for (const TransferFunction transfer : both) {
        for (const double stops : {0.0, -6.3, 0.1, 2.0, 99.9, -100.0, 100.0}) {
            const Display display{transfer, stops};
            FloatImage image{256, 1, {}};
            const std::vector<float> values = values_of_levels(255, display);
            ASSERT_EQ(values.size(), 256U);
            for (const float value : values) image.pixels.push_back({value, value, value});
            const ByteImage mapped = tone_map(image, display).image;
            for (std::size_t i = 0; i < 3 * values.size(); ++i) {
                ASSERT_EQ(mapped.values[i], i / 3) << in_words(display);
            }
            EXPECT_EQ(tone_map(to_float(mapped, display), display).image.values, mapped.values);
        }
    }
}

TEST(ToneCurve, ValuesOfLevelsAreTheNearestFloats) {
    for (const std::uint32_t most : {1U, 15U, 255U, 1023U}) {
        const std::vector<float> srgb = values_of_levels(most, {TransferFunction::srgb});
        const std::vector<float> linear = values_of_levels(most, {TransferFunction::linear});
        for (std::uint32_t level = 0; level <= most; ++level) {
            const Big share = Big(level) / most;
            EXPECT_EQ(srgb[level], static_cast<float>(test::exact_linear_of_srgb(share))) << level << " of " << most;
            EXPECT_EQ(linear[level], static_cast<float>(share)) << level << " of " << most;
        }
    }
    EXPECT_EQ(values_of_levels(65535, {TransferFunction::linear})[32768], 32768.0F / 65535.0F);
    EXPECT_EQ(values_of_levels(255, {TransferFunction::linear, 3})[255], 0.125F);
}

TEST(Exposure, IsAPowerOfTwo) {
    for (const double whole : {-100.0, -3.0, 0.0, 1.0, 100.0}) {
        EXPECT_EQ(exposure_factor({TransferFunction::srgb, whole}), std::ldexp(1, static_cast<int>(whole)));
    }
    for (const double stops : {-99.9, -0.1, 1e-9, 0.5, 6.3, 99.7}) {
        const auto right = static_cast<double>(pow(Big(2), Big(stops)));
        EXPECT_NEAR(exposure_factor({TransferFunction::srgb, stops}) / right, 1, 0x1p-50) << stops;
    }
    EXPECT_TRUE(is_exposure(100) && is_exposure(-100) && !is_exposure(100.1) && !is_exposure(-infinity));
    EXPECT_FALSE(is_exposure(std::numeric_limits<double>::quiet_NaN()));
}

TEST(Exposure, MultipliesBeforeTheCurve) {
    const FloatImage image{2, 1, {{0.25F, 0.125F, 1e-30F}, {-0.25F, infinity, nan}}};
    EXPECT_EQ(tone_map(image, {TransferFunction::linear, 1}).image.values,
              (std::vector<std::uint8_t>{128, 64, 0, 0, 255, 0}));
    EXPECT_EQ(tone_map(image, {TransferFunction::linear, 99.3}).image.values,
              (std::vector<std::uint8_t>{255, 255, 199, 0, 255, 0}));  // 2^99.3 10^-30 = 0.7803
    EXPECT_EQ(tone_map(image, {TransferFunction::srgb, -1}).image.values,
              (std::vector<std::uint8_t>{to_level(0.125F, TransferFunction::srgb),
                                         to_level(0.0625F, TransferFunction::srgb), 0, 0, 255, 0}));
    EXPECT_EQ(tone_map(image, {TransferFunction::linear, -3}).nan_values, 1U);
}

TEST(ToneCurve, CountsEveryNaNAndMakesItBlack) {
    const FloatImage image{2, 1, {{nan, 1.0F, -nan}, {0.5F, infinity, nan}}};
    for (const TransferFunction transfer : both) {
        const ToneMapped mapped = tone_map(image, {transfer});
        EXPECT_EQ(mapped.nan_values, 3U);
        EXPECT_EQ(mapped.image.width, 2);
        EXPECT_EQ(mapped.image.height, 1);
        EXPECT_EQ(mapped.image.values, (std::vector<std::uint8_t>{0, 255, 0, to_level(0.5F, transfer), 255, 0}));
    }
}

TEST(ToneCurve, TakesAFilmAsItTakesTheImageOfItsMeans) {
    Film film(257, 3, 7);  // more than one block, and a part of one
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        film.sums()[i] = {0.009 * static_cast<double>(i), i % 5 == 0 ? nan : 3.5, 7.0};
    }
    for (const Display& display : {Display{both[0], 0}, {both[0], 0.3}, {both[1], 0}, {both[1], 0.3}}) {
        SCOPED_TRACE(in_words(display));
        const ToneMapped direct = tone_map(film, display), through_image = tone_map(film_to_image(film), display);
        EXPECT_EQ(direct.image.width, 257);
        EXPECT_EQ(direct.image.height, 3);
        EXPECT_EQ(direct.image.values, through_image.image.values);
        EXPECT_EQ(direct.nan_values, 155U);
        EXPECT_EQ(through_image.nan_values, 155U);
    }
}

// The loop over many values has no double rounding that the definition for one lacks, nor loses one.
TEST(ToneCurve, OfAFilmIsThatOfEachMean) {
    Film film(400, 50, 100);
    test::Random random(1);
    for (Vec3d& sum : film.sums()) {
        sum = {random.uniform(-1.0, 101.0), random.uniform(0.0, 30.0), widen(random.any_float())};
    }
    for (const Display& display : {Display{both[0], 0}, {both[0], 0.3}, {both[1], 0}, {both[1], 0.3}}) {
        const std::vector<std::uint8_t> levels = tone_map(film, display).image.values;
        const double factor = exposure_factor(display);
        for (std::size_t i = 0; i < film.pixel_count(); ++i) {
            const Vec3f mean = film.mean(i);
            const float values[] = {mean.x, mean.y, mean.z};
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const float shown = narrow(widen(values[channel]) * factor);
                ASSERT_EQ(levels[3 * i + channel], to_level(shown, display.transfer))
                    << in_words(display) << ", Random(1), pixel " << i << ", channel " << channel;
            }
        }
    }
}

TEST(TransferFunctions, HaveNames) {
    for (const TransferFunction transfer : both) EXPECT_EQ(parse_transfer(to_string(transfer)), transfer);
    for (const char* text : {"", "sRGB", "gamma", "linear "}) {
        const auto message = test::thrown_message<InputError>([&] { (void)parse_transfer(text); });
        EXPECT_NE(message.find("srgb or linear"), std::string::npos) << message;
    }
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
