// Shadow rays through alpha masks and culled faces: the search for any hit against the search for one after the other.
#include "tandem/kernel/shadow.h"

#include <gtest/gtest.h>

#include "support/aim.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/traversal/intersect.h"

namespace tandem {
namespace {

using test::any_point;

using CutoutEffects = EffectSet<(Effect::shadows | Effect::cutouts).bits()>;

/// A few faces with any sides, some of them with a common corner or edge, and a ball.
PreparedScene any_faces(test::Random& random) {
    PreparedScene scene;
    scene.spheres.push_back({any_point(random), 0.1F});
    const Vec3f corner = any_point(random), other = any_point(random);
    for (int i = 0; i < 4; ++i) {
        const Vec3f b = random.coin() ? other : any_point(random);
        scene.triangles.push_back({corner, b, any_point(random)});
        scene.triangles.back().attributes.sides = random.coin() ? FaceSides::culled : FaceSides::single_sided;
        scene.quads.push_back({any_point(random), b, any_point(random), any_point(random)});
        scene.quads.back().attributes.sides = random.coin() ? FaceSides::culled : FaceSides::double_sided;
    }
    scene.material_of.assign(9, 0);
    scene.materials.emplace_back();
    scene.cutout_kinds = PrimitiveKinds::faces;
    return scene;
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
        const std::uint32_t count = primitive_count(without_masks);

        const Vec3f from = any_point(random);
        const Vec3f target = random.coin() ? scene.triangles[random.below(4)].v0 : any_point(random);
        ShadowRay<Real> shadow;
        shadow.ray = {Vec3<Real>(from), Vec3<Real>((target - from) * random.uniform(0.5F, 2.0F))};
        shadow.source.primitive = random.coin() ? random.below(count) : no_primitive;
        shadow.source.light = random.coin() ? random.below(count) : no_primitive;
        shadow.active = is_traceable(shadow.ray);
        IncidentLight<Real> light{};
        light.primitive = shadow.source.light;

        std::uint32_t rays = 0;
        const auto is_blocked_in = [&](const SceneView& by) {
            return is_blocked_by_opaque<CutoutEffects>(LoopTracer{by}, by, light, shadow, rays);
        };
        const bool any = is_blocked_in(without_masks);
        EXPECT_EQ(rays, 1U);
        ASSERT_EQ(any, is_blocked_in(with_masks)) << tier << ", case " << number;
        if (any) ++blocked;
    }
    EXPECT_GT(blocked, static_cast<int>(cases / 5));
    EXPECT_LT(blocked, static_cast<int>(cases / 5 * 4));
}

TEST(ShadowRays, OfCulledFacesNeedOneSearch) {
    expect_the_same_from_both_searches<float>("strict");
    expect_the_same_from_both_searches<double>("precise");
}

}  // namespace
}  // namespace tandem
