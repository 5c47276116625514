// A scene that is large enough for groups (cpu/group_hierarchy.h): rays one by one and in packets have the same bits.

#include <gtest/gtest.h>

#include "support/backend_list.h"
#include "support/hard_scenes.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/spawn_ray.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

/// Nearly only spheres, since groups do not pay otherwise, but some of all kinds.
PreparedScene many_spheres() {
    PreparedScene scene = prepare(named_scene("mixed/1200"));
    scene.spheres = prepare(named_scene("spheres/24000")).spheres;
    scene.triangles = prepare(named_scene("triangles/600")).triangles;
    scene.quads = prepare(named_scene("quads/600")).quads;
    scene.material_of.assign(primitive_count(view(scene)), 0);
    return scene;
}

class LargeScene : public test::ExactBackend {
  protected:
    struct Answers {
        std::vector<Hit> hits;
        std::vector<double> wide_t;
    };
    Answers ask(TraceJob job, Coherence coherence) {
        Answers answers{std::vector<Hit>(job.rays.size()), std::vector<double>(job.rays.size())};
        job.hits = answers.hits;
        job.wide_t = answers.wide_t;
        job.coherence = coherence;
        backend_->trace(*resident_, job);
        return answers;
    }
    /// Returns the nearest hits, or which shadow rays are blocked.
    Answers expect_same(const TraceJob& job, const char* what) {
        // rays that a backend takes for coherent do not go through groups
        Answers expected = ask(job, Coherence::coherent);
        for (const Coherence coherence : {Coherence::incoherent, Coherence::unknown, Coherence::coherent}) {
            const Answers found = ask(job, coherence);
            for (std::size_t i = 0; i < job.rays.size(); ++i) {
                EXPECT_EQ(found.hits[i].primitive, expected.hits[i].primitive) << what << " " << i;
                EXPECT_EQ(bits_of(found.wide_t[i]), bits_of(expected.wide_t[i])) << what << " " << i;
                if (HasFailure()) return expected;
            }
        }
        return expected;
    }

    /// At least `least_hits` of the rays hit.
    void expect_same_bits(PreparedScene scene, double least_hits = 0.25) {
        scene_ = std::move(scene);
        resident_ = load(scene_);
        expect_same_bits_onwards(test::make_rays(scene_, 20'000, 80), least_hits);
    }

  private:
    void expect_same_bits_onwards(const std::vector<Ray<float>>& rays, double least_hits);

    PreparedScene scene_;
    std::shared_ptr<ResidentScene> resident_;
};

void LargeScene::expect_same_bits_onwards(const std::vector<Ray<float>>& rays, double least_hits) {
    const Answers first = expect_same({.rays = rays, .hits = {}}, "ray");
    std::vector<Ray<float>> onwards;
    std::vector<RaySource> sources;
    std::vector<RayEnd> ends;
    std::size_t hits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (first.hits[i].primitive == no_primitive) continue;
        ++hits;
        const SurfacePoint<float> point =
            surface_point_of(view(scene_), first.hits[i].primitive, rays[i], NoSource{}, first.wide_t[i]);
        const Vec3f& d = rays[i].direction;
        const SpawnedRay<float> spawned = spawn_ray(point, i % 2 == 0 ? Vec3f{d.y, -d.x, d.z} : d);
        onwards.push_back(spawned.ray);
        sources.push_back(spawned.source);
    }
    EXPECT_GT(static_cast<double>(hits), least_hits * static_cast<double>(rays.size()));
    const Answers second = expect_same({.rays = onwards, .hits = {}, .sources = sources}, "onwards");
    for (std::size_t i = 0; i < onwards.size(); ++i) {
        const bool is_hit = second.hits[i].primitive != no_primitive;
        const double t = is_hit ? second.wide_t[i] : 1.0;
        ends.push_back({i % 3 == 0 ? t : t * (i % 3 == 1 ? 1 + 1e-15 : 2.0),
                        is_hit && i % 4 == 0 ? second.hits[i].primitive : no_primitive});
    }
    (void)expect_same({.rays = onwards, .hits = {}, .sources = sources, .ends = ends}, "shadow");
}

TEST_P(LargeScene, OfSpheresHasTheSameBitsForSingleRaysAndPackets) { expect_same_bits(many_spheres()); }

TEST_P(LargeScene, OfAMeshHasTheSameBitsForSingleRaysAndPackets) {
    expect_same_bits(prepare(named_scene("icosphere/6")));
}

TEST_P(LargeScene, OfHairHasTheSameBitsForSingleRaysAndPackets) {
    expect_same_bits(prepare(named_scene("hair/20000")), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Backends, LargeScene, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

}  // namespace
}  // namespace tandem
