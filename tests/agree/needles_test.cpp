// Solids as thin as needles, on every backend. Hierarchies on the CPU hold them in pieces (cpu/cut_primitives.h), and
// no ray passes between two of them.

#include "support/needles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/hits_of_the_loop.h"

namespace tandem {
namespace {

class Needles : public test::BackendBesideTheLoop {};

TEST_P(Needles, AreHitWhereTheyAre) {
    for (const double length : {0.3, 1.5}) {
        test::Random random(51);
        const PreparedScene scene = test::needles(random, 300, length);
        const std::vector<Hit> hits = expect_hits_of_the_loop(scene, test::rays_at_needles(scene, random, 3'000),
                                                              "length " + std::to_string(length));
        EXPECT_GT(std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.primitive != no_primitive; }),
                  1'000);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, Needles, testing::ValuesIn(test::exact_renderers()), test::test_name);

}  // namespace
}  // namespace tandem
