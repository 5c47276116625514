// Ellipsoids and parallelepipeds against exact arithmetic on the same placement and ray. Taking the ray to object space
// rounds, so a body and its exact copy differ by about 2^-50 of their distance: rays whose answer changes between
// bodies 2^-30 smaller and 2^-30 larger are left out, and t may lie between those of the two.
#include "tandem/kernel/shapes/affine.h"

#include <gtest/gtest.h>

#include "support/adversarial_rays.h"
#include "support/exact_geometry.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {
namespace {

using test::Big;
using test::BigVector;
using test::Random;

/// A unit ball or cube [-1, 1]^3 under a random rotation, unequal scales up to 1 : 1000 and another rotation.
Placement any_placement(Random& random, bool is_box) {
    const auto turn = [&] {
        return rotation_matrix({random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.3});
    };
    const double size = std::exp2(random.uniform(-10.0, 10.0));
    Matrix3 scale = {{{size, 0, 0}, {0, size * random.uniform(0.1, 0.9), 0}, {0, 0, size * 1e-3}}};
    if (random.coin()) scale.row[2].z = -size * 1.5;
    Scene scene;
    scene.materials.emplace_back();
    Node body;
    body.matrix = Transform{turn() * scale * turn(), test::any_unit(random) * random.uniform(0.0, 1000.0)};
    body.geometry.push_back({is_box ? Shape(BoxShape{{2, 2, 2}}) : Shape(SphereShape{1}), 0, {}});
    Node eye;
    eye.camera = PerspectiveCamera{};
    scene.nodes = {body, eye};
    const PreparedScene prepared = prepare(scene, {.origin = Vec3d{0, 0, 0}});
    if (is_box) return prepared.parallelepipeds.at(0);
    return prepared.ellipsoids.at(0);
}

/// A ray at a point of the body or beside it, from up to 2^10 sizes away or from inside.
Ray<float> any_ray(Random& random, const Placement& placement) {
    const double size = std::sqrt(dot(placement.half_extent, placement.half_extent));
    const Vec3d centre = placement.centre;
    const Vec3d origin =
        random.below(8) == 0 ? centre : centre + test::any_unit(random) * (size * std::exp2(random.uniform(0.0, 10.0)));
    const Vec3d half = placement.half_extent;
    const Vec3d target = centre + Vec3d{half.x * random.uniform(-1.0, 1.0), half.y * random.uniform(-1.0, 1.0),
                                        half.z * random.uniform(-1.0, 1.0)};
    return {narrow(origin), narrow((target - origin) * std::exp2(random.uniform(-20.0, 20.0)))};
}

struct Object {
    BigVector origin, direction;
};
Object to_exact_object(const Placement& placement, const Ray<float>& ray) {
    return {placement.object_from_world * (test::big(ray.origin) - test::big(placement.centre)),
            placement.object_from_world * test::big(ray.direction)};
}

std::optional<Big> exact_hit(const Object& o, bool is_box, double size) {
    if (!is_box) return test::hit_ball(o.origin, o.direction, Big(size));
    const auto hit = test::hit_box(o.origin, o.direction, {-size, -size, -size}, {size, size, size});
    return hit ? std::optional<Big>(hit->t) : std::nullopt;
}

class Affine : public testing::TestWithParam<bool> {};

TEST_P(Affine, DecidesRightAndIsWithinOneUlp) {
    const bool is_box = GetParam();
    int hits = 0, unsure = 0;
    constexpr int count = 30000;
    for (std::uint64_t number = 0; number < count; ++number) {
        Random random(number / 30);
        const Placement placement = any_placement(random, is_box);
        Random ray_random(number + 77);
        const Ray<float> ray = any_ray(ray_random, placement);
        const auto where = [&] {
            return (is_box ? "parallelepiped " : "ellipsoid ") + std::to_string(number) + ": " + test::reproducer(ray);
        };
        double t = 0;
        const bool hit = is_box ? first_hit<float>(cross_parallelepiped(to_object(placement, ray)), t)
                                : first_hit<float>(ellipsoid_roots(placement, ray), t);
        const Object object = to_exact_object(placement, ray);
        const auto smaller = exact_hit(object, is_box, 1 - 0x1p-30);
        const auto larger = exact_hit(object, is_box, 1 + 0x1p-30);
        if (smaller.has_value() != larger.has_value()) {
            ++unsure;
            continue;
        }
        ASSERT_EQ(hit, smaller.has_value()) << where();
        if (!hit) continue;
        ++hits;
        const Big low = *smaller < *larger ? *smaller : *larger;
        const Big high = *smaller < *larger ? *larger : *smaller;
        if (Big(t) < low || Big(t) > high) {
            const double error = std::min(test::error_in_ulps(narrow(t), low), test::error_in_ulps(narrow(t), high));
            ASSERT_LE(error, 1) << where();
        }

        const Vec3d normal =
            is_box ? parallelepiped_normal(placement, record_hit(Parallelepiped{placement}, ray, t, false, true))
                   : ellipsoid_normal(placement, ray, t);
        ASSERT_NEAR(dot(normal, normal), 1, 1e-14) << where();
        // entering looks against the ray, leaving along it; the object-space origin tells which
        const bool inside = is_box ? test::hit_box(object.origin, object.direction, {-1, -1, -1}, {1, 1, 1})
                                             .value_or(test::BoxHit{0, 0, true})
                                             .entering == false
                                   : test::dot(object.origin, object.origin) < 1;
        const double along = dot(normal, widen(ray.direction));
        ASSERT_TRUE(inside ? along >= 0 : along <= 0) << where();
    }
    EXPECT_GT(hits, count / 4);
    EXPECT_LT(unsure, count / 100);
}

// The exact normal of an ellipsoid is the gradient of |M (p - c)|^2 / 2, M^T M (p - c).
TEST(AffineNormal, IsTheGradient) {
    for (std::uint64_t number = 0; number < 3000; ++number) {
        Random random(number);
        const Placement placement = any_placement(random, false);
        const Ray<float> ray = any_ray(random, placement);
        double t = 0;
        if (!first_hit<float>(ellipsoid_roots(placement, ray), t)) continue;
        const Object object = to_exact_object(placement, ray);
        const auto exact = exact_hit(object, false, 1);
        if (!exact) continue;
        const BigVector gradient =
            transpose(placement.object_from_world) * test::along(object.origin, object.direction, *exact);
        const Big length = sqrt(test::dot(gradient, gradient));
        const Vec3d normal = ellipsoid_normal(placement, ray, t);
        const BigVector error =
            test::big(normal) - BigVector{gradient.x / length, gradient.y / length, gradient.z / length};
        ASSERT_LE(static_cast<double>(sqrt(test::dot(error, error))), 0x1p-20)
            << number << ": " << test::reproducer(ray);
    }
}

// What bounds and the bounding sphere promise: every hit point lies in both.
TEST(AffineBounds, ContainTheHits) {
    for (const bool is_box : {false, true}) {
        for (std::uint64_t number = 0; number < 5000; ++number) {
            Random random(number);
            const Placement placement = any_placement(random, is_box);
            const Ray<float> ray = any_ray(random, placement);
            const auto exact = exact_hit(to_exact_object(placement, ray), is_box, 1);
            if (!exact) continue;
            const BigVector point = test::along(test::big(ray.origin), test::big(ray.direction), *exact);
            const Aabb box = bounds(placement);
            for (int i = 0; i < 3; ++i) {
                ASSERT_LE(Big(box.lower[i]), point[i]) << number << ": " << test::reproducer(ray);
                ASSERT_GE(Big(box.upper[i]), point[i]) << number << ": " << test::reproducer(ray);
            }
            const BigVector offset = point - test::big(placement.bounding_sphere.centre);
            ASSERT_LE(test::dot(offset, offset),
                      Big(placement.bounding_sphere.radius) * Big(placement.bounding_sphere.radius))
                << number << ": " << test::reproducer(ray);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Bodies, Affine, testing::Bool(),
                         [](const auto& info) { return info.param ? "Parallelepiped" : "Ellipsoid"; });

}  // namespace
}  // namespace tandem
