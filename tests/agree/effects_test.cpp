// Effects: what specialisation leaves out changes no bit, what is forced off leaves the scene without it, CPU and GPU
// agree, and the oracle is near.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/backend_list.h"
#include "support/effect_scenes.h"
#include "tandem/effects/derive.h"
#include "tandem/film/compare.h"
#include "tandem/scene/prepare.h"

namespace tandem {
namespace {

using test::effect_scenes;
using test::EffectScene;

RenderJob small_job(Tier tier = Tier::strict) {
    RenderJob job;
    job.tier = tier;
    job.width = 61;
    job.height = 43;
    job.samples = 4;
    job.seed = 3;
    return job;
}

PreparedScene prepare_forced(const Scene& scene, EffectMask on, EffectMask off) {
    PrepareOptions options;
    options.effects = {on, off};
    return prepare(scene, options);
}

class EffectBits : public test::ExactBackend {
  protected:
    [[nodiscard]] RenderResult render(const PreparedScene& scene) {
        return backend_->render(load(scene), small_job(GetParam().tier));
    }
};

TEST_P(EffectBits, AreThoseOfTheLeastProcessor) {
    BackendOptions least;
    least.instruction_set = "x86-64-v2";
    const auto reference = make_backend("cpu", least);
    for (const EffectScene& entry : effect_scenes()) {
        const PreparedScene scene = prepare(entry.scene);
        const RenderResult result = render(scene);
        const Film expected =
            reference->render(reference->load(scene, GetParam().tier), small_job(GetParam().tier)).film;
        EXPECT_EQ(film_hash(result.film), film_hash(expected)) << entry.name;
        EXPECT_EQ(result.stats.counters, RenderCounters{}) << entry.name;
        EXPECT_EQ(result.stats.effects, entry.effects) << entry.name;
    }
}

// The exact set, each set with one effect more, and the set of all effects.
TEST_P(EffectBits, DoNotDependOnWhatElseIsSimulated) {
    for (const EffectScene& entry : effect_scenes()) {
        const std::string expected = film_hash(render(prepare(entry.scene)).film);
        for (std::uint32_t i = 0; i <= effect_count; ++i) {
            const EffectMask more = i == effect_count ? all_effects : EffectMask(static_cast<Effect>(i));
            if (entry.effects.covers(more)) continue;
            const RenderResult result = render(prepare_forced(entry.scene, more, {}));
            EXPECT_EQ(film_hash(result.film), expected) << entry.name << " and " << to_string(more);
            EXPECT_EQ(result.stats.effects, entry.effects | more);
        }
    }
}

TEST_P(EffectBits, OfWhatIsForcedOffAreThoseOfTheSceneWithoutIt) {
    for (const EffectScene& entry : effect_scenes()) {
        for (std::uint32_t i = 0; i < effect_count; ++i) {
            const auto effect = static_cast<Effect>(i);
            if (!entry.effects.has(effect)) continue;
            const RenderResult forced = render(prepare_forced(entry.scene, {}, effect));
            EXPECT_FALSE(forced.stats.effects.has(effect)) << entry.name;
            // a kernel that could simulate it does not
            const RenderResult carried = render(prepare_forced(without_effects(entry.scene, effect), all_effects, {}));
            EXPECT_EQ(film_hash(forced.film), film_hash(carried.film)) << entry.name << ", " << to_string(effect);
            if (effect == Effect::nested_media) continue;  // may change nothing
            EXPECT_NE(film_hash(forced.film), film_hash(render(prepare(entry.scene)).film))
                << entry.name << ", " << to_string(effect);
        }
    }
}

// Rounding of points and directions to float moves silhouettes and what lies behind borders; a hundredth of the pixels
// may see something else.
TEST_P(EffectBits, AreNearTheOracle) {
    const auto oracle = make_backend("oracle");
    for (const EffectScene& entry : effect_scenes()) {
        const PreparedScene scene = prepare(entry.scene);
        const Film expected = oracle->render(oracle->load(scene, GetParam().tier), small_job(GetParam().tier)).film;
        const FilmDifference difference = compare(render(scene).film, expected);
        const bool precise = GetParam().tier == Tier::precise;
        EXPECT_LE(difference.residual_rate(Tolerance::one_level), precise ? 5e-4 : 1e-2) << entry.name;
        EXPECT_LE(difference.mean, precise ? 1e-5 : 2e-4) << entry.name;
    }
}

TEST_P(EffectBits, EndPathsAtTheirLimits) {
    const auto& scenes = effect_scenes();
    const auto mirrors = std::find_if(scenes.begin(), scenes.end(), [](const auto& s) { return s.name == "mirrors"; });
    const auto scene = load(prepare(mirrors->scene));
    RenderJob job = small_job(GetParam().tier);
    std::string previous;
    for (const std::uint32_t limit : {0U, 1U, 2U}) {
        job.limits.reflection = limit;
        const std::string hash = film_hash(backend_->render(scene, job).film);
        EXPECT_NE(hash, previous) << limit;
        previous = hash;
    }
    // no mirror at all is what a limit of 0 leaves
    job.limits.reflection = 0;
    EXPECT_EQ(film_hash(backend_->render(scene, job).film),
              film_hash(backend_->render(load(prepare_forced(mirrors->scene, {}, Effect::reflection)), job).film));
}

INSTANTIATE_TEST_SUITE_P(Backends, EffectBits, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

TEST(EffectScenes, CallForWhatTheirListSays) {
    for (const EffectScene& entry : effect_scenes()) {
        const auto needs = derive_effects(entry.scene, prepare(entry.scene));
        EXPECT_EQ(to_string(mask_of(needs)), to_string(entry.effects)) << entry.name;
    }
}

}  // namespace
}  // namespace tandem
