// Rays from surfaces: sides, ends, points. What happens where an offset of the origin would show, acne and leaks, is
// group E of the corpus (tests/hard/corpus).
#include "tandem/kernel/spawn_ray.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/aim.h"
#include "support/random.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/traversal/intersect.h"

namespace tandem {
namespace {

PreparedScene spheres(std::vector<Sphere> list) {
    PreparedScene scene;
    scene.spheres = std::move(list);
    scene.material_of.assign(scene.spheres.size(), 0);
    scene.materials.emplace_back();
    return scene;
}

/// One node with `shape` under `trs`, in world coordinates.
PreparedScene one_body(const Shape& shape, const Trs& trs) {
    Scene scene;
    scene.materials.emplace_back();
    scene.nodes.push_back({.name = "camera", .camera = PerspectiveCamera{}});
    scene.nodes.push_back({.name = "body", .trs = trs, .geometry = {{shape, 0, {}}}});
    return prepare(scene, {.origin = Vec3d{0, 0, 0}});
}

/// A point where a ray from the origin hits primitive 0, which lies around `towards`; nothing if it misses.
std::optional<SurfacePoint<float>> seen_point(const SceneView& scene, const Vec3d& towards, double spread,
                                              test::Random& random) {
    const Ray<float> ray = {{0, 0, 0}, narrow(towards + test::any_unit(random) * (spread * random.uniform(0.0, 1.0)))};
    const Closest<float> hit = LoopTracer{scene}.closest(ray, NoSource{}, true);
    if (hit.primitive != 0) return std::nullopt;
    return surface_point(scene, ray, NoSource{}, hit, true);
}

bool is_occluded(const SceneView& scene, const ShadowRay<float>& shadow) {
    return LoopTracer{scene}.occluded(shadow.ray, shadow.t_max, shadow.source, shadow.active);
}

// E9
TEST(ShadowRays, ToALightAtTheVeryPointAreInactive) {
    const PreparedScene scene = spheres({{{0, 0, -5}, 1}});
    test::Random random(1);
    const auto point = seen_point(view(scene), {0, 0, -5}, 0, random);
    ASSERT_TRUE(point);
    EXPECT_FALSE(spawn_shadow_ray(*point, point->position, no_primitive).active);
}

TEST(ShadowRays, ReachLightsInsideASphereOnlyFromInside) {
    const PreparedScene scene = spheres({{{0, 0, -5}, 1}});
    test::Random random(1);
    const auto outside = seen_point(view(scene), {0, 0, -5}, 0, random);
    ASSERT_TRUE(outside);
    // The point does not know from which side it is seen: the segment to the centre does not leave the ball.
    EXPECT_FALSE(is_occluded(view(scene), spawn_shadow_ray(*outside, {0, 0, -5}, no_primitive)));
    EXPECT_TRUE(is_occluded(view(scene), spawn_shadow_ray(*outside, {0, 0, -7}, no_primitive)));
}

// E10, D8: very near and very far lights; a surface exactly at the light does not stop the ray, one before it does.
TEST(ShadowRays, CompareWithTheLightExactly) {
    for (const float distance : {1e-8F, 1.0F, 1e8F}) {
        const PreparedScene scene = spheres({{{0, 0, -5}, 1}, {{0, 0, 2 * distance}, distance}});
        const Ray<float> ray = {{0, 0, 0}, {0, 0, distance}};
        const ShadowSource<float> nothing;
        const LoopTracer tracer = {view(scene)};
        EXPECT_FALSE(tracer.occluded(ray, 1.0, nothing, true)) << distance;
        EXPECT_TRUE(tracer.occluded(ray, 1 + 0x1p-52, nothing, true)) << distance;
        EXPECT_FALSE(tracer.occluded(ray, 1 - 0x1p-53, nothing, true)) << distance;
        ShadowSource<float> to_light;
        to_light.light = 1;
        EXPECT_FALSE(tracer.occluded(ray, 10.0, to_light, true)) << distance;
    }
}

TEST(SurfacePoints, LieOnTheirSurfaces) {
    // E4: seen from 1000 radii, t alone leaves the point 1e-4 beside the surface
    const PreparedScene ball = spheres({{{600, 0, -800}, 1}});
    const PreparedScene box = one_body(BoxShape{{0.3, 0.7, 1.1}}, {{600, 0, -800}, {}, {1, 1, 1}});
    int on_face = 0;
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        test::Random random(number);
        if (const auto point = seen_point(view(ball), {600, 0, -800}, 1, random)) {
            const Vec3d offset = widen(point->position) - Vec3d{600, 0, -800};
            ASSERT_NEAR(std::sqrt(dot(offset, offset)), 1, 5e-5) << "the spacing of floats there is 6e-5";
            ASSERT_NEAR(dot(point->normal, point->normal), 1, 1e-15);
        }
        if (const auto point = seen_point(view(box), {600, 0, -800}, 0.4, random)) {
            const Box& b = box.boxes[0];
            for (int i = 0; i < 3; ++i) {
                ASSERT_LE(b.lower[i], point->position[i]);
                ASSERT_GE(b.upper[i], point->position[i]);
                if (point->normal[i] != 0) {
                    ASSERT_EQ(point->position[i], point->normal[i] > 0 ? b.upper[i] : b.lower[i]);
                    ++on_face;
                }
            }
        }
    }
    EXPECT_GT(on_face, 1'000);
}

// F7: the side follows from the sign in double, however small; the tangent plane counts as outside.
TEST(SpawnedRays, TakeTheSideFromTheSign) {
    const SurfacePoint<float> point = {{0, 0, 0}, {0, 0, 1}, 5};
    EXPECT_TRUE(spawn_ray(point, {1, 0, -1e-9F}).source.inside);
    EXPECT_FALSE(spawn_ray(point, {1, 0, 1e-9F}).source.inside);
    EXPECT_FALSE(spawn_ray(point, {1, 0, 0}).source.inside);
    EXPECT_FALSE(spawn_ray(point, {1, 0, -0.0F}).source.inside);
    EXPECT_TRUE(spawn_ray(point, {1, 0, -1e-45F}).source.inside);
    EXPECT_EQ(spawn_ray(point, {1, 0, 1}).source.primitive, 5U);
}

}  // namespace
}  // namespace tandem
