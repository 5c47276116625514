// Small primitives beside a huge one, on every backend: the CPU traces them in layers (cpu/size_layers.h), and boxes on
// the GPU are padded by a part of their own reach (kernel/traversal/proposal.h). Neither may lose a hit.

#include "support/huge_primitive.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/backend_list.h"
#include "tandem/kernel/traversal/intersect.h"

namespace tandem {
namespace {

class HugePrimitives : public test::ExactBackend {
  protected:
    /// The nearest hit of all primitives, tested one by one.
    [[nodiscard]] Closest<double> expected_hit(const PreparedScene& scene, const Ray<float>& ray) const {
        const LoopTracer one_by_one{view(scene)};
        if (GetParam().tier == Tier::precise) return one_by_one.closest(to_real<double>(ray), NoSource{}, true);
        const Closest<float> hit = one_by_one.closest(ray, NoSource{}, true);
        return {hit.t, hit.primitive};
    }
};

TEST_P(HugePrimitives, HideNoSmallOnes) {
    test::Random random(23);
    int hits_of_small_ones = 0;
    for (int round = 0; round < 20; ++round) {
        const PreparedScene scene = test::beside_a_huge_one(random);
        const std::vector<Ray<float>> rays = test::rays_at_small_ones(scene, random, 500);
        std::vector<Closest<double>> expected;
        for (const Ray<float>& ray : rays) expected.push_back(expected_hit(scene, ray));
        const auto resident = load(scene);
        for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
            std::vector<Hit> hits(rays.size());
            std::vector<double> wide_t(rays.size());
            backend_->trace(*resident, {.rays = rays, .hits = hits, .wide_t = wide_t, .coherence = coherence});
            std::vector<RayEnd> before(rays.size()), behind(rays.size());
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(hits[i].primitive, expected[i].primitive) << "round " << round << ", ray " << i;
                const bool is_hit = hits[i].primitive != no_primitive;
                ASSERT_EQ(wide_t[i], is_hit ? expected[i].t : 0) << "round " << round << ", ray " << i;
                if (hits[i].primitive < test::small_count) ++hits_of_small_ones;
                before[i].t = is_hit ? wide_t[i] : 1;
                behind[i].t = is_hit ? wide_t[i] * (1 + 1e-15) : 1e300;
            }
            std::vector<Hit> at_once(rays.size()), later(rays.size());
            backend_->trace(*resident, {.rays = rays, .hits = at_once, .ends = before, .coherence = coherence});
            backend_->trace(*resident, {.rays = rays, .hits = later, .ends = behind, .coherence = coherence});
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(at_once[i].primitive, no_primitive) << "round " << round << ", shadow ray " << i;
                ASSERT_EQ(later[i].primitive == no_primitive, hits[i].primitive == no_primitive)
                    << "round " << round << ", shadow ray " << i;
            }
        }
    }
    EXPECT_GT(hits_of_small_ones, 2'000);
}

INSTANTIATE_TEST_SUITE_P(Backends, HugePrimitives, testing::ValuesIn(test::exact_renderers()), test::test_name);

}  // namespace
}  // namespace tandem
