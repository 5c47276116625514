// Shadow rays through alpha masks and culled faces: searches for any hit against a search for one after the other.
#include "tandem/kernel/shadow.h"

#include <gtest/gtest.h>

#include <array>

#include "support/aim.h"
#include "support/structure.h"
#include "tandem/kernel/traversal/intersect.h"

namespace tandem {
namespace {

using test::any_point;

using CutoutEffects = EffectSet<(Effect::shadows | Effect::cutouts).bits()>;

/// A few faces with any sides, some of them with a common corner or edge, and a ball. All
/// triangles have the same v0.
PreparedScene any_faces(test::Random& random, int count = 4) {
    PreparedScene scene;
    scene.spheres.push_back({any_point(random), 0.1F});
    const Vec3f corner = any_point(random), other = any_point(random);
    for (int i = 0; i < count; ++i) {
        const Vec3f b = random.coin() ? other : any_point(random);
        scene.triangles.push_back({corner, b, any_point(random)});
        scene.triangles.back().attributes.sides = random.coin() ? FaceSides::culled : FaceSides::single_sided;
        scene.quads.push_back({any_point(random), b, any_point(random), any_point(random)});
        scene.quads.back().attributes.sides = random.coin() ? FaceSides::culled : FaceSides::double_sided;
    }
    scene.material_of.assign(scene.spheres.size() + scene.triangles.size() + scene.quads.size(), 0);
    scene.materials.emplace_back();
    scene.cutout_kinds = PrimitiveKinds::faces;
    return scene;
}

/// A shadow ray among the primitives of any_faces(), often through the common corner.
template <class Real>
ShadowRay<Real> any_shadow_ray(const PreparedScene& scene, test::Random& random) {
    const auto count = static_cast<std::uint32_t>(scene.material_of.size());
    const Vec3f from = any_point(random);
    const Vec3f target = random.coin() ? scene.triangles[0].v0 : any_point(random);
    ShadowRay<Real> shadow;
    shadow.ray = {Vec3<Real>(from), Vec3<Real>((target - from) * random.uniform(0.5F, 2.0F))};
    shadow.source.primitive = random.coin() ? random.below(count) : no_primitive;
    shadow.source.light = random.coin() ? random.below(count) : no_primitive;
    shadow.active = is_traceable(shadow.ray);
    return shadow;
}

template <class Real, class Tracer>
bool is_blocked_in(const Tracer& tracer, const SceneView& scene, const ShadowRay<Real>& shadow) {
    IncidentLight<Real> light{};
    light.primitive = shadow.source.light;
    std::uint32_t rays = 0;
    const bool blocked = is_blocked_by_opaque<CutoutEffects>(tracer, scene, light, shadow, rays);
    EXPECT_EQ(rays, shadow.active ? 1U : 0U);
    return blocked;
}

template <class Real>
void expect_the_same_from_both_searches(const char* tier) {
    int blocked = 0;
    constexpr std::uint64_t cases = 20000;
    for (std::uint64_t number = 0; number < cases; ++number) {
        test::Random random(number);
        const PreparedScene scene = any_faces(random);
        SceneView without_masks = view(scene);
        SceneView with_masks = without_masks;  // which its materials do not have, so that every hit is opaque
        with_masks.masked_kinds = PrimitiveKinds::faces;
        const ShadowRay<Real> shadow = any_shadow_ray<Real>(scene, random);
        const bool any = is_blocked_in(LoopTracer{without_masks}, without_masks, shadow);
        ASSERT_EQ(any, is_blocked_in(LoopTracer{with_masks}, with_masks, shadow)) << tier << ", case " << number;
        if (any) ++blocked;
    }
    EXPECT_GT(blocked, static_cast<int>(cases / 5));
    EXPECT_LT(blocked, static_cast<int>(cases / 5 * 4));
}

TEST(ShadowRays, OfCulledFacesNeedOneSearch) {
    expect_the_same_from_both_searches<float>("strict");
    expect_the_same_from_both_searches<double>("precise");
}

/// Materials without a mask (0), with one that is open everywhere (1), and with one that is opaque (2).
void add_masked_materials(PreparedScene& scene) {
    scene.materials.resize(3);
    scene.optics.resize(3);
    scene.textures.materials.resize(3);
    scene.textures.materials[1].alpha = 0.1F;
    for (std::size_t i = 1; i < 3; ++i) scene.textures.materials[i].alpha_cutoff = 0.5F;
    scene.masked_kinds = scene.cutout_kinds = PrimitiveKinds::all;
}
void mask_some(PreparedScene& scene, test::Random& random) {
    add_masked_materials(scene);
    for (std::uint32_t& material : scene.material_of) material = std::array{0U, 0U, 1U, 1U, 1U, 2U}[random.below(6)];
}

// With more faces at one corner than a traversal keeps candidates.
template <class Real>
void expect_the_same_from_hierarchies(const char* tier) {
    int blocked = 0, passes = 0;
    constexpr std::uint64_t cases = 5000;
    for (std::uint64_t number = 0; number < cases; ++number) {
        test::Random random(number);
        PreparedScene scene = any_faces(random, 12);
        mask_some(scene, random);
        const test::Structure structure(std::move(scene));
        const SceneView seen = view(structure.scene);
        const ShadowRay<Real> shadow = any_shadow_ray<Real>(structure.scene, random);
        const bool expected = is_blocked_in(LoopTracer{seen}, seen, shadow);
        const auto in_leaves = structure.tracer();
        const auto behind_walk = structure.tracer<Decisions::behind_walk>();
        ASSERT_EQ(is_blocked_in(in_leaves, seen, shadow), expected) << tier << ", in leaves, case " << number;
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

TEST(ShadowRays, ThroughMasksAreThoseOfTheLoopInHierarchies) {
    expect_the_same_from_hierarchies<float>("strict");
    expect_the_same_from_hierarchies<double>("precise");
}

TEST(ShadowRays, PassALimitedNumberOfMasks) {
    for (const std::uint32_t count : {max_masked_hits - 1, max_masked_hits, max_masked_hits + 1}) {
        PreparedScene scene;
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto z = static_cast<float>(i);
            scene.triangles.push_back({{-1, -1, z}, {3, -1, z}, {-1, 3, z}});
        }
        scene.material_of.assign(count, 1);
        add_masked_materials(scene);
        const test::Structure structure(std::move(scene));
        const SceneView seen = view(structure.scene);
        ShadowRay<float> shadow;
        shadow.ray = {{0, 0, -1}, {0, 0, 1e4F}};
        shadow.active = true;
        const bool expected = count >= max_masked_hits;
        EXPECT_EQ(is_blocked_in(LoopTracer{seen}, seen, shadow), expected) << count;
        EXPECT_EQ(is_blocked_in(structure.tracer(), seen, shadow), expected) << count;
        EXPECT_EQ(is_blocked_in(structure.tracer<Decisions::behind_walk>(), seen, shadow), expected) << count;
    }
}

}  // namespace
}  // namespace tandem
