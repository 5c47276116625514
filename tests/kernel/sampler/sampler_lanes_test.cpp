// Packets against single rays, bit for bit, for each instruction set that this processor has.
#include <gtest/gtest.h>

#include "kernel/sampler/sampler_lanes_body.h"
#include "math/lane_operations.h"
#include "support/random.h"
#include "tandem/render/sampler_names.h"

namespace tandem::test {
namespace {

void compare(const SamplerRunner& packet) {
    constexpr int most_lanes = 16;
    for (const SamplerInfo& info : sampler_infos()) {
        for (std::uint64_t number = 0; number < 3000; ++number) {
            Random random(number);
            SamplerInput in[most_lanes];
            const std::uint64_t seed = random.bits();
            const std::uint32_t frame = random.below(1000), dimension = random.below(9), filter = random.below(4);
            for (SamplerInput& lane : in) {
                lane = {seed,
                        static_cast<std::uint32_t>(info.sampler),
                        frame,
                        dimension,
                        filter,
                        random.below(65536),
                        random.below(65536),
                        random.below(1U << 24),
                        random.below(600)};
            }
            std::uint32_t ours[most_lanes][10], want[10];
            packet.run(in, ours);
            for (int i = 0; i < packet.lanes; ++i) {
                run_sampler<float>(in + i, &want);
                for (int k = 0; k < 10; ++k) {
                    ASSERT_EQ(ours[i][k], want[k])
                        << info.name << ", case " << number << ", lane " << i << ", word " << k;
                }
            }
        }
    }
}

TEST(SamplerLanes, AgreeWithSingleRaysOnV2) { compare(sampler_runner_v2()); }

TEST(SamplerLanes, AgreeWithSingleRaysOnV3) {
    if (!has_v3()) GTEST_SKIP() << "no AVX2 here";
    compare(sampler_runner_v3());
}

TEST(SamplerLanes, AgreeWithSingleRaysOnV4) {
    if (!has_v4()) GTEST_SKIP() << "no AVX-512 here";
    compare(sampler_runner_v4());
}

}  // namespace
}  // namespace tandem::test
