// Triangles as thin as hair, on every backend. Hierarchies on the GPU hold them in pieces (cuda/cut_kernels.h), and no
// ray passes between two of them.

#include "support/hair.h"

#include <gtest/gtest.h>

#include <string>

#include "support/hits_of_the_loop.h"

namespace tandem {
namespace {

class Hair : public test::BackendBesideTheLoop {};

TEST_P(Hair, IsHitWhereItIs) {
    test::Random random(41);
    int hits = 0;
    for (const std::uint32_t spheres : {0U, 100U}) {
        const PreparedScene scene = test::hair(random, 700, spheres);
        const std::vector<Ray<float>> rays = test::rays_at_hair(scene, random, 4'000);
        for (const Hit& hit : expect_hits_of_the_loop(scene, rays, std::to_string(spheres) + " spheres")) {
            if (hit.primitive != no_primitive && hit.primitive >= spheres) ++hits;
        }
        if (HasFailure()) return;
    }
    EXPECT_GT(hits, 2'000);
}

INSTANTIATE_TEST_SUITE_P(Backends, Hair, testing::ValuesIn(test::exact_renderers()), test::test_name);

}  // namespace
}  // namespace tandem
