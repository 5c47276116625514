// Rays that leave surfaces, and shadow rays: every backend against the oracle, and against the least processor.

#include <gtest/gtest.h>

#include <cmath>

#include "support/aim.h"
#include "support/backend_list.h"
#include "support/hard_scenes.h"
#include "support/random.h"
#include "tandem/backends/make_backend.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/spawn_ray.h"

namespace tandem {
namespace {

/// Rays from the surfaces of a scene, and the oracle's answers.
struct SurfaceReference {
    std::string name;
    PreparedScene scene;
    std::vector<Ray<float>> rays;
    std::vector<RaySource> sources;
    std::vector<Hit> hits;
    std::vector<RayEnd> ends;
    std::vector<Hit> occluded;
};

/// Where the rays of make_rays() hit, another ray leaves, to either side.
void spawn_rays(SurfaceReference& r, std::size_t count) {
    const std::vector<Ray<float>> first = test::make_rays(r.scene, count, 31);
    std::vector<Hit> hits(first.size());
    std::vector<double> t(first.size());
    const auto cpu = make_backend("cpu");
    cpu->trace(*cpu->load(r.scene), {.rays = first, .hits = hits, .wide_t = t});
    for (std::size_t i = 0; i < first.size(); ++i) {
        if (hits[i].primitive == no_primitive) continue;
        test::Random random(i);
        const SurfacePoint<float> point =
            surface_point_of(view(r.scene), hits[i].primitive, first[i], NoSource{}, t[i]);
        const Vec3d direction = test::any_unit(random) * std::exp2(random.uniform(-20.0, 20.0));
        const SpawnedRay<float> spawned = spawn_ray(point, narrow(direction));
        r.rays.push_back(spawned.ray);
        r.sources.push_back(spawned.source);
    }
}

const std::vector<SurfaceReference>& surface_references() {
    static const std::vector<SurfaceReference> all = [] {
        std::vector<SurfaceReference> list;
        const auto oracle = make_backend("oracle");
        std::vector<test::HardScene> scenes = test::hard_scenes();
        for (test::HardScene& of_one_kind : test::scenes_of_one_kind()) scenes.push_back(std::move(of_one_kind));
        for (const test::HardScene& parameters : scenes) {
            SurfaceReference r{parameters.name, test::make_scene(parameters, 30), {}, {}, {}, {}, {}};
            spawn_rays(r, parameters.count > 500 ? 5'000 : 60'000);
            const auto scene = oracle->load(r.scene);
            std::vector<double> t(r.rays.size());
            r.hits.resize(r.rays.size());
            oracle->trace(*scene, {.rays = r.rays, .hits = r.hits, .sources = r.sources, .wide_t = t});
            // shadow rays that end next to what they would hit, or anywhere; some run to the primitive that they hit
            for (std::size_t i = 0; i < r.rays.size(); ++i) {
                test::Random random(i);
                const double near = t[i] * (random.coin() ? 1 + 1e-9 : 1 - 1e-9);
                const double end = r.hits[i].primitive != no_primitive && random.coin()
                                       ? near
                                       : static_cast<double>(std::abs(random.log_uniform(-20, 40)));
                r.ends.push_back({end, i % 3 == 0 ? r.hits[i].primitive : no_primitive});
            }
            r.occluded.resize(r.rays.size());
            oracle->trace(*scene, {.rays = r.rays, .hits = r.occluded, .sources = r.sources, .ends = r.ends});
            list.push_back(std::move(r));
        }
        return list;
    }();
    return all;
}

std::string describe(const SurfaceReference& r, std::size_t i) {
    char text[400];
    const Ray<float>& ray = r.rays[i];
    std::snprintf(text, sizeof(text), "scene '%s', ray %zu: origin %a %a %a direction %a %a %a leaves %u %s",
                  r.name.c_str(), i, static_cast<double>(ray.origin.x), static_cast<double>(ray.origin.y),
                  static_cast<double>(ray.origin.z), static_cast<double>(ray.direction.x),
                  static_cast<double>(ray.direction.y), static_cast<double>(ray.direction.z), r.sources[i].primitive,
                  r.sources[i].inside ? "inward" : "outward");
    return text;
}

class SurfaceRays : public test::ExactBackend {
  protected:
    struct Answers {
        std::vector<Hit> hits, occluded;
        std::vector<double> t;
        RenderCounters counters;
    };
    static Answers ask(Backend& backend, const SurfaceReference& r, Tier tier,
                       Coherence coherence = Coherence::unknown) {
        Answers a{
            std::vector<Hit>(r.rays.size()), std::vector<Hit>(r.rays.size()), std::vector<double>(r.rays.size()), {}};
        const auto scene = backend.load(r.scene, tier);
        TraceJob job = {.rays = r.rays, .hits = a.hits, .sources = r.sources, .wide_t = a.t};
        job.coherence = coherence;
        job.counters = &a.counters;
        backend.trace(*scene, job);
        job.hits = a.occluded;
        job.ends = r.ends;
        job.wide_t = {};
        backend.trace(*scene, job);
        return a;
    }
};

TEST_P(SurfaceRays, AgreeWithTheOracle) {
    std::size_t inward = 0, outward = 0, own = 0, stopped = 0;
    for (const SurfaceReference& r : surface_references()) {
        const Answers a = ask(*backend_, r, GetParam().tier);
        EXPECT_EQ(a.counters, RenderCounters{}) << r.name;
        for (std::size_t i = 0; i < r.rays.size(); ++i) {
            ASSERT_EQ(a.hits[i].primitive, r.hits[i].primitive) << describe(r, i);
            ASSERT_NEAR(a.hits[i].t, r.hits[i].t, 2 * 0x1p-23 * static_cast<double>(r.hits[i].t)) << describe(r, i);
            ASSERT_EQ(a.occluded[i].primitive, r.occluded[i].primitive) << describe(r, i) << " until " << r.ends[i].t;
            const bool met_again = a.hits[i].primitive == r.sources[i].primitive;
            ASSERT_TRUE(r.sources[i].inside || !met_again) << describe(r, i);
            ++(r.sources[i].inside ? inward : outward);
            own += met_again ? 1U : 0U;
            stopped += a.occluded[i].primitive == some_primitive ? 1U : 0U;
        }
    }
    EXPECT_GT(inward, 50'000U);
    EXPECT_GT(outward, 50'000U);
    EXPECT_GT(own, 20'000U);
    EXPECT_GT(stopped, 20'000U);
}

TEST_P(SurfaceRays, GiveTheBitsOfTheLeastProcessor) {
    BackendOptions options;
    options.instruction_set = "x86-64-v2";
    const auto least = make_backend("cpu", options);
    for (const SurfaceReference& r : surface_references()) {
        const Answers expected = ask(*least, r, GetParam().tier);
        for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
            const Answers a = ask(*backend_, r, GetParam().tier, coherence);
            for (std::size_t i = 0; i < r.rays.size(); ++i) {
                ASSERT_EQ(bits_of(a.t[i]), bits_of(expected.t[i])) << describe(r, i);
                ASSERT_EQ(a.hits[i].primitive, expected.hits[i].primitive) << describe(r, i);
                ASSERT_EQ(a.occluded[i].primitive, expected.occluded[i].primitive) << describe(r, i);
            }
        }
    }
}

TEST_P(SurfaceRays, CountThoseThatCannotBeTraced) {
    const PreparedScene scene = test::make_scene(test::hard_scenes().front(), 1);
    const std::vector<Ray<float>> rays = {
        {{0, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {0, 0, 1}}, {{std::nanf(""), 0, 0}, {0, 0, 1}}, {{2e18F, 0, 0}, {0, 1, 0}}};
    const std::vector<RayEnd> ends(rays.size(), RayEnd{1e30});
    std::vector<Hit> hits(rays.size());
    RenderCounters counters;
    const auto resident = load(scene);
    backend_->trace(*resident, {.rays = rays, .hits = hits, .counters = &counters});
    EXPECT_EQ(counters.rejected_rays, 3U);
    backend_->trace(*resident, {.rays = rays, .hits = hits, .ends = ends, .counters = &counters});
    EXPECT_EQ(counters.rejected_rays, 6U) << "added up";
    EXPECT_EQ(hits[0].primitive, no_primitive);
    EXPECT_EQ(counters.stack_overflows, 0U);
}

TEST_P(SurfaceRays, RefuseSourcesOfAnotherNumber) {
    const std::vector<Ray<float>> rays(3);
    const std::vector<RaySource> sources(2);
    const std::vector<RayEnd> ends(4);
    std::vector<Hit> hits(3);
    const auto scene = load(test::make_scene(test::hard_scenes().front(), 1));
    EXPECT_THROW(backend_->trace(*scene, {.rays = rays, .hits = hits, .sources = sources}), InputError);
    EXPECT_THROW(backend_->trace(*scene, {.rays = rays, .hits = hits, .ends = ends}), InputError);
}

INSTANTIATE_TEST_SUITE_P(Backends, SurfaceRays, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

TEST(OracleCounters, CountRaysThatCannotBeTraced) {
    const auto oracle = make_backend("oracle");
    const std::vector<Ray<float>> rays = {{{0, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {0, 0, 1}}};
    std::vector<Hit> hits(2);
    RenderCounters counters;
    oracle->trace(*oracle->load(test::make_scene(test::hard_scenes().front(), 1)),
                  {.rays = rays, .hits = hits, .counters = &counters});
    EXPECT_EQ(counters.rejected_rays, 1U);
}

}  // namespace
}  // namespace tandem
