// Packets against single rays, bit for bit: all that a lobe gives, for each instruction set that this processor has.
#include <gtest/gtest.h>

#include <cstring>

#include "kernel/bsdf/lobe_inputs.h"
#include "kernel/bsdf/lobe_lanes_body.h"
#include "math/lane_operations.h"

namespace tandem::test {
namespace {

constexpr const char* lobe_names[] = {
#define TANDEM_LOBE(type, is) #type,
#include "tandem/kernel/bsdf/lobes.def"
#undef TANDEM_LOBE
};

void compare(const LobeRunner& packet, const LobeRunner& single, const char* tier) {
    constexpr int most_lanes = 16;
    for (std::uint64_t round = 0; round < 5000; ++round) {
        LobeInput in[most_lanes];
        LobeBits ours[most_lanes];
        for (int i = 0; i < packet.lanes; ++i) in[i] = lobe_input(round * most_lanes + static_cast<unsigned>(i));
        packet.run(in, ours);
        for (int i = 0; i < packet.lanes; ++i) {
            LobeBits want;
            single.run(in + i, &want);
            for (int lobe = 0; lobe < lobe_count; ++lobe) {
                for (int k = 0; k < numbers_of_a_lobe; ++k) {
                    ASSERT_EQ(ours[i].number[lobe][k], want.number[lobe][k])
                        << tier << ", " << lobe_names[lobe] << ", number " << k << ", lobe_input("
                        << round * most_lanes + static_cast<unsigned>(i) << ")";
                }
            }
        }
    }
}

void compare(const LobeRunners& packets) {
    compare(packets.strict, lobe_runner<float>(), "strict");
    compare(packets.precise, lobe_runner<double>(), "precise");
}

TEST(LobeLanes, AgreeWithSingleRaysOnV2) { compare(lobe_runners_v2()); }

TEST(LobeLanes, AgreeWithSingleRaysOnV3) {
    if (!has_v3()) GTEST_SKIP() << "no AVX2 here";
    compare(lobe_runners_v3());
}

TEST(LobeLanes, AgreeWithSingleRaysOnV4) {
    if (!has_v4()) GTEST_SKIP() << "no AVX-512 here";
    compare(lobe_runners_v4());
}

TEST(LobeLanes, InputsReachEveryAnswer) {
    for (int lobe = 0; lobe < lobe_count; ++lobe) {
        int valid = 0;
        for (std::uint64_t number = 0; number < 1000; ++number) {
            const LobeInput in = lobe_input(number);
            LobeBits bits;
            run_lobes<float>(&in, &bits);
            valid += bits.number[lobe][14] != 0 ? 1 : 0;
        }
        EXPECT_GT(valid, 500) << lobe_names[lobe];
        EXPECT_LT(valid, 1000) << lobe_names[lobe];
    }
}

}  // namespace
}  // namespace tandem::test
