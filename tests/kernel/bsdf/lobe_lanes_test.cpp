// Packets against single rays, bit for bit: all that a lobe gives, for each instruction set that this processor has.
#include <gtest/gtest.h>

#include <cstring>

#include "kernel/bsdf/lobe_inputs.h"
#include "kernel/bsdf/lobe_lanes_body.h"
#include "math/lane_operations.h"

namespace tandem::test {
namespace {

constexpr const char* lobe_names[] = {
#define TANDEM_LOBE(type, ...) #type,
#include "tandem/kernel/bsdf/lobes.def"
};

void compare(const LobeRunner& packet, const LobeRunner& single, const char* tier) {
    constexpr int most_lanes = 16;
    for (std::uint64_t round = 0; round < 5000; ++round) {
        LobeInput in[most_lanes];
        LobeBits ours[most_lanes];
        for (int i = 0; i < packet.lanes; ++i) in[i] = lobe_input(round * most_lanes + static_cast<unsigned>(i));
        packet.run(in, ours);
        for (int i = 0; i < packet.lanes; ++i) {
            LobeBits want = {};
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

// Away from grazing directions and from the smoothest surfaces, where float has no place for the facets' slopes.
TEST(LobeLanes, TheFastTierIsNearTheStrictOne) {
    int compared = 0, chose_otherwise = 0;
    for (std::uint64_t number = 0; number < 100'000; ++number) {
        LobeInput in = lobe_input(number);
        if (in.wo[2] < 0.05 || in.wi[2] < 0.05 || in.roughness[0] < 0.05 || in.roughness[1] < 0.05) continue;
        LobeBits strict, fast;
        run_lobes<float>(&in, &strict);
        run_lobes<FastFloat>(&in, &fast);
        for (int lobe = 0; lobe < lobe_count; ++lobe) {
            const auto in_fast = [&](int k) { return float_of(static_cast<std::uint32_t>(fast.number[lobe][k])); };
            // numbers of decisions are doubles
            const auto in_strict = [&](int k) {
                const bool is_double = k == 3 || (k >= 7 && k <= 10);
                const std::uint64_t bits = strict.number[lobe][k];
                return is_double ? double_of(bits) : widen(float_of(static_cast<std::uint32_t>(bits)));
            };
            const auto expect_near = [&](int k, double relative, double absolute) {
                EXPECT_NEAR(in_fast(k), in_strict(k), relative * std::abs(in_strict(k)) + absolute)
                    << lobe_names[lobe] << ", number " << k << ", lobe_input(" << number << ")";
            };
            for (int k = 0; k < 4; ++k) expect_near(k, 5e-3, 1e-6);
            for (int k = 4; k < 7; ++k) expect_near(k, 1e-5, 1e-6);
            ++compared;
            if (fast.number[lobe][14] != strict.number[lobe][14] || fast.number[lobe][15] != strict.number[lobe][15]) {
                ++chose_otherwise;
                continue;
            }
            for (int k = 7; k < 10; ++k) expect_near(k, 0, 5e-3);
            for (int k = 11; k < 14; ++k) expect_near(k, 5e-3, 5e-3);
        }
        if (HasFailure()) return;
    }
    EXPECT_GT(compared, 50'000);
    EXPECT_LT(chose_otherwise, compared / 1000);
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
