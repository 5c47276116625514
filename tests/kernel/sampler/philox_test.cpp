#include "tandem/kernel/sampler/philox.h"

#include <gtest/gtest.h>

#include <array>

#include "tandem/kernel/sampler/dimensions.h"

namespace tandem {
namespace {

using Block = std::array<std::uint32_t, 4>;

Block philox(const Block& counter, std::uint32_t key0, std::uint32_t key1) {
    const auto block = philox4x32<std::uint32_t>({{counter[0], counter[1], counter[2], counter[3]}}, key0, key1);
    return {block.word[0], block.word[1], block.word[2], block.word[3]};
}

// The known answers published with the generator by its authors (Random123, philox4x32 with 10 rounds).
TEST(Philox, KnownAnswers) {
    EXPECT_EQ(philox({0, 0, 0, 0}, 0, 0), (Block{0x6627E8D5U, 0xE169C58DU, 0xBC57AC4CU, 0x9B00DBD8U}));
    constexpr std::uint32_t ones = 0xFFFFFFFFU;
    EXPECT_EQ(philox({ones, ones, ones, ones}, ones, ones),
              (Block{0x408F276DU, 0x41C83B0EU, 0xA20BC7C6U, 0x6D5451FDU}));
    EXPECT_EQ(philox({0x243F6A88U, 0x85A308D3U, 0x13198A2EU, 0x03707344U}, 0xA4093822U, 0x299F31D0U),
              (Block{0xD16CFE09U, 0x94FDCCEBU, 0x5001E420U, 0x24126EA1U}));
}

TEST(Philox, BlocksFollowTheDocumentedCounter) {
    const PhiloxKeys keys = philox_keys(0x0123456789ABCDEFU);
    const auto block = SampleId<float>{&keys, 7, 11U, 13}.block(Dimension::film);
    const Block direct = philox({11, 13, static_cast<std::uint32_t>(Dimension::film), 7}, 0x89ABCDEFU, 0x01234567U);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(block.word[i], direct[i]);
}

TEST(Philox, UnitIntervalHoldsEveryMultipleOnceAndNeverOne) {
    for (std::uint32_t i = 0; i < 1U << 24; ++i) {
        const float value = to_unit_interval<float>(i << 8 | (i & 0xFFU));
        ASSERT_EQ(static_cast<double>(value), static_cast<double>(i) * 0x1p-24) << i;
    }
    EXPECT_LT(to_unit_interval<float>(0xFFFFFFFFU), 1.0F);
}

// Chi-squared over 256 cells for each of the 16 bytes of a block, counting pixels upward as the renderer does.
TEST(Philox, BytesAreUniform) {
    constexpr std::uint32_t samples = 1U << 16;
    std::array<std::array<std::uint32_t, 256>, 16> counts{};
    const PhiloxKeys keys = philox_keys(1);
    for (std::uint32_t pixel = 0; pixel < samples; ++pixel) {
        const auto block = SampleId<float>{&keys, 0, pixel, 0}.block(Dimension::film);
        for (std::size_t byte = 0; byte < 16; ++byte) ++counts[byte][block.word[byte / 4] >> 8 * (byte % 4) & 0xFFU];
    }
    for (std::size_t byte = 0; byte < 16; ++byte) {
        double chi_squared = 0;
        for (const std::uint32_t count : counts[byte]) {
            const double excess = count - samples / 256.0;
            chi_squared += excess * excess / (samples / 256.0);
        }
        // 255 degrees of freedom: mean 255, standard deviation 22.6; outside of these with probability 1e-6 each
        EXPECT_GT(chi_squared, 160) << "byte " << byte;
        EXPECT_LT(chi_squared, 375) << "byte " << byte;
    }
}

}  // namespace
}  // namespace tandem
