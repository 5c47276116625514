// Packets against single rays, bit for bit: every operation on random bit patterns, for each instruction set that this
// processor has.
#include "tandem/math/lanes.h"

#include <gtest/gtest.h>

#include "math/lane_operations_body.h"
#include "support/random.h"

namespace tandem::test {
namespace {

/// Bits of a number: of any double or float, of small ones, of subnormals, infinities, NaN, zeros and equal values.
std::uint64_t any_bits(Random& random, bool wide) {
    static constexpr double special[] = {0.0, -0.0, 1.0, -1.0, 0.5, 1.5, 2.5, 1e-310, 4e-324, 1e-40, -1e-45, 1e300};
    const std::uint64_t bits = random.bits();
    const double value = random.coin() ? special[random.below(12)] : random.uniform(-8.0, 8.0);
    switch (random.below(8)) {
        case 0:
        case 1:
        case 2:
            return bits;
        case 3:  // infinities and NaN
            return wide ? (bits & 0x8008000000000000U) | 0x7FF0000000000000U : (bits & 0x80400000U) | 0x7F800000U;
        default:
            return wide ? static_cast<std::uint64_t>(bits_of(value)) : bits_of(static_cast<float>(value));
    }
}

void compare(const LaneOperations& packets, const char* name) {
    const LaneOperations single = all_operations<float>();
    ASSERT_EQ(packets.count, single.count);
    constexpr int most_lanes = 16;
    for (int k = 0; k < single.count; ++k) {
        const LaneOperation& operation = single.operations[k];
        const bool wide = operation.name[0] == 'D' || operation.name[0] == 'I';
        for (std::uint64_t round = 0; round < 2000; ++round) {
            Random random(round);
            std::uint64_t in[3][most_lanes], ours[most_lanes];
            for (int i = 0; i < packets.lanes; ++i) {
                for (auto& argument : in) argument[i] = any_bits(random, wide);
            }
            packets.operations[k].run(in[0], in[1], in[2], ours);
            for (int i = 0; i < packets.lanes; ++i) {
                std::uint64_t want;
                operation.run(in[0] + i, in[1] + i, in[2] + i, &want);
                ASSERT_EQ(ours[i], want) << name << ", " << operation.name << std::hex << " of 0x" << in[0][i] << " 0x"
                                         << in[1][i] << " 0x" << in[2][i] << ", lane " << std::dec << i << ", round "
                                         << round;
            }
        }
    }
}

TEST(Lanes, AgreeWithScalarsOnV2) { compare(lane_operations_v2(), Sse4::name); }

TEST(Lanes, AgreeWithScalarsOnV3) {
    if (!has_v3()) GTEST_SKIP() << "no AVX2 here";
    compare(lane_operations_v3(), Avx2::name);
}

TEST(Lanes, AgreeWithScalarsOnV4) {
    if (!has_v4()) GTEST_SKIP() << "no AVX-512 here";
    compare(lane_operations_v4(), Avx512::name);
}

using Packet = Lanes<float, Sse4>;

TEST(Lanes, AnyAndAll) {
    for (int pattern = 0; pattern < 16; ++pattern) {
        const auto values = Packet::from([&](int i) { return (pattern >> i & 1) != 0 ? 1.0F : -1.0F; });
        const auto mask = values > Packet(0.0F);
        EXPECT_EQ(any(mask), pattern != 0);
        EXPECT_EQ(all(mask), pattern == 15);
        EXPECT_EQ(any(LaneMask<Sse4>(true)), true);
        EXPECT_EQ(any(LaneMask<Sse4>(false)), false);
    }
}

TEST(Lanes, ForEachValueVisitsEveryActiveLaneOnce) {
    using Word = UInt<Packet>;
    Random random(8);
    for (int round = 0; round < 1000; ++round) {
        const auto values = Word::from([&](int) { return random.below(3); });
        const int pattern = static_cast<int>(random.below(16));
        const auto active = (lane_index(values) & Word(3U)) == lane_index(values) &&
                            Word::from([&](int i) { return static_cast<std::uint32_t>(pattern >> i & 1); }) == Word(1U);
        int visits[4] = {};
        std::uint32_t seen = 0;
        for_each_unique_lane(values, active, [&](std::uint32_t value, const LaneMask<Sse4>& here) {
            ASSERT_EQ(seen >> value & 1U, 0U) << "value " << value << " came twice";
            seen |= 1U << value;
            for (int i = 0; i < 4; ++i) {
                if (!here[i]) continue;
                ++visits[i];
                ASSERT_EQ(values[i], value);
            }
        });
        for (int i = 0; i < 4; ++i) ASSERT_EQ(visits[i], pattern >> i & 1) << "lane " << i;
    }
}

}  // namespace
}  // namespace tandem::test
