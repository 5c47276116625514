// Numbers one after the other: any three of the first are had from some start, so they are independent; a lane that
// takes none keeps its place; a packet has the numbers of its rays.
#include "tandem/kernel/sampler/short_sequence.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/sequence_start.h"
#include "tandem/math/lanes.h"

namespace tandem {
namespace {

using Packet = Lanes<float, Sse4>;

TEST(ShortSequence, ReachesAnyThreeNumbers) {
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        test::Random random(number);
        const auto word = [&] { return random.below(0xFFFFFFFFU); };
        const std::uint32_t wanted[] = {word(), word(), word()};
        ShortSequence<float> sequence(test::sequence_start(wanted[0], wanted[1], wanted[2], word()));
        for (const std::uint32_t w : wanted) ASSERT_EQ(sequence.next(true), w) << "case " << number;
    }
}

TEST(ShortSequence, KeepsThePlaceOfLanesThatTakeNone) {
    const auto lanes = [](std::uint32_t first) {
        return UInt<Packet>::from([&](int i) { return first * 7919U + static_cast<std::uint32_t>(i) * 104729U; });
    };
    const PhiloxBlock<UInt<Packet>> start = {{lanes(1), lanes(2), lanes(3), lanes(4)}};
    ShortSequence<Packet> packet(start);
    std::vector<ShortSequence<float>> rays;
    rays.reserve(Packet::size);
    for (int i = 0; i < Packet::size; ++i) {
        rays.emplace_back(
            PhiloxBlock<std::uint32_t>{{start.word[0][i], start.word[1][i], start.word[2][i], start.word[3][i]}});
    }
    test::Random random(1);
    for (int step = 0; step < 1000; ++step) {
        bool takes[Packet::size];
        for (bool& t : takes) t = random.coin();
        const auto mask = UInt<Packet>::from([&](int i) { return takes[i] ? 1U : 0U; }) == UInt<Packet>(1U);
        const UInt<Packet> numbers = packet.next(mask);
        for (int i = 0; i < Packet::size; ++i) {
            if (!takes[i]) continue;
            ASSERT_EQ(numbers[i], rays[static_cast<std::size_t>(i)].next(true)) << step;
        }
    }
}

// Each of 256 values of the highest byte, in the 5th, the 50th and the 500th number: chi-square with 255 degrees of
// freedom, whose standard deviation is 22.6.
TEST(ShortSequence, StaysUniform) {
    for (const int place : {5, 50, 500}) {
        constexpr int count = 1 << 16;
        std::vector<int> seen(256, 0);
        for (std::uint32_t i = 0; i < count; ++i) {
            ShortSequence<float> sequence(philox4x32<std::uint32_t>({{i, 0, 0, 0}}, 1, 2));
            std::uint32_t number = 0;
            for (int k = 0; k < place; ++k) number = sequence.next(true);
            ++seen[number >> 24];
        }
        double chi2 = 0;
        for (const int n : seen) chi2 += (n - count / 256.0) * (n - count / 256.0) / (count / 256.0);
        EXPECT_NEAR(chi2, 255, 5 * 22.6) << place;
    }
}

}  // namespace
}  // namespace tandem
