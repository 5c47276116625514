// Triangles as thin as hair, on every backend. Hierarchies hold them in pieces (cuda/cut_kernels.h,
// cpu/cut_primitives.h), and no ray passes between two of them.

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

// So many that the CPU traces single rays through groups, which hold them in pieces (cpu/cut_primitives.h).
TEST_P(Hair, InGroupsIsHitWhereItIs) {
    test::Random random(43);
    const PreparedScene scene = test::hair(random, 20'000, 100, {.width = 0.01F});
    expect_hits_of_the_loop(scene, test::rays_at_hair(scene, random, 500), "20,000 hairs");
}

/// On the CPU: 512 coherent rays, `step` apart, have the hits of the loop. Returns whether they made the groups, as the
/// first packet that is split does; these count as a build.
bool make_groups(const PreparedScene& scene, float step) {
    const LoopTracer loop{view(scene)};
    const auto backend = make_backend("cpu");
    const auto resident = backend->load(scene);
    const double before = resident->load_times().build;
    std::vector<Ray<float>> rays;
    for (int i = 0; i < 512; ++i) {
        const auto x = static_cast<float>(i % 16), y = static_cast<float>(i) / 16;
        rays.push_back({{0, 0, 4}, {step * (x + 1), step * y * 0.1F, -1}});
    }
    std::vector<Hit> hits(rays.size());
    backend->trace(*resident, rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(hits[i].primitive, loop.closest(rays[i], NoSource{}, true).primitive) << step << ", ray " << i;
    }
    return resident->load_times().build > before;
}

TEST(HairInPackets, IsTracedOneByOneIfPacketsAreWideOrItIsCut) {
    test::Random random(42);
    const PreparedScene scene = test::hair(random, 20'000, 0, {.reach = 0.3F});
    EXPECT_FALSE(make_groups(scene, 1e-4F));
    EXPECT_TRUE(make_groups(scene, 0.01F));
    EXPECT_TRUE(make_groups(test::hair(random, 20'000, 0, {.width = 0.01F}), 1e-4F)) << "cut";
}

INSTANTIATE_TEST_SUITE_P(Backends, Hair, testing::ValuesIn(test::exact_renderers()), test::test_name);

}  // namespace
}  // namespace tandem
