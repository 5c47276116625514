// Textures against their definition: an endless picture, looked up with integers and long double.
#include "tandem/kernel/texture/texture_view.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "support/random.h"
#include "tandem/images/levels.h"
#include "tandem/kernel/texture/normal_map.h"
#include "tandem/kernel/texture/texture_set.h"
#include "tandem/math/fast_float.h"
#include "tandem/math/lanes.h"

namespace tandem {
namespace {

constexpr Wrap wraps[] = {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge};

/// A picture of random texels with a random way of being shown.
struct Picture {
    std::vector<std::uint32_t> texels;
    std::vector<float> levels = texture_levels();
    TextureView view{};

    explicit Picture(test::Random& random) {
        view.width = 1 + random.below(7);
        view.height = 1 + random.below(7);
        view.wrap_s = wraps[random.below(3)];
        view.wrap_t = wraps[random.below(3)];
        view.filter = random.coin() ? Filter::linear : Filter::nearest;
        for (std::uint32_t i = 0; i < view.width * view.height; ++i) {
            texels.push_back(static_cast<std::uint32_t>(random.bits()));
        }
        view.texels = texels.data();
        view.levels = levels.data() + (random.coin() ? 256 : 0);
    }

    /// Texel `i` of the endless row that an axis of `size` texels and its wrap mode make.
    static long long in_row(long long i, std::uint32_t size, Wrap wrap) {
        const auto n = static_cast<long long>(size);
        if (wrap == Wrap::clamp_to_edge) return std::min(std::max(i, 0LL), n - 1);
        const long long period = wrap == Wrap::repeat ? n : 2 * n;
        const long long within = ((i % period) + period) % period;
        return within < n ? within : 2 * n - 1 - within;
    }

    long double channel(long long x, long long y, int c) const {
        const std::uint32_t texel = texels[static_cast<std::size_t>(in_row(y, view.height, view.wrap_t)) * view.width +
                                           static_cast<std::size_t>(in_row(x, view.width, view.wrap_s))];
        const std::uint32_t level = texel >> (8 * c) & 255U;
        return c == 3 ? level / 255.0L : static_cast<long double>(view.levels[level]);
    }

    long double value(long double u, long double v, int c) const {
        const long double x = u * view.width;
        const long double y = v * view.height;
        if (view.filter == Filter::nearest) {
            return channel(static_cast<long long>(std::floor(x)), static_cast<long long>(std::floor(y)), c);
        }
        const auto x0 = static_cast<long long>(std::floor(x - 0.5L));
        const auto y0 = static_cast<long long>(std::floor(y - 0.5L));
        const long double fx = x - 0.5L - x0;
        const long double fy = y - 0.5L - y0;
        return (1 - fy) * ((1 - fx) * channel(x0, y0, c) + fx * channel(x0 + 1, y0, c)) +
               fy * ((1 - fx) * channel(x0, y0 + 1, c) + fx * channel(x0 + 1, y0 + 1, c));
    }
};

std::array<float, 4> channels(const Rgba<float>& a) { return {a.r, a.g, a.b, a.a}; }

TEST(Texture, IsTheEndlessPictureOfItsWrapModes) {
    for (std::uint64_t number = 0; number < 100'000; ++number) {
        test::Random random(number);
        const Picture picture(random);
        const double range = random.coin() ? 2 : 1000;
        // odd multiples of 2^-12 lie on no border between texels, where a mirrored picture takes the other one
        const auto any = [&] { return (4 * std::rint(random.uniform(-range, range) * 1024) + 1) / 4096; };
        const double u = any();
        const double v = any();
        const auto found = channels(sample<float>(picture.view, u, v));
        for (int c = 0; c < 4; ++c) {
            ASSERT_NEAR(found[static_cast<std::size_t>(c)], static_cast<double>(picture.value(u, v, c)), 6.1e-8)
                << "case " << number << ", channel " << c << ", u " << u << ", v " << v;
        }
    }
}

TEST(Texture, ShowsATexelAtItsCentre) {
    for (std::uint64_t number = 0; number < 5'000; ++number) {
        test::Random random(number);
        Picture picture(random);
        picture.view.width = picture.view.width > 4 ? 4 : picture.view.width;  // whose half texels are exact
        if (picture.view.width == 3) picture.view.width = 2;
        picture.view.height = 1;
        const std::uint32_t x = random.below(picture.view.width);
        const auto found = channels(sample<float>(picture.view, (x + 0.5) / picture.view.width, 0.5));
        for (int c = 0; c < 4; ++c) {
            ASSERT_EQ(found[static_cast<std::size_t>(c)], static_cast<float>(picture.channel(x, 0, c)))
                << "case " << number;
        }
    }
}

TEST(Texture, OfOneColourHasItEverywhere) {
    for (std::uint64_t number = 0; number < 20'000; ++number) {
        test::Random random(number);
        Picture picture(random);
        for (std::uint32_t& texel : picture.texels) texel = picture.texels[0];
        const auto found =
            channels(sample<float>(picture.view, random.uniform(-1e6, 1e6), double{random.log_uniform(-60, 60)}));
        for (int c = 0; c < 4; ++c) {
            ASSERT_EQ(found[static_cast<std::size_t>(c)], static_cast<float>(picture.channel(0, 0, c)))
                << "case " << number;
        }
    }
}

// Not a memory error, and a value: that of some texels, or for what is not a number that of 0.
TEST(Texture, TakesEveryCoordinate) {
    const double nan = std::nan("");
    const double infinity = std::numeric_limits<double>::infinity();
    for (std::uint64_t number = 0; number < 100'000; ++number) {
        test::Random random(number);
        const Picture picture(random);
        const double u = double_of(random.bits());
        const double v = double_of(random.bits());
        for (const float value : channels(sample<float>(picture.view, u, v))) {
            ASSERT_TRUE(value >= 0 && value <= 1) << "case " << number << ": u " << u << ", v " << v;
        }
        const auto at_zero = channels(sample<float>(picture.view, 0.0, 0.25));
        for (const double wrong : {nan, infinity, -infinity}) {
            ASSERT_EQ(channels(sample<float>(picture.view, wrong, 0.25)), at_zero) << "case " << number;
        }
    }
}

TEST(Texture, JustBelowZeroIsNotBeyondTheEnd) {
    for (const Wrap wrap : wraps) {
        for (const Filter filter : {Filter::nearest, Filter::linear}) {
            for (const double u : {-1e-20, -1e-300, -0.0, 1 - 0x1p-53, 1.0, 2.0, -1.0}) {
                const TexelPair<double> pair = texels_around(u, wrap, filter, 5.0);
                EXPECT_TRUE(pair.first >= 0 && pair.first <= 4 && pair.second >= 0 && pair.second <= 4) << u;
                EXPECT_TRUE(pair.weight >= 0 && pair.weight < 1) << u;
            }
        }
    }
    EXPECT_EQ(texels_around(-1e-20, Wrap::repeat, Filter::linear, 5.0).weight, 0.5)
        << "half of the last, half of the first";
}

TEST(Texture, GivesPacketsTheBitsOfSingleRays) {
    using Packet = Lanes<float, Sse4>;
    for (std::uint64_t number = 0; number < 20'000; ++number) {
        test::Random random(number);
        const Picture picture(random);
        const auto any = [&](int) { return random.coin() ? random.uniform(-3.0, 3.0) : double_of(random.bits()); };
        const auto u = Double<Packet>::from(any);
        const auto v = Double<Packet>::from(any);
        const Rgba<Packet> found = sample<Packet>(picture.view, u, v);
        for (int i = 0; i < Packet::size; ++i) {
            const Rgba<float> single = sample<float>(picture.view, u[i], v[i]);
            ASSERT_EQ(channels({found.r[i], found.g[i], found.b[i], found.a[i]}), channels(single))
                << "case " << number;
        }
    }
}

TEST(Texture, InTheOtherTiersIsTheSamePicture) {
    for (std::uint64_t number = 0; number < 20'000; ++number) {
        test::Random random(number);
        Picture picture(random);
        picture.view.filter = Filter::linear;
        const float u = random.uniform(-3.0F, 3.0F);
        const float v = random.uniform(-3.0F, 3.0F);
        const Rgba<float> strict = sample<float>(picture.view, u, v);
        EXPECT_EQ(static_cast<float>(sample<double>(picture.view, u, v).g), strict.g) << "case " << number;
        EXPECT_NEAR(sample<FastFloat>(picture.view, FastFloat(u), FastFloat(v)).g.v, strict.g, 1e-4)
            << "case " << number;
    }
}

TEST(TextureSet, MovesCoordinatesAndFindsItsTexels) {
    const std::vector<float> levels = texture_levels();
    const std::uint32_t texels[] = {0, 0, 0xFF0000FFU, 0x80FF0000U};
    const TextureDescriptor described[] = {{2, 2, 1, Wrap::repeat, Wrap::repeat, Filter::nearest, ColourSpace::linear}};
    const TextureSet set = {texels, described, nullptr, levels.data()};
    const TextureUse use = {0, {0, 1, 0}, {1, 0, 0}};  // u and v change places
    EXPECT_EQ(sample<float>(set, use, 0.0, 0.25).r, 1.0F);
    EXPECT_EQ(sample<float>(set, use, 0.0, 0.75).b, 1.0F);
    const Rgba<float> none = sample<float>(set, TextureUse{}, 0.0, 0.75);
    EXPECT_EQ(channels(none), (std::array<float, 4>{1, 1, 1, 1}));
    MaterialTextures material;
    EXPECT_TRUE(is_opaque<float>(material, 0.0F)) << "0 cuts nothing";
    material.alpha_cutoff = 0.5F;
    EXPECT_FALSE(is_opaque<float>(material, 0.49F));
    EXPECT_TRUE(is_opaque<float>(material, 0.5F)) << "glTF renders what is not below the cutoff";
}

TEST(NormalMap, TurnsTheNormalAlongTheFrame) {
    const Frame<double> frame = {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
    const auto close = [](const Vec3d& a, const Vec3d& b) { return norm1(a - b) < 1e-12; };
    EXPECT_TRUE(close(mapped_normal<float>(frame, {0.5F, 0.5F, 1, 1}, 1), {1, 0, 0}));
    EXPECT_TRUE(close(mapped_normal<float>(frame, {1, 0.5F, 0.5F, 1}, 1), {0, 0, -1})) << "red is the tangent";
    EXPECT_TRUE(close(mapped_normal<float>(frame, {0.5F, 1, 0.5F, 1}, 1), {0, 1, 0})) << "green is up";
    EXPECT_TRUE(close(mapped_normal<float>(frame, {1, 0.5F, 1, 1}, 0.75F), {0.8, 0, -0.6})) << "scale";
    EXPECT_TRUE(close(mapped_normal<float>(frame, {0.5F, 0.5F, 0.5F, 1}, 1), {1, 0, 0})) << "says nothing";
}

}  // namespace
}  // namespace tandem
