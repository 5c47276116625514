// Effects: specialisation changes no bit, forcing an effect off gives the scene without it, CPU and GPU agree, and the
// oracle is near.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "support/backend_list.h"
#include "support/effect_scenes.h"
#include "support/estimate.h"
#include "support/small_job.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/derive.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/compare.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using test::effect_scenes;
using test::EffectScene;
using test::Estimate;
using test::small_job;

PreparedScene prepare_forced(const Scene& scene, EffectMask on, EffectMask off) {
    PrepareOptions options;
    options.effects = {on, off};
    return prepare(scene, options);
}

/// Whether the oracle estimates a part of it in another way.
bool has_own_estimators(EffectMask effects) {
    return effects.has_any(Effect::area_lights | Effect::environment_light | Effect::indirect | Effect::microfacets);
}

/// The probability of a difference as large as this between samples of equal means. B. L. Welch, Biometrika 34, 1947.
double welch_p_value(const Estimate& a, const Estimate& b) {
    const double va = a.variance_of_mean(), vb = b.variance_of_mean();
    if (va + vb == 0) return a.mean() == b.mean() ? 1 : 0;
    const double t = std::abs(a.mean() - b.mean()) / std::sqrt(va + vb);
    const double freedom = (va + vb) * (va + vb) / (va * va / a.freedom() + vb * vb / b.freedom());
    return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(freedom), t));
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

// Among few primitives and in a hierarchy, in kernels for any scene and for this one. These have one shadow search, for
// scenes with and without the effect.
TEST_P(EffectBits, OfCulledFacesAreThoseOfTheLeastProcessor) {
    BackendOptions least;
    least.instruction_set = "x86-64-v2";
    const auto reference = make_backend("cpu", least);
    BackendOptions options = GetParam().options;
    options.specialise = Specialise::always;
    const auto linked = make_backend(GetParam().backend, options);
    for (const char* name : {"triangles/20", "quads/20", "triangles/500", "quads/500"}) {
        Scene scene = named_scene(name);
        for (Material& material : scene.materials) material.sides = FaceSides::culled;
        std::set<std::string> films;
        for (const bool culls : {false, true}) {
            const PreparedScene prepared =
                prepare_forced(scene, Effect::shadows, culls ? EffectMask{} : Effect::cutouts);
            ASSERT_EQ(prepared.effects.has(Effect::cutouts), culls) << name;
            const RenderJob job = small_job(GetParam().tier);
            const RenderResult result = reference->render(reference->load(prepared, GetParam().tier), job);
            const std::string expected = film_hash(result.film);
            EXPECT_EQ(film_hash(backend_->render(load(prepared), job).film), expected) << name << ", culls: " << culls;
            const auto resident = linked->load(prepared, GetParam().tier);
            EXPECT_EQ(film_hash(linked->render(resident, job).film), expected) << name << ", linked, culls: " << culls;
            films.insert(expected);
        }
        EXPECT_EQ(films.size(), 2U) << name;
    }
}

// More pixels than a GPU has threads, so that these take one pixel after the other; rays through a hierarchy, and
// shadow rays through faces that are culled, with and without alpha masks: that once ended in an illegal instruction.
TEST_P(EffectBits, OfCutoutsInAHierarchyAreThoseOfTheLeastProcessor) {
    Scene open = named_scene("triangles/5000");
    for (Material& material : open.materials) material.sides = FaceSides::culled;
    open.environment = {{0.2F, 0.2F, 0.2F}, {0.6F, 0.7F, 0.8F}, {0, 0, 0}, 1};
    open.nodes.push_back({.name = "sun",
                          .trs = {.rotation = {-0.4, 0.3, 0.1, 0.85}},
                          .light = LightSource{.kind = LightKind::directional, .intensity = 0.5F}});
    RenderJob job = small_job(GetParam().tier);
    job.width = 480;
    job.height = 300;
    BackendOptions least;
    least.instruction_set = "x86-64-v2";
    const auto reference = make_backend("cpu", least);
    for (const bool has_masks : {false, true}) {
        if (has_masks) {
            for (Material& material : open.materials) material.alpha_mode = AlphaMode::mask;
            for (Mesh& mesh : open.meshes) {  // corners with and without alpha
                mesh.colours.resize(mesh.positions.size());
                for (std::size_t i = 0; i < mesh.colours.size(); ++i) mesh.colours[i].alpha = i % 3 == 0 ? 0.1F : 1.0F;
            }
        }
        const PreparedScene scene = prepare(open);
        ASSERT_TRUE(scene.effects.has(Effect::cutouts));
        ASSERT_EQ(scene.masked_kinds != 0, has_masks);
        const std::string expected = film_hash(reference->render(reference->load(scene, GetParam().tier), job).film);
        EXPECT_EQ(film_hash(backend_->render(load(scene), job).film), expected) << "masks: " << has_masks;
    }
    const PreparedScene whole = prepare_forced(open, {}, Effect::cutouts);
    ASSERT_TRUE(whole.effects.has(Effect::shadows));
    const std::string film_of_whole = film_hash(reference->render(reference->load(whole, GetParam().tier), job).film);
    EXPECT_EQ(film_hash(backend_->render(load(whole), job).film), film_of_whole) << "without the effect";
    const PreparedScene leaves = prepare(named_scene("leaves/3000"));
    ASSERT_TRUE(leaves.effects.covers(Effect::shadows | Effect::cutouts));
    const std::string expected = film_hash(reference->render(reference->load(leaves, GetParam().tier), job).film);
    EXPECT_EQ(film_hash(backend_->render(load(leaves), job).film), expected) << "leaves";
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
            EXPECT_EQ(result.stats.effects, (entry.effects | more) - host_effects);
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
            const PrepareOptions all = {.effects = {all_effects, {}},
                                        .settings = without_effects(RenderSettings{}, effect)};
            const RenderResult carried = render(prepare(without_effects(entry.scene, effect), all));
            EXPECT_EQ(film_hash(forced.film), film_hash(carried.film)) << entry.name << ", " << to_string(effect);
            if (effect == Effect::roulette) continue;      // of paths this short it may end none
            if (effect == Effect::nested_media) continue;  // may change nothing
            EXPECT_NE(film_hash(forced.film), film_hash(render(prepare(entry.scene)).film))
                << entry.name << ", " << to_string(effect);
        }
    }
}

/// How much more is drawn with TANDEM_LONG_TESTS=1: then films have over 10^8 samples together (docs/building.md).
int effort() {
    const char* text = std::getenv("TANDEM_LONG_TESTS");
    return text != nullptr && std::string(text) == "1" ? 20 : 1;
}

/// What films of different seeds show on average, in tiles of 8 x 8 pixels.
class TileMeans {
  public:
    static constexpr std::uint32_t tile = 8, width = 48, height = 32;
    static constexpr std::size_t tiles = std::size_t{width / tile} * (height / tile);

    TileMeans(Backend& backend, const PreparedScene& scene, Tier tier, int samples) : backend_(backend) {
        resident_ = backend.load(scene, tier);
        job_ = small_job(tier);
        job_.width = width;
        job_.height = height;
        job_.samples = samples;
    }

    void add_films(int count, std::uint64_t first_seed) {
        for (int i = 0; i < count; ++i) {
            job_.seed = first_seed + static_cast<std::uint64_t>(i);
            const Film film = backend_.render(resident_, job_).film;
            std::vector<double> sums(tiles);
            for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
                const Vec3d& sum = film.sums()[pixel];
                sums[pixel / width / tile * (width / tile) + pixel % width / tile] +=
                    (sum.x + sum.y + sum.z) / job_.samples;
            }
            for (std::size_t t = 0; t < tiles; ++t) means_[t].add(sums[t]);
            samples_ += static_cast<double>(film.pixel_count()) * job_.samples;
        }
    }

    [[nodiscard]] const Estimate& of(std::size_t tile) const { return means_[tile]; }
    [[nodiscard]] double samples() const { return samples_; }

  private:
    Backend& backend_;
    std::shared_ptr<ResidentScene> resident_;
    RenderJob job_;
    std::vector<Estimate> means_{tiles};
    double samples_ = 0;
};

/// The oracle's means, drawn once for all backends of a tier.
const TileMeans& oracle_means(const EffectScene& entry, const PreparedScene& scene, Tier tier, int samples, int films,
                              std::uint64_t first_seed) {
    static const auto oracle = make_backend("oracle");
    static std::map<std::tuple<std::string, Tier, std::uint64_t>, TileMeans> known;
    const auto [place, is_new] = known.try_emplace({entry.name, tier, first_seed}, *oracle, scene, tier, samples);
    if (is_new) place->second.add_films(films, first_seed);
    return place->second;
}

// Where the oracle draws other points of lights and other directions, films are compared by their means, by Welch's
// test at 5 % of all tests together (Bonferroni). A tile that differs is looked at again in fresh films, four times as
// many: a bias differs again, a random difference does not.
TEST_P(EffectBits, HaveTheMeansOfTheOracle) {
    const int films = effort() > 1 ? 60 : 10, samples = 16 * effort(), samples_of_oracle = 4 * effort();
    constexpr double level = 0.05 / (TileMeans::tiles * 20);  // of up to 20 scenes
    double drawn = 0;
    for (const EffectScene& entry : effect_scenes()) {
        if (!has_own_estimators(entry.effects)) continue;
        const PreparedScene scene = prepare(entry.scene);
        std::vector<std::size_t> suspects(TileMeans::tiles);
        std::iota(suspects.begin(), suspects.end(), std::size_t{0});
        std::string differences;
        for (const auto& [count, first_seed] : {std::pair{films, 100ULL}, std::pair{4 * films, 10000ULL}}) {
            TileMeans ours(*backend_, scene, GetParam().tier, samples);
            ours.add_films(count, first_seed);
            const TileMeans& theirs =
                oracle_means(entry, scene, GetParam().tier, samples_of_oracle, count, first_seed + 800);
            drawn += ours.samples() + theirs.samples();
            std::vector<std::size_t> differ;
            for (const std::size_t tile : suspects) {
                // a tile of the background alone has no variance but that of rounding each sample to float
                const double off = ours.of(tile).mean() - theirs.of(tile).mean();
                if (std::abs(off) <= 0x1p-23 * theirs.of(tile).mean()) continue;
                const double chance = welch_p_value(ours.of(tile), theirs.of(tile));
                if (chance > level) continue;
                differ.push_back(tile);
                differences +=
                    fmt::format("\n{}, tile {}, {} films from seed {}: {}, oracle {}, chance {}", entry.name, tile,
                                count, first_seed, ours.of(tile).mean(), theirs.of(tile).mean(), chance);
            }
            suspects = differ;
            if (suspects.empty()) break;
        }
        EXPECT_TRUE(suspects.empty()) << differences;
        if (!differences.empty()) RecordProperty("differences", differences);
    }
    RecordProperty("samples", std::to_string(drawn));
    EXPECT_GE(drawn, effort() > 1 ? 1e8 : 1e6);
}

// Rounding of points and directions to float moves silhouettes and what lies behind borders; a hundredth of the pixels
// may see something else.
TEST_P(EffectBits, AreNearTheOracle) {
    const auto oracle = make_backend("oracle");
    for (const EffectScene& entry : effect_scenes()) {
        if (has_own_estimators(entry.effects)) continue;
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

TEST(EffectScenes, NeedTheListedEffects) {
    for (const EffectScene& entry : effect_scenes()) {
        const auto needs = derive_effects(entry.scene, prepare(entry.scene));
        EXPECT_EQ(to_string(mask_of(needs)), to_string(entry.effects)) << entry.name;
    }
}

}  // namespace
}  // namespace tandem
