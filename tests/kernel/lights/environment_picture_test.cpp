// The environment as a light: against its definition with the C library's functions, and its sampler against its
// density.
#include "tandem/kernel/lights/environment_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "support/estimate.h"
#include "support/pixel_index.h"
#include "support/random.h"
#include "tandem/compile/environments.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/sampler/warp.h"
#include "tandem/math/fast_float.h"

namespace tandem {
namespace {

using test::Estimate;
using test::expect_mean;
using test::Random;

constexpr double solid_angle = 4 * pi;

struct Sky {
    PreparedScene scene;

    Sky(int width, int height, const std::function<Vec3f(std::uint32_t, std::uint32_t)>& texel, double turn = 0) {
        EnvironmentImage image{{width, height, {}}};
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                image.picture.pixels.push_back(texel(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)));
            }
        }
        prepare_environment(image, scene);
        scene.environment_picture.turn = turn;
    }
    [[nodiscard]] EnvironmentPicture& picture() { return scene.environment_picture; }
    [[nodiscard]] const EnvironmentPicture& picture() const { return scene.environment_picture; }
    [[nodiscard]] const std::vector<Vec3f>& texels() const { return scene.environment_texels; }
    [[nodiscard]] EnvironmentPictureView view() const { return view_of(picture(), tandem::view(scene)); }
    [[nodiscard]] const Vec3f& at(std::uint32_t x, std::uint32_t y) const { return texels()[y * picture().width + x]; }
};

/// The mean over all directions: between two rows of centres the radiance is linear in the height.
Vec3d mean_radiance(const Sky& sky) {
    const std::uint32_t width = sky.picture().width, height = sky.picture().height;
    const auto height_of = [&](std::uint32_t row) { return std::cos(pi * (row + 0.5) / height); };
    Vec3d mean{0, 0, 0};
    for (std::uint32_t row = 0; row < height; ++row) {
        const double above = row == 0 ? 2 - 2 * height_of(0) : height_of(row - 1) - height_of(row);
        const double below = row == height - 1 ? 2 + 2 * height_of(row) : height_of(row) - height_of(row + 1);
        for (std::uint32_t x = 0; x < width; ++x) mean += widen(sky.at(x, row)) * ((above + below) / (4 * width));
    }
    return mean;
}

Vec3f grey(double level) { return Vec3f(static_cast<float>(level)); }

Vec3d random_direction(Random& random) {
    return sample_sphere<float>(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0)).direction;
}

PhiloxBlock<std::uint32_t> random_words(Random& random) {
    const auto word = [&] { return static_cast<std::uint32_t>(random.bits() >> 32); };
    const std::uint32_t a = word(), b = word(), c = word(), d = word();
    return {{a, b, c, d}};
}

double brightness(const Vec3f& a) { return double{a.x} + double{a.y} + double{a.z}; }

/// Pictures with what is hard: sizes down to one texel, odd ones, huge ratios, single texels, black parts.
std::map<std::string, Sky> skies() {
    Random random(7);
    const auto noise = [&](std::uint32_t, std::uint32_t) {
        return Vec3f{random.uniform(0.0F, 1.0F), random.uniform(0.0F, 1.0F), random.uniform(0.0F, 1.0F)};
    };
    const auto wild = [&](std::uint32_t, std::uint32_t) { return grey(std::abs(random.log_uniform(-40, 40))); };
    const auto one = [](std::uint32_t column, std::uint32_t row, double around) {
        return [=](std::uint32_t x, std::uint32_t y) { return grey(x == column && y == row ? 1e6 : around); };
    };
    std::map<std::string, Sky> result;
    const auto add = [&](const char* name, Sky sky) { result.emplace(name, std::move(sky)); };
    add("constant", {16, 8, [](auto, auto) { return Vec3f{0.25F, 0.5F, 2}; }});
    add("noise", {12, 6, noise, 0.3});
    add("odd", {7, 5, noise, -0.7});
    add("wild", {24, 12, wild});
    add("one texel", {1, 1, noise});
    add("one column", {1, 4, noise});
    add("one row", {5, 1, noise});
    add("two", {2, 2, noise});
    add("hot", {32, 16, one(13, 4, 1e-6), 0.125});
    add("hot in the first row", {32, 16, one(31, 0, 1e-6)});
    add("hot in the last row", {32, 16, one(0, 15, 1e-6)});
    add("alone", {32, 16, one(5, 9, 0)});
    add("half black", {16, 8, [&](auto x, auto y) { return y < 4 && x % 3 != 0 ? noise(x, y) : grey(0); }});
    return result;
}

/// The definition, with the functions of the C library, in long double.
Vec3d defined(const Sky& sky, const Vec3d& direction) {
    using Number = long double;
    const Number x = direction.x, y = direction.y, z = direction.z;
    const Number up = y / std::sqrt(x * x + y * y + z * z);
    const Number full = 2 * std::acos(-1.0L);
    const auto width = static_cast<long>(sky.picture().width), height = static_cast<long>(sky.picture().height);
    const Number along =
        (0.5L + std::atan2(x, -z) / full + static_cast<Number>(sky.picture().turn)) * static_cast<Number>(width) - 0.5L;
    const Number left = std::floor(along);
    const auto column = [&](long step) {
        return static_cast<std::uint32_t>(((static_cast<long>(left) + step) % width + width) % width);
    };
    // the rows whose centres are above and below
    const auto height_of = [&](long row) {
        return std::cos(full / 2 * (static_cast<Number>(row) + 0.5L) / static_cast<Number>(height));
    };
    long upper = -1;
    while (upper + 1 < height && height_of(upper + 1) >= up) ++upper;
    const long lower = std::min(upper + 1, height - 1);
    upper = std::max(upper, 0L);
    const Number down = upper == lower ? 0 : (height_of(upper) - up) / (height_of(upper) - height_of(lower));
    const Number right = along - left;
    Vec3d result;
    for (int c = 0; c < 3; ++c) {
        const auto texel = [&](long step, long row) {
            return static_cast<Number>(sky.at(column(step), static_cast<std::uint32_t>(row))[c]);
        };
        result[c] = static_cast<double>((1 - down) * ((1 - right) * texel(0, upper) + right * texel(1, upper)) +
                                        down * ((1 - right) * texel(0, lower) + right * texel(1, lower)));
    }
    return result;
}

TEST(EnvironmentPicture, IsWhatItIsDefinedToBe) {
    for (const auto& [name, sky] : skies()) {
        double largest = 0;
        for (const Vec3f& texel : sky.texels()) largest = std::max(largest, brightness(texel));
        for (std::uint64_t number = 0; number < 2'000; ++number) {
            Random random(number);
            const Vec3d direction = random_direction(random) * std::abs(double{random.log_uniform(-20, 20)});
            const Vec3d wanted = defined(sky, direction);
            const Vec3<double> precise = emitted<double>(sky.view(), direction);
            const Vec3f strict = emitted<float>(sky.view(), direction);
            const Vec3<FastFloat> fast = emitted<FastFloat>(sky.view(), Vec3<FastFloat>(direction));
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(precise[c], wanted[c], largest * 1e-12) << name << ", case " << number;
                ASSERT_EQ(strict[c], static_cast<float>(precise[c])) << name << ", case " << number;
                ASSERT_NEAR(to_wide(fast[c]), wanted[c], largest * 1e-3) << name << ", case " << number;
            }
        }
    }
}

TEST(EnvironmentPicture, AConstantOneIsAConstantBackground) {
    const Sky sky = skies().at("constant");
    const Vec3f colour = sky.texels()[0];
    Random random(1);
    for (int i = 0; i < 10'000; ++i) {
        const EnvironmentSight<float> sight = see_environment<float>(sky.view(), random_direction(random));
        ASSERT_EQ(sight.radiance, colour);
        ASSERT_NEAR(sight.pdf * solid_angle, 1, 1e-6);
        const auto sample = sample_environment<float>(sky.view(), random_words(random));
        ASSERT_EQ(sample.radiance, colour);
        ASSERT_NEAR(sample.pdf * solid_angle, 1, 1e-6);
    }
}

/// A grid of cells that are equal in solid angle.
constexpr int grid_columns = 48, grid_rows = 24;

std::size_t grid_cell(const Vec3d& direction) {
    const double u = std::atan2(direction.z, direction.x) / (2 * pi) + 0.5;
    const auto column = std::min(static_cast<int>(u * grid_columns), grid_columns - 1);
    const auto row = std::min(static_cast<int>((1 - direction.y) / 2 * grid_rows), grid_rows - 1);
    return test::pixel_index(column, row, grid_columns);
}

/// The share of the samples that pdf_of() promises for each cell of the grid, by the midpoint rule.
std::vector<double> expected_shares(const Sky& sky) {
    constexpr int fine = 24;
    std::vector<double> shares(grid_columns * grid_rows);
    for (int row = 0; row < grid_rows * fine; ++row) {
        const double y = 1 - 2 * (row + 0.5) / (grid_rows * fine);
        const double radius = std::sqrt(1 - y * y);
        for (int column = 0; column < grid_columns * fine; ++column) {
            const double angle = 2 * pi * ((column + 0.5) / (grid_columns * fine) - 0.5);
            const Vec3d direction = {radius * std::cos(angle), y, radius * std::sin(angle)};
            shares[test::pixel_index(column / fine, row / fine, grid_columns)] +=
                pdf_of<float>(sky.view(), direction) * solid_angle / (grid_columns * grid_rows * fine * fine);
        }
    }
    return shares;
}

TEST(EnvironmentPicture, TheDensityIsThatOfTheSamples) {
    constexpr int count = 200'000;
    for (const auto& [name, sky] : skies()) {
        const std::vector<double> shares = expected_shares(sky);
        double whole = 0;
        for (const double share : shares) whole += share;
        EXPECT_NEAR(whole, 1, 2e-3) << name << ": the integral of the density";

        std::vector<int> counts(shares.size());
        Random random(11);
        for (int i = 0; i < count; ++i) {
            ++counts[grid_cell(sample_environment<float>(sky.view(), random_words(random)).direction)];
        }
        // cells of which too few samples are expected count as one
        double statistic = 0, rest_share = 0;
        int freedom = 0, rest_count = 0;
        const auto add = [&](double share, int found) {
            const double wanted = share / whole * count;
            statistic += (found - wanted) * (found - wanted) / wanted;
            ++freedom;
        };
        for (std::size_t i = 0; i < shares.size(); ++i) {
            if (shares[i] * count >= 10) {
                add(shares[i], counts[i]);
            } else {
                rest_share += shares[i];
                rest_count += counts[i];
            }
        }
        if (rest_share * count >= 10) {
            add(rest_share, rest_count);
        } else {
            EXPECT_LE(rest_count, 40) << name;
        }
        // of a chi-squared distribution, 5 standard deviations; and what the midpoint rule leaves
        EXPECT_LE(statistic, freedom + 5 * std::sqrt(2.0 * freedom) + 0.1 * freedom) << name << ", seed 11";
    }
}

TEST(EnvironmentPicture, TheDensityIsOneInAll) {
    for (const char* name : {"constant", "noise", "odd", "one column", "one row", "two", "half black"}) {
        const Sky sky = skies().at(name);
        Random random(3);
        Estimate whole;
        for (int i = 0; i < 200'000; ++i) {
            whole.add(pdf_of<float>(sky.view(), random_direction(random)) * solid_angle);
        }
        EXPECT_NEAR(whole.mean(), 1, 4.5 * whole.standard_error() + 1e-6) << name;
    }
}

/// Light from above onto a surface with the normal +y, and from all sides.
double cosine(const Vec3d& direction) { return std::max(direction.y, 0.0); }

TEST(EnvironmentPicture, SamplesGiveWhatIsSeenAndItsDensity) {
    for (const auto& [name, sky] : skies()) {
        Random random(5);
        int borders = 0;
        for (int i = 0; i < 20'000; ++i) {
            const auto sample = sample_environment<double>(sky.view(), random_words(random));
            if (sample.pdf == 0) continue;
            ASSERT_NEAR(dot(sample.direction, sample.direction), 1, 0x1p-49) << name << ", sample " << i;
            const EnvironmentSight<double> sight = see_environment<double>(sky.view(), sample.direction);
            const bool agrees = std::abs(sight.pdf - sample.pdf) <= 1e-6 * sample.pdf &&
                                norm1(sight.radiance - sample.radiance) <= 1e-6 * norm1(sample.radiance);
            if (!agrees) ++borders;
        }
        // next to a border of two cells, and where the radiance is next to nothing
        EXPECT_LE(borders, 2) << name;
    }
}

TEST(EnvironmentPicture, BrightnessOverDensityIsTheSameEverywhere) {
    for (const auto& [name, sky] : skies()) {
        const double total = solid_angle * norm1(mean_radiance(sky));
        Random random(6);
        for (int i = 0; i < 20'000; ++i) {
            const auto sample = sample_environment<double>(sky.view(), random_words(random));
            if (sample.pdf == 0) continue;
            const double ratio = norm1(sample.radiance) / (sample.pdf * total);
            ASSERT_LE(ratio, 1 + 1e-5) << name << ", sample " << i << ": no sample is much too bright";
            if (name != "wild" && name.substr(0, 3) != "hot") {
                ASSERT_GE(ratio, 1 - 1e-5) << name << ", sample " << i;
            }
        }
    }
}

TEST(EnvironmentPicture, LightIsNeitherLostNorMadeUp) {
    for (const auto& [name, sky] : skies()) {
        Random random(8);
        Estimate sampled, uniform;
        for (int i = 0; i < 100'000; ++i) {
            const auto sample = sample_environment<float>(sky.view(), random_words(random));
            sampled.add(sample.pdf > 0 ? brightness(sample.radiance) / sample.pdf : 0);
            uniform.add(brightness(emitted<float>(sky.view(), random_direction(random))) * solid_angle);
        }
        const double total = solid_angle * norm1(mean_radiance(sky));
        EXPECT_NEAR(sampled.mean(), total, 4.5 * sampled.standard_error() + 1e-6 * total) << name;
        if (name.substr(0, 4) != "wild") expect_mean(uniform, total, name);
    }
}

TEST(EnvironmentPicture, OneHotTexelIsFound) {
    // as large as those in use: a texel is 1 / 80 000 of the sphere
    const Sky sky(512, 256, [](auto x, auto y) { return grey(x == 200 && y == 60 ? 1e5 : 0.1); });
    Random random(9);
    double truth = 0;  // of the light on a surface that looks up
    Estimate exact;
    for (int i = 0; i < 1'000'000; ++i) {
        const auto sample = sample_environment<double>(sky.view(), random_words(random));
        exact.add(sample.pdf > 0 ? sample.radiance.x * cosine(sample.direction) / sample.pdf : 0);
    }
    truth = exact.mean();
    const auto error_of_64 = [&](const auto& draw) {
        double squares = 0;
        for (int repeat = 0; repeat < 2'000; ++repeat) {
            double sum = 0;
            for (int i = 0; i < 64; ++i) sum += draw();
            squares += (sum / 64 - truth) * (sum / 64 - truth);
        }
        return std::sqrt(squares / 2'000);
    };
    const double by_light = error_of_64([&] {
        const auto sample = sample_environment<double>(sky.view(), random_words(random));
        return sample.pdf > 0 ? sample.radiance.x * cosine(sample.direction) / sample.pdf : 0;
    });
    const double by_chance = error_of_64([&] {
        const Vec3d direction = random_direction(random);
        return emitted<double>(sky.view(), direction).x * cosine(direction) * solid_angle;
    });
    EXPECT_GE(by_chance, 50 * by_light) << by_chance << " and " << by_light << " of " << truth;
}

TEST(EnvironmentPicture, PolesAndSeamAreRight) {
    const Sky sky = skies().at("noise");
    const EnvironmentPictureView view = sky.view();
    const std::uint32_t last = sky.picture().height - 1;
    const auto rows = [&](std::uint32_t row) {  // the least and the greatest red in it
        Vec2<double> range = {1, 0};
        for (std::uint32_t x = 0; x < sky.picture().width; ++x) {
            range = {std::min(range.x, double{sky.at(x, row).x}), std::max(range.y, double{sky.at(x, row).x})};
        }
        return range;
    };
    for (const double off : {0.0, 1e-300, 1e-160, 1e-30, 1e-9, 1e-3}) {
        for (const double side : {1.0, -1.0}) {
            const Vec2<double> range = rows(side > 0 ? 0 : last);
            for (const Vec3d& direction : {Vec3d{off, side, 0}, Vec3d{0, side, off}, Vec3d{-off, side, -off}}) {
                const EnvironmentSight<float> sight = see_environment<float>(view, direction);
                EXPECT_GE(sight.radiance.x, range.x) << off << ", " << side;
                EXPECT_LE(sight.radiance.x, range.y) << off << ", " << side;
                EXPECT_GT(sight.pdf, 0);
                EXPECT_TRUE(std::isfinite(sight.pdf));
            }
        }
    }
    // near a pole all of the first row is seen, each texel at its azimuth; and across the seam nothing jumps
    for (const double height : {0.9999999, 0.3, 0.0, -0.8, -0.9999999}) {
        const double radius = std::sqrt(1 - height * height);
        Vec3f before{0, 0, 0};
        for (int i = 0; i <= 3600; ++i) {
            const double angle = 2 * pi * i / 3600;
            const Vec3f here = emitted<float>(view, Vec3d{radius * std::sin(angle), height, radius * std::cos(angle)});
            if (i > 0) {
                EXPECT_LE(norm1(here - before), 3.1 * sky.picture().width / 3600) << height << ", " << i;
            }
            before = here;
        }
    }
}

TEST(EnvironmentPicture, IsOrientedAndTurnedAsDocumented) {
    // one texel in the middle of each side, of a picture of 8 x 5
    const Sky plain(8, 5, [](auto x, auto y) { return Vec3f(x == 4 && y == 2, x == 6 && y == 2, y == 0); });
    const auto towards = [](const Sky& sky, double turns) {  // from -z to the right
        const double angle = 2 * pi * turns;
        return emitted<double>(sky.view(), Vec3d{std::sin(angle), 0, -std::cos(angle)});
    };
    constexpr double half_texel = 1.0 / 16;
    EXPECT_NEAR(towards(plain, half_texel).x, 1, 1e-12) << "the middle is at -z";
    EXPECT_NEAR(towards(plain, 0.25 + half_texel).y, 1, 1e-12) << "+x is to the right of it";
    EXPECT_NEAR(emitted<double>(plain.view(), Vec3d{0, 1, 0}).z, 1, 1e-12) << "the top is at +y";
    EXPECT_EQ(emitted<double>(plain.view(), Vec3d{0, -1, 0}).z, 0);
    for (const double turn : {0.25, -0.1, 3.5, 0.999}) {
        Sky turned = plain;
        turned.picture().turn = turn;
        // counter-clockwise from above: from -z towards -x
        EXPECT_NEAR(towards(turned, half_texel - turn).x, 1, 1e-9) << turn;
        Random random(1);
        for (int i = 0; i < 1000; ++i) {
            const auto words = random_words(random);
            const auto a = sample_environment<double>(plain.view(), words);
            const auto b = sample_environment<double>(turned.view(), words);
            const double s = std::sin(2 * pi * turn), c = std::cos(2 * pi * turn);
            EXPECT_EQ(a.pdf, b.pdf);
            EXPECT_NEAR(b.direction.x, c * a.direction.x + s * a.direction.z, 1e-13);
            EXPECT_NEAR(b.direction.z, c * a.direction.z - s * a.direction.x, 1e-13);
        }
    }
}

TEST(EnvironmentPicture, IntensityScalesTheLightAndLeavesTheSamples) {
    Sky sky = skies().at("odd");
    const EnvironmentPictureView plain = sky.view();
    sky.picture().intensity = 3.5F;
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const auto words = random_words(random);
        const auto a = sample_environment<double>(plain, words);
        const auto b = sample_environment<double>(sky.view(), words);
        ASSERT_EQ(a.direction, b.direction);
        ASSERT_EQ(a.pdf, b.pdf);
        ASSERT_NEAR(b.radiance.x, a.radiance.x * 3.5, 1e-14);
    }
}

TEST(EnvironmentPicture, OfBlackNothingIsDrawn) {
    const Sky sky(8, 4, [](auto, auto) { return grey(0); });
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        EXPECT_EQ(sample_environment<float>(sky.view(), random_words(random)).pdf, 0);
        EXPECT_EQ(pdf_of<float>(sky.view(), random_direction(random)), 0);
    }
}

TEST(EnvironmentPicture, TheWordsAtTheEndsGiveSamples) {
    for (const auto& [name, sky] : skies()) {
        for (int bits = 0; bits < 16; ++bits) {
            const auto word = [&](int i) { return (bits >> i & 1) != 0 ? 0xFFFFFFFFU : 0U; };
            const auto sample = sample_environment<float>(sky.view(), {{word(0), word(1), word(2), word(3)}});
            EXPECT_NEAR(dot(sample.direction, sample.direction), 1, 1e-14) << name << ", " << bits;
            EXPECT_TRUE(std::isfinite(sample.pdf) && sample.pdf >= 0) << name << ", " << bits;
        }
    }
}

TEST(EnvironmentTables, GiveEveryLitCellAProbabilityAndNoOther) {
    for (const auto& [name, sky] : skies()) {
        const std::uint32_t width = sky.picture().width, height = sky.picture().height;
        EXPECT_EQ(sky.scene.environment_band_ends.back(), 1U << 31) << name;
        for (std::uint32_t band = 0; band <= height; ++band) {
            const std::uint32_t upper = band > 0 ? band - 1 : 0, lower = std::min(band, height - 1);
            std::uint32_t before = 0;
            for (std::uint32_t x = 0; x < width; ++x) {
                const std::uint32_t end = sky.scene.environment_cell_ends[std::size_t{band} * width + x];
                const std::uint32_t next = (x + 1) % width;
                const bool is_lit = brightness(sky.at(x, upper)) + brightness(sky.at(next, upper)) +
                                        brightness(sky.at(x, lower)) + brightness(sky.at(next, lower)) >
                                    0;
                EXPECT_GE(end, before) << name;
                EXPECT_EQ(end > before, is_lit) << name << ", band " << band << ", cell " << x;
                before = end;
            }
            EXPECT_TRUE(before == 0 || before == 1U << 31) << name << ", band " << band;
        }
    }
}

TEST(EnvironmentTables, HoldARatioOfManyOrders) {
    // one texel of 2^100 among texels of 2^-149: nothing over- or underflows, and the weak ones may be drawn
    const Sky sky(64, 32, [](auto x, auto y) { return Vec3f(x == 3 && y == 30 ? 0x1p100F : 0x1p-149F); });
    EXPECT_EQ(sky.scene.environment_cell_ends[0], (1U << 31) / 64);
    EXPECT_EQ(sky.scene.environment_band_ends[5] - sky.scene.environment_band_ends[4], 1U);
    for (std::uint32_t band = 0; band <= 32; ++band) {
        const auto sight =
            see_environment<float>(sky.view(), Vec3d{0, std::cos(pi * band / 32), -std::sin(pi * band / 32)});
        EXPECT_GT(sight.pdf, 0) << band;
    }
}

}  // namespace
}  // namespace tandem
