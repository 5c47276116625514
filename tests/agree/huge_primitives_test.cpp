// Small primitives beside a huge one, on every backend: the CPU traces them in layers (cpu/size_layers.h), and boxes on
// the GPU are padded by a part of their own reach (kernel/traversal/proposal.h). Neither may lose a hit.

#include "support/huge_primitive.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/hits_of_the_loop.h"

namespace tandem {
namespace {

class HugePrimitives : public test::BackendBesideTheLoop {};

TEST_P(HugePrimitives, HideNoSmallOnes) {
    test::Random random(23);
    int hits_of_small_ones = 0;
    for (int round = 0; round < 20; ++round) {
        const PreparedScene scene = test::beside_a_huge_one(random);
        const std::vector<Ray<float>> rays = test::rays_at_small_ones(scene, random, 500);
        for (const Hit& hit : expect_hits_of_the_loop(scene, rays, "round " + std::to_string(round))) {
            if (hit.primitive < test::small_count) ++hits_of_small_ones;
        }
        if (HasFailure()) return;
    }
    EXPECT_GT(hits_of_small_ones, 1'000);
}

INSTANTIATE_TEST_SUITE_P(Backends, HugePrimitives, testing::ValuesIn(test::exact_renderers()), test::test_name);

}  // namespace
}  // namespace tandem
