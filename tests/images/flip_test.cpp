#include "tandem/images/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "support/pixel_index.h"
#include "tandem/base/error.h"
#include "tandem/images/separable_filter.h"
#include "tandem/math/srgb.h"

namespace tandem {
namespace {

constexpr int width = 48, height = 40;

using Levels = std::array<int, 3>;

/// Red, green and blue from 0 to 255 by pixel.
FloatImage picture(const std::function<Levels(int x, int y)>& colour) {
    FloatImage image{width, height, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Levels levels = colour(x, y);
            const auto share = [&](std::size_t i) { return static_cast<float>(levels[i]) / 255.0F; };
            image.pixels.push_back({share(0), share(1), share(2)});
        }
    }
    return image;
}

// The formulas of flip_reference.py.
FloatImage stripes(int shift) {
    return picture([=](int x, int y) {
        const auto level = [&](int channel) { return (3 * x + 5 * y + 40 * channel + shift) % 256; };
        return Levels{level(0), level(1), level(2)};
    });
}
FloatImage checks() {
    return picture([](int x, int y) {
        const int level = 255 * ((x / 4 + y / 4) % 2);
        return Levels{level, level, level};
    });
}
FloatImage grey(int level) {
    return picture([=](int, int) { return Levels{level, level, level}; });
}
FloatImage disc(int centre) {
    return picture([=](int x, int y) {
        const bool within = (x - centre) * (x - centre) + (y - 16) * (y - 16) < 100;
        return within ? Levels{230, 40, 30} : Levels{20, 60 + y, 180};
    });
}

/// The pictures hold what a screen is given.
const Display as_levels{TransferFunction::linear};

struct Pair {
    const char* name;
    FloatImage a, b;
};

std::array<Pair, 3> pairs() {
    return {Pair{"stripes", stripes(0), stripes(24)}, Pair{"checks", checks(), grey(128)},
            Pair{"disc", disc(20), disc(22)}};
}

struct Reference {
    std::string name;
    double pixels_per_degree;
    double mean;
    std::array<double, 5> errors;
};

const std::array references = {
#define FLIP_REFERENCE(name, density, mean, ...) Reference{#name, density, mean, {__VA_ARGS__}},
#include "flip_reference.def"
#undef FLIP_REFERENCE
};

// The package computes in float, and rounds the white point otherwise; the largest distance measured is 2.7e-5.
TEST(Flip, AgreesWithTheProgramOfThePapersAuthors) {
    constexpr double tolerance = 5e-5;
    constexpr std::array<std::array<int, 2>, 5> pixels = {{{0, 0}, {12, 16}, {25, 20}, {37, 9}, {47, 39}}};
    double worst = 0;
    for (const Reference& reference : references) {
        for (const Pair& pair : pairs()) {
            if (pair.name != reference.name) continue;
            SCOPED_TRACE(pair.name);
            const FlipDifference difference = flip(pair.a, pair.b, {reference.pixels_per_degree, as_levels});
            EXPECT_NEAR(difference.mean, reference.mean, tolerance);
            worst = std::max(worst, std::abs(difference.mean - reference.mean));
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                const auto at = std::size_t{width} * pixels[i][1] + pixels[i][0];
                EXPECT_NEAR(difference.errors[at], reference.errors[i], tolerance) << "pixel " << at;
                worst = std::max(worst, std::abs(difference.errors[at] - reference.errors[i]));
            }
        }
    }
    RecordProperty("largest_distance", std::to_string(worst));
}

TEST(Flip, EqualPicturesDifferInNothing) {
    for (const Pair& pair : pairs()) {
        const FlipDifference difference = flip(pair.a, pair.a, {.display = as_levels});
        EXPECT_EQ(difference.mean, 0.0) << pair.name;
        EXPECT_EQ(*std::max_element(difference.errors.begin(), difference.errors.end()), 0.0) << pair.name;
    }
}

TEST(Flip, IsSymmetricAndWithinZeroAndOne) {
    std::vector<Pair> tried;
    for (Pair& pair : pairs()) tried.push_back(std::move(pair));
    tried.push_back({"black and white", grey(0), grey(255)});
    tried.push_back({"green and blue", picture([](int, int) {
                         return Levels{0, 255, 0};
                     }),
                     picture([](int, int) {
                         return Levels{0, 0, 255};
                     })});
    for (const Pair& pair : tried) {
        const FlipDifference there = flip(pair.a, pair.b, {.display = as_levels}),
                             back = flip(pair.b, pair.a, {.display = as_levels});
        EXPECT_EQ(there.errors, back.errors) << pair.name;
        EXPECT_GT(there.mean, 0.0) << pair.name;
        for (const double error : there.errors) {
            ASSERT_GE(error, 0.0) << pair.name;
            ASSERT_LE(error, 1.0) << pair.name;
        }
    }
    EXPECT_NEAR(flip(tried.back().a, tried.back().b).mean, 1, 1e-9) << "no two colours are farther apart";
}

TEST(Flip, LooksAtWhatAScreenShows) {
    FloatImage bright = grey(255), dark = grey(0);
    bright.pixels[7] = {3, std::numeric_limits<float>::infinity(), 1};
    dark.pixels[7] = {-1, std::numeric_limits<float>::quiet_NaN(), 0};
    EXPECT_EQ(flip(bright, grey(255)).mean, 0.0);
    EXPECT_EQ(flip(dark, grey(0)).mean, 0.0);
}

TEST(Flip, OfLightIsThatOfTheLevelsThatShowIt) {
    // the light that a screen sends out for the levels of a picture, two stops darker
    const auto light = [](const FloatImage& levels) {
        FloatImage image = levels;
        for (Vec3f& p : image.pixels) {
            const auto of_level = [](float level) { return narrow(linear_of_srgb(widen(level)) / 4); };
            p = {of_level(p.x), of_level(p.y), of_level(p.z)};
        }
        return image;
    };
    for (const Pair& pair : pairs()) {
        const double of_levels = flip(pair.a, pair.b, {.display = as_levels}).mean;
        const FlipOptions exposed{.display = {TransferFunction::srgb, 2}};
        EXPECT_NEAR(flip(light(pair.a), light(pair.b), exposed).mean, of_levels, 1e-6) << pair.name;
        EXPECT_GT(std::abs(flip(light(pair.a), light(pair.b)).mean - of_levels), 1e-3) << pair.name << ", not exposed";
    }
}

TEST(Flip, IsTheSameWithAReferenceThatIsUsedAgain) {
    const auto tried = pairs();
    const FlipReference reference(tried.front().a, {.display = as_levels});
    for (const Pair& pair : tried) {
        const FlipDifference again = reference.difference(pair.b);
        const FlipDifference alone = flip(tried.front().a, pair.b, {.display = as_levels});
        EXPECT_EQ(again.errors, alone.errors) << pair.name;
        EXPECT_EQ(again.mean, alone.mean) << pair.name;
    }
}

TEST(Flip, SaysWhatItCannotCompare) {
    FloatImage small = grey(0);
    small.height -= 1;
    small.pixels.resize(pixel_count(small));
    EXPECT_THROW((void)flip(small, grey(0)), InputError);
    EXPECT_THROW((void)flip(FloatImage{}, FloatImage{}), InputError);
    for (const double density : {0.0, -1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW((void)flip(grey(0), grey(0), {density}), InputError) << density;
    }
}

TEST(Flip, MapGoesFromDarkToPale) {
    const FloatImage map = flip_map({3, 1, {0, 0.5, 1}, 0.5});
    ASSERT_EQ(map.pixels.size(), 3U);
    const auto lightness = [&](std::size_t i) { return map.pixels[i].x + map.pixels[i].y + map.pixels[i].z; };
    EXPECT_LT(lightness(0), 0.1F);
    EXPECT_LT(lightness(0), lightness(1));
    EXPECT_LT(lightness(1), lightness(2));
}

TEST(SeparableFilter, KeepsConstantsAndSpreadsAPoint) {
    const AxisWeights box = normalised({1, 1, 1});
    Plane plane{5, 4, std::vector<double>(20, 2.0)};
    for (const double value : filtered(plane, box, box).values) EXPECT_NEAR(value, 2, 1e-15);
    plane.values.assign(20, 0.0);
    plane.values[7] = 9;  // the third of the second row
    const Plane spread = filtered(plane, box, box);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 5; ++x) {
            const bool near = x >= 1 && x <= 3 && y <= 2;
            EXPECT_NEAR(spread.values[test::pixel_index(x, y, 5)], near ? 1 : 0, 1e-15) << x << ' ' << y;
        }
    }
    EXPECT_EQ(normalised({-2, 0, 4}), (AxisWeights{-1, 0, 1}));
}

}  // namespace
}  // namespace tandem
