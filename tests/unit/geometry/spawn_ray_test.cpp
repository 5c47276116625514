// Rays from surfaces, in scenes where an offset of the origin shows: false shadows (acne) where it is too small, light
// through what touches (leaks) where it is too large. Here neither may happen at any scale.
#include "tandem/geometry/spawn_ray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/random.h"
#include "tandem/geometry/intersect.h"
#include "tandem/material/reflect.h"
#include "tandem/material/refract.h"
#include "tandem/scene/icosphere.h"
#include "tandem/scene/prepare.h"

namespace tandem {
namespace {

Vec3d unit_vector(test::Random& random) {
    while (true) {
        const Vec3d v = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
        if (dot(v, v) > 0.01 && dot(v, v) < 1) return normalize(v);
    }
}

Vec3d with_cosine(const Vec3d& normal, double cosine, test::Random& random) {
    const Vec3d across = normalize(cross(normal, unit_vector(random)));
    return normal * cosine + across * std::sqrt((1 - cosine) * (1 + cosine));
}

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
    const Ray<float> ray = {{0, 0, 0}, narrow(towards + unit_vector(random) * (spread * random.uniform(0.0, 1.0)))};
    const Closest<float> hit = LoopTracer{scene}.closest(ray, NoSource{}, true);
    if (hit.primitive != 0) return std::nullopt;
    return surface_point(scene, ray, NoSource{}, hit, true);
}

bool is_occluded(const SceneView& scene, const ShadowRay<float>& shadow) {
    return LoopTracer{scene}.occluded(shadow.ray, shadow.t_max, shadow.source, shadow.active);
}

struct Place {
    double radius;
    double distance;  ///< of the centre from the camera, which is at the world's origin
};

class Contact : public testing::TestWithParam<Place> {};

// E1 to E6: a light just above the horizon of a sphere is seen, one just below is not; a ball that touches the surface
// but for 1e-5 of the radius hides the light behind it.
TEST_P(Contact, HasNoAcneAndNoLeaks) {
    const double r = GetParam().radius;
    int points = 0, acne = 0, leaks_below = 0, leaks_behind = 0;
    for (std::uint64_t number = 0; number < 20'000; ++number) {
        test::Random random(number);
        const Vec3d centre = unit_vector(random) * GetParam().distance;
        PreparedScene scene = spheres({{narrow(centre), static_cast<float>(r)}});
        const auto point = seen_point(view(scene), centre, r, random);
        if (!point) continue;
        ++points;
        const Vec3d position = widen(point->position);
        const double cosine = std::pow(10.0, random.uniform(-4.0, 0.0));
        const double light_distance = r * std::pow(10.0, random.uniform(0.5, 4.0));
        const auto light_at = [&](double c) {
            return narrow(position + with_cosine(point->normal, c, random) * light_distance);
        };
        // A light whose own rounding brings it below the horizon is below.
        const ShadowRay<float> above = spawn_shadow_ray(*point, light_at(cosine), no_primitive);
        if (!above.source.inside && is_occluded(view(scene), above)) ++acne;
        const ShadowRay<float> below = spawn_shadow_ray(*point, light_at(-cosine), no_primitive);
        if (below.source.inside && !is_occluded(view(scene), below)) ++leaks_below;

        const double touching = 0.1 * r;
        const Vec3d ball = position + point->normal * (touching + 1e-5 * r);
        scene = spheres({scene.spheres[0], {narrow(ball), static_cast<float>(touching)}});
        const ShadowRay<float> behind = spawn_shadow_ray(*point, light_at(random.uniform(0.9, 1.0)), no_primitive);
        if (!is_occluded(view(scene), behind)) ++leaks_behind;
    }
    EXPECT_GT(points, 5'000);
    EXPECT_EQ(acne, 0) << "of " << points;
    EXPECT_EQ(leaks_below, 0) << "of " << points;
    EXPECT_EQ(leaks_behind, 0) << "of " << points;
}

// In the last two, neighbouring floats are 2e-4 and 8e-3 radii apart.
INSTANTIATE_TEST_SUITE_P(Scales, Contact,
                         testing::Values(Place{1, 3}, Place{1e-3, 1}, Place{1, 1000}, Place{6.4e6, 6.400001e6},
                                         Place{1, 1e3}, Place{1, 1e5}));

// A16: an eyeball. A straight ray passes two concentric spheres, 4e-5 of the radius apart, in four crossings.
TEST(Crossings, OfTwoConcentricSpheresAreFour) {
    // the gap must be wider than the distance of floats there
    for (const Place place : {Place{1, 3}, Place{1e-3, 0.01}, Place{1, 100}, Place{6.4e6, 1e8}}) {
        for (std::uint64_t number = 0; number < 5'000; ++number) {
            test::Random random(number);
            const Vec3f centre = narrow(unit_vector(random) * place.distance);
            const double r = place.radius;
            const PreparedScene scene =
                spheres({{centre, static_cast<float>(r)}, {centre, static_cast<float>(r * (1 + 4e-5))}});
            const Vec3d aim = widen(centre) + unit_vector(random) * (0.99 * r * random.uniform(0.0, 1.0));
            SpawnedRay<float> spawned = {{{0, 0, 0}, narrow(aim)}, {}};
            std::string order;
            while (order.size() < 10) {
                const Closest<float> hit = LoopTracer{view(scene)}.closest(spawned.ray, spawned.source, true);
                if (hit.primitive == no_primitive) break;
                order += hit.primitive == 0 ? 'i' : 'o';
                const auto point = surface_point(view(scene), spawned.ray, spawned.source, hit, true);
                spawned = spawn_ray(point, spawned.ray.direction);
            }
            ASSERT_EQ(order, "oiio") << "r = " << r << " at " << place.distance << ", case " << number;
        }
    }
}

/// A glass body at a distance: enters, is reflected inside a few times, leaves. Returns what was wrong.
std::string walk_through_glass(const PreparedScene& prepared, const Vec3d& towards, double size, std::uint64_t number) {
    test::Random random(number);
    const SceneView scene = view(prepared);
    const Ray<float> ray = {{0, 0, 0}, narrow(towards + unit_vector(random) * (size * random.uniform(0.0, 1.0)))};
    Closest<float> hit = LoopTracer{scene}.closest(ray, NoSource{}, true);
    if (hit.primitive == no_primitive) return {};
    SurfacePoint<float> point = surface_point(scene, ray, NoSource{}, hit, true);
    const auto entering = refract<float>(normalize(widen(ray.direction)), point.normal, 1 / 1.5);
    if (!entering.transmits) return "no way in";
    SpawnedRay<float> spawned = spawn_ray(point, narrow(entering.direction));
    if (!spawned.source.inside) return number % 4 == 0 ? "" : "refracted outward";  // grazing, rounded to float
    for (int bounce = 0; bounce < 4; ++bounce) {
        hit = LoopTracer{scene}.closest(spawned.ray, spawned.source, true);
        if (hit.primitive != 0) return "lost inside";
        if (!(hit.t > 0)) return "t is not positive";
        point = surface_point(scene, spawned.ray, spawned.source, hit, true);
        const Vec3d direction = normalize(widen(spawned.ray.direction));
        if (bounce == 3) {  // out, straight on
            if (dot(direction, point.normal) < 0) return "the far side looks inward";
            spawned = spawn_ray(point, spawned.ray.direction);
            hit = LoopTracer{scene}.closest(spawned.ray, spawned.source, true);
            return hit.primitive == no_primitive ? "" : "hit again from outside";
        }
        spawned = spawn_ray(point, narrow(reflect(direction, point.normal)));
        if (!spawned.source.inside && dot(direction, point.normal) > 1e-6) return "reflected outward";
        if (!spawned.source.inside) return {};
    }
    return {};
}

// E11
TEST(Crossings, OfGlassBodiesAreExact) {
    const Quaternion rotation = {0.3, -0.2, 0.5, 0.7};
    const Vec3d at = {0.3, -0.4, -5};
    const struct {
        const char* name;
        PreparedScene scene;
    } bodies[] = {{"sphere", one_body(SphereShape{1}, {at, {}, {1, 1, 1}})},
                  {"box", one_body(BoxShape{{1, 2, 1.5}}, {at, {}, {1, 1, 1}})},
                  {"ellipsoid", one_body(SphereShape{1}, {at, rotation, {1, 0.2, 0.6}})},
                  {"parallelepiped", one_body(BoxShape{{1, 2, 1.5}}, {at, rotation, {1, 0.2, 0.6}})}};
    for (const auto& body : bodies) {
        for (std::uint64_t number = 0; number < 20'000; ++number) {
            ASSERT_EQ(walk_through_glass(body.scene, at, 1, number), "") << body.name << ", case " << number;
        }
    }
}

/// Faces around (0, 0, -3) times `scale`, moved by `offset`, in world coordinates.
PreparedScene one_mesh(const Mesh& mesh, double scale, const Vec3d& offset) {
    Scene scene;
    scene.materials.emplace_back();
    scene.meshes.push_back(mesh);
    scene.nodes.push_back({.name = "camera", .camera = PerspectiveCamera{}});
    scene.nodes.push_back({.name = "mesh",
                           .trs = {Vec3d{0, 0, -3} * scale + offset, {0.1, 0.2, 0.3, 1}, Vec3d{1, 1, 1} * scale},
                           .geometry = {{MeshShape{0}, 0, {}}}});
    return prepare(scene, {.origin = Vec3d{0, 0, 0}});
}

/// A square of 8 x 8 cells of edge 0.25, of triangles or of quads.
Mesh grid(bool quads) {
    Mesh mesh;
    for (int y = 0; y <= 8; ++y) {
        for (int x = 0; x <= 8; ++x)
            mesh.positions.push_back({0.25F * static_cast<float>(x) - 1, 0.25F * static_cast<float>(y) - 1, 0});
    }
    for (std::uint32_t y = 0; y < 8; ++y) {
        for (std::uint32_t x = 0; x < 8; ++x) {
            const std::uint32_t a = 9 * y + x;
            if (quads) {
                mesh.quads.insert(mesh.quads.end(), {a, a + 1, a + 10, a + 9});
            } else {
                mesh.triangles.insert(mesh.triangles.end(), {a, a + 1, a + 10, a, a + 10, a + 9});
            }
        }
    }
    return mesh;
}

std::vector<Vec3f> corners(const PreparedScene& scene, std::uint32_t id) {
    if (id < scene.triangles.size()) {
        const Triangle& t = scene.triangles[id];
        return {t.v0, t.v1, t.v2};
    }
    const Quad& q = scene.quads[id - scene.triangles.size()];
    return {q.v0, q.v1, q.v2, q.v3};
}

bool share_a_corner(const PreparedScene& scene, std::uint32_t a, std::uint32_t b) {
    const auto of_a = corners(scene, a), of_b = corners(scene, b);
    return std::find_first_of(of_a.begin(), of_a.end(), of_b.begin(), of_b.end()) != of_a.end();
}

/// Rays that leave the faces of a flat or convex mesh outward meet none of its neighbours, and those that leave a
/// closed mesh inward meet another face. Far from the origin rounding makes bumps of a flat mesh, whose far faces a
/// grazing ray meets rightly.
void expect_no_acne(const PreparedScene& scene, const Vec3d& towards, double size, bool closed) {
    int points = 0, acne = 0, lost = 0;
    for (std::uint64_t number = 0; number < 20'000; ++number) {
        test::Random random(number);
        const Vec3f origin = narrow(towards + unit_vector(random) * (3 * size));
        const Vec3d aim = towards + unit_vector(random) * (0.7 * size * random.uniform(0.0, 1.0));
        const Ray<float> ray = {origin, narrow(aim - widen(origin))};
        const Closest<float> hit = LoopTracer{view(scene)}.closest(ray, NoSource{}, true);
        if (hit.primitive == no_primitive) continue;
        const auto point = surface_point(view(scene), ray, NoSource{}, hit, true);
        ++points;
        const double cosine = std::pow(10.0, random.uniform(-6.0, 0.0));
        for (const double side : {1.0, -1.0}) {
            const auto spawned = spawn_ray(point, narrow(with_cosine(point.normal, side * cosine, random)));
            if (spawned.source.inside != (side < 0)) continue;  // grazing, rounded to float
            const std::uint32_t met = LoopTracer{view(scene)}.closest(spawned.ray, spawned.source, true).primitive;
            if (closed && side < 0) {
                lost += met == no_primitive ? 1 : 0;
            } else {
                acne += met != no_primitive && share_a_corner(scene, hit.primitive, met) ? 1 : 0;
            }
        }
    }
    EXPECT_GT(points, 5'000);
    EXPECT_EQ(acne, 0);
    EXPECT_EQ(lost, 0);
}

// E7: the neighbours of a face are other primitives, in its plane or behind it.
TEST(Meshes, HaveNoAcneAndNoLeaks) {
    for (const double scale : {1.0, 1e-3, 1e6}) {
        for (const Vec3d& offset : {Vec3d{0, 0, 0}, Vec3d{1000, 2000, -500} * scale}) {
            const Vec3d at = Vec3d{0, 0, -3} * scale + offset;
            for (const bool quads : {false, true}) {
                SCOPED_TRACE(std::to_string(scale) + (quads ? " quads" : " triangles"));
                expect_no_acne(one_mesh(grid(quads), scale, offset), at, scale, false);
            }
            SCOPED_TRACE(std::to_string(scale) + " icosphere");
            expect_no_acne(one_mesh(icosphere(2), scale, offset), at, scale, true);
        }
    }
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
