// The rule for the origin of render space, on scenes whose nearest point is known.
#include "tandem/compile/render_origin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/random.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {
namespace {

TEST(RenderOrigin, StaysForScenesAroundTheWorldsOrigin) {
    RenderOrigin origin({0, 0, 3});
    origin.add_sphere({0, 0, 0}, 1);
    EXPECT_EQ(origin.get(), Vec3d(0, 0, 0));
}

TEST(RenderOrigin, StaysForATelescope) {
    RenderOrigin origin({0, 0, 1e6});
    origin.add_sphere({0, 0, 0}, 1);
    EXPECT_EQ(origin.get(), Vec3d(0, 0, 0)) << "what is seen is here, though the camera is far";
}

TEST(RenderOrigin, GoesToWhatTheCameraIsNearTo) {
    // on a planet about the world's origin, with a small ball 2 m away
    constexpr double radius = 6.4e6;
    RenderOrigin origin({0, radius + 1.75, 0});
    origin.add_sphere({0, 0, 0}, radius);
    origin.add_sphere({0, radius + 0.2, -2}, 0.2);
    const Vec3d at = origin.get();
    EXPECT_NEAR(at.y, radius, 32);
    EXPECT_EQ(at.x, 0);
    EXPECT_EQ(std::fmod(at.y, 16), 0) << "a multiple of the grid's step";
}

TEST(RenderOrigin, IsOnASurfaceAlsoFromWithin) {
    RenderOrigin room({1e6 + 1, 0, 0});  // a wall 1 m away
    room.add_box({1e6 - 100, -50, -50}, {1e6 + 2, 50, 50});
    EXPECT_NEAR(room.get().x, 1e6 + 2, 16);
    RenderOrigin dome({1e6, 0, 0});
    dome.add_sphere({1e6, 0, 0}, 1e7);
    EXPECT_LE(std::abs(dome.get().x), 1.7e8);
    RenderOrigin turned({1e6 + 0.5, 0, 0});
    const Transform world_from_unit = compose({1e6, 0, 0}, {0, 0, 0.3, 1}, {1, 2, 3});
    turned.add_placed(world_from_unit, inverse(world_from_unit.linear), true);
    EXPECT_NEAR(turned.get().x, 1e6, 16);
    turned.add_placed(world_from_unit, inverse(world_from_unit.linear), false);
    EXPECT_NEAR(turned.get().x, 1e6, 16);
}

TEST(RenderOrigin, IsTheSameFromParts) {
    const Vec3d camera = {1e5, 0, 0};
    for (std::uint64_t number = 0; number < 200; ++number) {
        test::Random random(number);
        RenderOrigin whole(camera);
        std::vector<RenderOrigin> parts(5, RenderOrigin(camera));
        for (std::size_t i = 0; i < 40; ++i) {
            // several at equal distances, of which the first counts
            const Vec3d centre = camera + Vec3d{random.coin() ? 7.0 : -7.0, 0, double(random.below(3))};
            whole.add_sphere(centre, 1);
            parts[i / 8].add_sphere(centre, 1);
        }
        whole.add_point({2e6, 0, 0});
        parts[4].add_point({2e6, 0, 0});
        RenderOrigin sum(camera);
        for (const RenderOrigin& part : parts) sum.add(part);
        EXPECT_EQ(sum.get(), whole.get()) << number;
    }
}

TEST(RenderOrigin, IsTheNearestPointOfATriangle) {
    const Vec3d a = {1e6, 0, 0}, b = {1e6 + 300, 0, 0}, c = {1e6, 300, 0};
    const auto nearest = [&](const Vec3d& camera) {
        RenderOrigin origin(camera);
        origin.add_triangle(a, b, c);
        return origin.get();
    };
    EXPECT_NEAR(nearest({1e6 + 100, 100, 1}).x, 1e6 + 100, 8) << "below the camera";
    EXPECT_NEAR(nearest({1e6 + 100, 100, 1}).z, 0, 8);
    EXPECT_NEAR(nearest({1e6 + 100, -1, 0}).x, 1e6 + 100, 8) << "on an edge";
    EXPECT_NEAR(nearest({1e6 + 301, 0, 0}).x, 1e6 + 300, 8) << "a corner";
}

// The promise: no surface point's coordinate is over 16 times its distance from the camera.
TEST(RenderOrigin, KeepsCoordinatesWithin16TimesTheDistance) {
    for (std::uint64_t number = 0; number < 20'000; ++number) {
        test::Random random(number);
        const auto point = [&](double size) {
            return Vec3d{random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
        };
        const Vec3d middle = point(std::exp2(random.uniform(-10.0, 40.0)));
        const Vec3d camera = middle + point(std::exp2(random.uniform(-10.0, 20.0)));
        RenderOrigin chosen(camera);
        std::vector<std::pair<Vec3d, double>> spheres;
        for (int i = 0; i < 5; ++i) {
            spheres.emplace_back(middle + point(10), random.uniform(0.01, 2.0));
            chosen.add_sphere(spheres.back().first, spheres.back().second);
        }
        const Vec3d origin = chosen.get();
        for (const auto& [centre, radius] : spheres) {
            const Vec3d towards = normalize(point(1));
            const Vec3d on = centre + towards * radius;
            const Vec3d local = on - origin;
            const Vec3d seen = on - camera;
            const double largest = std::max({std::abs(local.x), std::abs(local.y), std::abs(local.z)});
            ASSERT_LE(largest, 16 * std::sqrt(dot(seen, seen)) * (1 + 1e-9) + 1e-6) << "case " << number;
        }
    }
}

TEST(RenderOrigin, ScalesWithTheScene) {
    for (const int exponent : {-40, 40}) {
        const double s = std::ldexp(1.0, exponent);
        RenderOrigin plain({100, 7, 3}), scaled({100 * s, 7 * s, 3 * s});
        plain.add_sphere({101.3, 7, 3}, 0.7);
        scaled.add_sphere({101.3 * s, 7 * s, 3 * s}, 0.7 * s);
        EXPECT_EQ(plain.get() * s, scaled.get());
        EXPECT_NE(plain.get(), Vec3d(0, 0, 0));
    }
}

TEST(RenderOrigin, StaysWithoutSurfacesAndAtTheLimitOfCoordinates) {
    RenderOrigin nothing({5, 5, 5});
    nothing.add_point({1, 2, 3});
    EXPECT_EQ(nothing.get(), Vec3d(0, 0, 0));
    RenderOrigin far({9e17, 0, 0});
    far.add_sphere({9e17, 0, 1}, 0.5);
    far.add_sphere({-9e17, 0, 0}, 1);
    EXPECT_EQ(far.get(), Vec3d(0, 0, 0)) << "the other sphere would be 1.8e18 away";
    RenderOrigin touching({1000.3, 0, 0});
    touching.add_sphere({1000.3, 0, 1}, 1);
    EXPECT_EQ(touching.get(), Vec3d(1000.3, 0, 0)) << "no grid is fine enough for a camera on a surface";
}

TEST(Prepare, PutsEverythingIntoRenderSpace) {
    Scene scene;
    scene.materials.emplace_back();
    const Vec3d at = {1e6, -2e6, 5e5};
    scene.nodes.push_back({.name = "camera", .trs = {at, {}, {1, 1, 1}}, .camera = PerspectiveCamera{}});
    scene.nodes.push_back(
        {.name = "ball", .trs = {at + Vec3d{0, 0, -3}, {}, {1, 1, 1}}, .geometry = {{SphereShape{1}, 0, {}}}});
    scene.nodes.push_back({.name = "light", .trs = {at + Vec3d{1, 2, 3}, {}, {1, 1, 1}}, .light = LightSource{}});
    const PreparedScene prepared = prepare(scene);
    const auto in_world = [&](const Vec3f& p) { return world_from_render(prepared, widen(p)); };
    EXPECT_EQ(in_world(prepared.spheres[0].centre), at + Vec3d(0, 0, -3));
    EXPECT_EQ(in_world(prepared.lights[0].position), at + Vec3d(1, 2, 3));
    EXPECT_EQ(world_from_render(prepared, prepared.camera.render_from_camera.translation), at);
    EXPECT_LE(std::abs(prepared.spheres[0].centre.x), 32);
    const PreparedScene fixed = prepare(scene, {.origin = Vec3d{1, 2, 3}});
    EXPECT_EQ(fixed.origin, Vec3d(1, 2, 3));
    EXPECT_EQ(widen(fixed.lights[0].position), widen(narrow(at + Vec3d{1, 2, 3} - Vec3d{1, 2, 3})));
}

}  // namespace
}  // namespace tandem
