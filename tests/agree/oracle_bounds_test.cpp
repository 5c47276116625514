// The oracle leaves out primitives whose bounding ball a line passes: no hit may change by that.

#include <gtest/gtest.h>

#include <limits>

#include "support/hard_scenes.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/oracle/oracle.h"
#include "tandem/oracle/oracle_bounds.h"
#include "tandem/render/backend.h"

namespace tandem {
namespace {

TEST(OracleBounds, ChangeNoHit) {
    const auto oracle = make_backend("oracle");
    std::vector<test::HardScene> scenes = test::hard_scenes();
    for (test::HardScene& of_one_kind : test::scenes_of_one_kind()) scenes.push_back(std::move(of_one_kind));
    std::size_t hit = 0;
    for (const test::HardScene& parameters : scenes) {
        constexpr std::uint64_t seed = 33;
        const PreparedScene scene = test::make_scene(parameters, seed);
        const std::vector<Ray<float>> rays = test::make_rays(scene, parameters.count > 500 ? 200 : 2'000, seed);
        std::vector<Hit> hits(rays.size());
        std::vector<double> t(rays.size());
        oracle->trace(*oracle->load(scene), {.rays = rays, .hits = hits, .wide_t = t});
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const OracleHit expected = oracle_trace(scene, rays[i]);
            ASSERT_EQ(hits[i].primitive, expected.primitive) << parameters.name << ", seed " << seed << ", ray " << i;
            ASSERT_EQ(t[i], static_cast<double>(expected.t)) << parameters.name << ", seed " << seed << ", ray " << i;
            hit += expected.primitive == no_primitive ? 0 : 1;
        }
    }
    EXPECT_GT(hit, 5'000U);
}

TEST(OracleBounds, LeaveOutWhatALinePasses) {
    const oracle::Ball ball = {{3, 4, 5}, 1};
    const auto passes = [&](long double x) { return is_outside(oracle::RoughLine({{x, 4, 0}, {0, 0, 2}}), ball); };
    EXPECT_FALSE(passes(3));
    EXPECT_FALSE(passes(3.999999999L));
    EXPECT_TRUE(passes(4.001L));
    EXPECT_TRUE(passes(1.999L));
    EXPECT_FALSE(passes(std::numeric_limits<long double>::quiet_NaN()));
}

}  // namespace
}  // namespace tandem
