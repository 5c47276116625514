// The tier fast: near the exact tiers where float suffices, and never NaN where it does not.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/backend_list.h"
#include "tandem/error/error.h"
#include "tandem/film/compare.h"
#include "tandem/scene/named_scenes.h"
#include "tandem/scene/prepare.h"

namespace tandem {
namespace {

std::vector<test::Renderer> fast_renderers() {
    std::vector<test::Renderer> list;
    for (test::Renderer renderer : test::exact_renderers()) {
        if (renderer.tier != Tier::strict) continue;
        renderer.tier = Tier::fast;
        list.push_back(std::move(renderer));
    }
    return list;
}

class Fast : public test::ExactBackend {
  protected:
    [[nodiscard]] RenderResult draw(const PreparedScene& scene, Tier tier) const {
        RenderJob job;
        job.width = 200;
        job.height = 180;
        job.samples = 4;
        job.tier = tier;
        return backend_->render(backend_->load(scene, tier), job);
    }
};

TEST_P(Fast, IsNearStrictInScenesThatFloatCanHold) {
    for (const char* name :
         {"paper", "spheres/500", "boxes/200", "mixed/300", "triangles/300", "quads/50", "icosphere/3"}) {
        const PreparedScene scene = prepare(named_scene(name));
        const RenderResult fast = draw(scene, Tier::fast);
        const FilmDifference difference = compare(fast.film, draw(scene, Tier::strict).film);
        EXPECT_EQ(fast.stats.counters.invalid_samples, 0U) << name;
        // a pixel differs visibly only where a sample at an edge falls to the other side
        EXPECT_LE(difference.residual_rate(Tolerance::one_level), 1e-3) << name;
        EXPECT_LE(difference.mean, 1e-5) << name;
        EXPECT_GT(difference.differing_sums, 0U) << name << ": the tier fast was not asked";
    }
}

TEST_P(Fast, HasNoInvalidSamplesInScenesThatFloatCannotHold) {
    for (const char* name : {"hard/planet", "hard/telescope"}) {
        const PreparedScene scene = prepare(named_scene(name));
        const RenderResult fast = draw(scene, Tier::fast);
        EXPECT_EQ(fast.stats.counters.invalid_samples, 0U) << name;
        EXPECT_LE(compare(fast.film, draw(scene, Tier::strict).film).mean, 0.05) << name;
    }
}

TEST_P(Fast, RefusesAJobOfAnotherTier) {
    RenderJob job;
    job.tier = Tier::fast;
    const auto strict = backend_->load(prepare(named_scene("paper")), Tier::strict);
    EXPECT_THROW((void)backend_->submit(strict, job), InputError);
}

INSTANTIATE_TEST_SUITE_P(Backends, Fast, ::testing::ValuesIn(fast_renderers()), test::test_name);

}  // namespace
}  // namespace tandem
