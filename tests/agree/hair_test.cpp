// Triangles as thin as hair, on every backend. Hierarchies on the GPU hold them in pieces (cuda/cut_kernels.h), and no
// ray passes between two of them.

#include "support/hair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/hits_of_the_loop.h"

namespace tandem {
namespace {

class Hair : public test::BackendBesideTheLoop {};

TEST_P(Hair, IsHitWhereItIs) {
    for (const std::uint32_t spheres : {0U, 100U}) {
        test::Random random(41);
        const PreparedScene scene = test::hair(random, 700, spheres);
        const std::vector<Hit> hits = expect_hits_of_the_loop(scene, test::rays_at_hair(scene, random, 4'000),
                                                              std::to_string(spheres) + " spheres");
        const auto is_of_hair = [&](const Hit& hit) {
            return hit.primitive != no_primitive && hit.primitive >= spheres;
        };
        EXPECT_GT(std::count_if(hits.begin(), hits.end(), is_of_hair), 1'000);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, Hair, testing::ValuesIn(test::exact_renderers()), test::test_name);

}  // namespace
}  // namespace tandem
