// The tier fast: near the exact tiers where float suffices, and never NaN where it does not.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/backend_list.h"
#include "support/random.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/compare.h"
#include "tandem/kernel/spawn_ray.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

std::vector<test::Renderer> fast_renderers() {
    std::vector<test::Renderer> list;
    for (test::Renderer renderer : test::exact_renderers()) {
        if (renderer.tier != Tier::strict) continue;
        renderer.tier = Tier::fast;
        if (renderer.backend == "cuda") renderer.options.specialise = test::without_waiting(Tier::fast);
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

/// Spheres, triangles and quads among each other, so many that a structure is asked.
PreparedScene all_sorts() {
    PreparedScene scene = prepare(named_scene("quads/1000"), {.origin = Vec3d{0, 0, 0}});
    scene.triangles = prepare(named_scene("triangles/1000"), {.origin = Vec3d{0, 0, 0}}).triangles;
    scene.spheres = prepare(named_scene("spheres/40"), {.origin = Vec3d{0, 0, 0}}).spheres;
    for (Triangle& triangle : scene.triangles) triangle.attributes = {};
    scene.material_of.assign(scene.spheres.size() + scene.triangles.size() + scene.quads.size(), 0);
    return scene;
}

/// Every 16 rays leave one point of a surface: into one octant, which makes a packet of them, or anywhere.
struct LeavingRays {
    std::vector<Ray<float>> rays;
    std::vector<RaySource> sources;
    std::vector<RayEnd> ends;
    std::vector<Hit> hits, occluded;

    LeavingRays(Backend& backend, const PreparedScene& scene) {
        const auto resident = backend.load(scene, Tier::strict);
        test::Random random(7);
        const auto any_vector = [&](float least) {
            return Vec3f{random.uniform(least, 1.0F), random.uniform(least, 1.0F), random.uniform(least, 1.0F)};
        };
        std::vector<Ray<float>> first(3000);
        for (Ray<float>& ray : first) ray = {any_vector(-1), any_vector(-1)};
        std::vector<Hit> first_hits(first.size());
        std::vector<double> t(first.size());
        backend.trace(*resident, {.rays = first, .hits = first_hits, .wide_t = t});
        for (std::size_t i = 0; i < first.size(); ++i) {
            if (first_hits[i].primitive == no_primitive) continue;
            const auto point = surface_point_of(view(scene), first_hits[i].primitive, first[i], NoSource{}, t[i]);
            for (int k = 0; k < 16; ++k) {
                // a sphere has two sides: a packet is of one origin, so its rays all leave it to one of them
                const SpawnedRay<float> spawned = spawn_ray(point, any_vector(i % 2 == 0 ? 0.01F : -1.0F));
                rays.push_back(spawned.ray);
                sources.push_back(spawned.source);
            }
        }
        hits.resize(rays.size());
        t.resize(rays.size());
        backend.trace(*resident, {.rays = rays, .hits = hits, .sources = sources, .wide_t = t});
        for (std::size_t i = 0; i < rays.size(); ++i) {
            // to the light that they hit, just before a hit, or beyond it
            const double end = i % 3 == 0 ? t[i] * 1.01 : t[i] * (i % 3 == 1 ? 0.99 : 1.01);
            ends.push_back(
                {hits[i].primitive == no_primitive ? 1e30 : end, i % 3 == 0 ? hits[i].primitive : no_primitive});
        }
        occluded.resize(rays.size());
        backend.trace(*resident, {.rays = rays, .hits = occluded, .sources = sources, .ends = ends});
    }
};

TEST_P(Fast, DecidesAsStrictOnRaysThatLeaveSurfaces) {
    const PreparedScene scene = all_sorts();
    const LeavingRays strict(*backend_, scene);
    const std::size_t count = strict.rays.size();
    ASSERT_GT(count, 10'000U);
    const auto resident = backend_->load(scene, Tier::fast);
    std::vector<Hit> hits(count), occluded(count);
    backend_->trace(*resident, {.rays = strict.rays, .hits = hits, .sources = strict.sources});
    backend_->trace(*resident, {.rays = strict.rays, .hits = occluded, .sources = strict.sources, .ends = strict.ends});
    std::size_t other_primitive = 0, other_answer = 0, far_t = 0, faces = 0, stopped = 0;
    const auto first_face = static_cast<std::uint32_t>(scene.spheres.size());
    for (std::size_t i = 0; i < count; ++i) {
        const bool leaves_face = strict.sources[i].primitive >= first_face;
        EXPECT_FALSE(leaves_face && hits[i].primitive == strict.sources[i].primitive) << "ray " << i;
        faces += leaves_face;
        stopped += strict.occluded[i].primitive != no_primitive;
        other_primitive += hits[i].primitive != strict.hits[i].primitive;
        other_answer += occluded[i].primitive != strict.occluded[i].primitive;
        const float t = strict.hits[i].t;
        far_t += hits[i].primitive == strict.hits[i].primitive && !(std::abs(hits[i].t - t) <= 1e-3F * t);
    }
    EXPECT_GT(faces, count / 3);
    EXPECT_GT(stopped, count / 10);
    EXPECT_LE(other_primitive, count / 1000);
    EXPECT_LE(other_answer, count / 1000);
    EXPECT_LE(far_t, count / 200);  // of grazing rays, and of hits next to where they start
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
