// Shadow rays through alpha masks and culled faces: one search against searches for one hit after the other.
#include "tandem/kernel/shadow.h"

#include <gtest/gtest.h>

#include "support/masked_faces.h"
#include "support/structure.h"

namespace tandem {
namespace {

using test::any_faces;
using test::any_shadow_ray;
using test::CutoutEffects;
using test::is_blocked_one_by_one;

template <class Real, class Tracer>
bool is_blocked_in(const Tracer& tracer, const SceneView& scene, const ShadowRay<Real>& shadow) {
    std::uint32_t rays = 0;
    const bool blocked = is_blocked_by_opaque<CutoutEffects>(tracer, scene, shadow, rays);
    EXPECT_EQ(rays, shadow.active ? 1U : 0U);
    return blocked;
}

template <class Real>
void expect_the_same_of_culled_faces(const char* tier) {
    int blocked = 0;
    constexpr std::uint64_t cases = 20000;
    for (std::uint64_t number = 0; number < cases; ++number) {
        test::Random random(number);
        const PreparedScene scene = any_faces(random);
        const SceneView seen = view(scene);
        const ShadowRay<Real> shadow = any_shadow_ray<Real>(scene, random);
        const bool expected = is_blocked_one_by_one(seen, shadow);
        ASSERT_EQ(is_blocked_in(LoopTracer{seen}, seen, shadow), expected) << tier << ", case " << number;
        if (expected) ++blocked;
    }
    EXPECT_GT(blocked, static_cast<int>(cases / 5));
    EXPECT_LT(blocked, static_cast<int>(cases / 5 * 4));
}

TEST(ShadowRays, OfCulledFacesNeedOneSearch) {
    expect_the_same_of_culled_faces<float>("strict");
    expect_the_same_of_culled_faces<double>("precise");
}

// With more faces at one corner than a traversal keeps candidates.
template <class Real>
void expect_the_same_of_masks(const char* tier) {
    int blocked = 0, passes = 0;
    constexpr std::uint64_t cases = 5000;
    for (std::uint64_t number = 0; number < cases; ++number) {
        test::Random random(number);
        PreparedScene scene = any_faces(random, 12);
        test::mask_some(scene, random);
        const test::Structure structure(std::move(scene));
        const SceneView seen = view(structure.scene);
        const ShadowRay<Real> shadow = any_shadow_ray<Real>(structure.scene, random);
        const bool expected = is_blocked_one_by_one(seen, shadow);
        const auto behind_walk = structure.tracer<Decisions::behind_walk>();
        ASSERT_EQ(is_blocked_in(structure.tracer(), seen, shadow), expected) << tier << ", leaves, case " << number;
        ASSERT_EQ(is_blocked_in(behind_walk, seen, shadow), expected) << tier << ", behind the walk, case " << number;
        if (expected) ++blocked;
        if (shadow.active && !expected) {
            const CulledShadowSource<Real> source = {shadow.source};
            passes += LoopTracer{seen}.occluded(shadow.ray, shadow.t_max, source, true) ? 1 : 0;
        }
    }
    EXPECT_GT(blocked, static_cast<int>(cases / 4));
    EXPECT_GT(passes, static_cast<int>(cases / 10)) << "through masks";
}

TEST(ShadowRays, ThroughMasksNeedOneSearch) {
    expect_the_same_of_masks<float>("strict");
    expect_the_same_of_masks<double>("precise");
}

TEST(ShadowRays, PassALimitedNumberOfMasks) {
    for (const std::uint32_t count : {max_masked_hits - 1, max_masked_hits, max_masked_hits + 1}) {
        PreparedScene scene;
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto z = static_cast<float>(i);
            scene.triangles.push_back({{-1, -1, z}, {3, -1, z}, {-1, 3, z}});
        }
        scene.material_of.assign(count, 1);
        test::add_masked_materials(scene);
        const test::Structure structure(std::move(scene));
        const SceneView seen = view(structure.scene);
        ShadowRay<float> shadow;
        shadow.ray = {{0, 0, -1}, {0, 0, 1e4F}};
        shadow.active = true;
        const bool expected = count >= max_masked_hits;
        EXPECT_EQ(is_blocked_one_by_one(seen, shadow), expected) << count;
        EXPECT_EQ(is_blocked_in(structure.tracer(), seen, shadow), expected) << count;
        EXPECT_EQ(is_blocked_in(structure.tracer<Decisions::behind_walk>(), seen, shadow), expected) << count;
    }
}

}  // namespace
}  // namespace tandem
