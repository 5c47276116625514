/// A backend beside the test of all primitives, one by one.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/backend_list.h"
#include "tandem/kernel/traversal/intersect.h"

namespace tandem::test {

class BackendBesideTheLoop : public ExactBackend {
  protected:
    /// Expects the nearest hits of all primitives, to the bit, and that shadow rays are blocked behind them, but not
    /// before. Returns the hits.
    std::vector<Hit> expect_hits_of_the_loop(const PreparedScene& scene, const std::vector<Ray<float>>& rays,
                                             const std::string& what) {
        std::vector<Closest<double>> expected;
        for (const Ray<float>& ray : rays) expected.push_back(expected_hit(scene, ray));
        const auto resident = load(scene);
        std::vector<Hit> hits(rays.size());
        for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
            std::vector<double> wide_t(rays.size());
            backend_->trace(*resident, {.rays = rays, .hits = hits, .wide_t = wide_t, .coherence = coherence});
            std::vector<RayEnd> before(rays.size()), behind(rays.size());
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const bool is_hit = hits[i].primitive != no_primitive;
                if (hits[i].primitive != expected[i].primitive || wide_t[i] != (is_hit ? expected[i].t : 0)) {
                    ADD_FAILURE() << what << ", ray " << i << ": primitive " << hits[i].primitive << " at " << wide_t[i]
                                  << " instead of " << expected[i].primitive << " at " << expected[i].t;
                    return hits;
                }
                before[i].t = is_hit ? wide_t[i] : 1;
                behind[i].t = is_hit ? wide_t[i] * (1 + 1e-15) : 1e300;
            }
            std::vector<Hit> at_once(rays.size()), later(rays.size());
            backend_->trace(*resident, {.rays = rays, .hits = at_once, .ends = before, .coherence = coherence});
            backend_->trace(*resident, {.rays = rays, .hits = later, .ends = behind, .coherence = coherence});
            for (std::size_t i = 0; i < rays.size(); ++i) {
                EXPECT_EQ(at_once[i].primitive, no_primitive) << what << ", shadow ray " << i;
                EXPECT_EQ(later[i].primitive == no_primitive, hits[i].primitive == no_primitive)
                    << what << ", shadow ray " << i;
            }
        }
        return hits;
    }

  private:
    [[nodiscard]] static Closest<double> expected_hit(const PreparedScene& scene, const Ray<float>& ray) {
        const LoopTracer one_by_one{view(scene)};
        if (GetParam().tier == Tier::precise) return one_by_one.closest(to_real<double>(ray), NoSource{}, true);
        const Closest<float> hit = one_by_one.closest(ray, NoSource{}, true);
        return {hit.t, hit.primitive};
    }
};

}  // namespace tandem::test
