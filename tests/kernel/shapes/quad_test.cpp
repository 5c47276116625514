// A quad is its two triangles: the same hits, and no line through the diagonal.
#include "tandem/kernel/shapes/quad.h"

#include <gtest/gtest.h>

#include "support/adversarial_triangles.h"
#include "support/exact_geometry.h"

namespace tandem {
namespace {

using test::Random;

const Quad unit_quad = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

/// Flat, folded, and crossed over itself.
Quad any_quad(Random& random) {
    const Vec3d centre = test::any_unit(random) * random.uniform(0.0, 100.0);
    const auto corner = [&] { return centre + test::any_unit(random) * random.uniform(0.1, 1.0); };
    const Vec3d a = corner(), b = corner(), d = corner();
    return {narrow(a), narrow(b), narrow(random.coin() ? b + d - a : corner()), narrow(d)};
}

TEST(Quad, IsTheNearerOfItsTwoTriangles) {
    int hits = 0;
    for (std::uint64_t number = 0; number < 20000; ++number) {
        Random random(number);
        const Quad quad = any_quad(random);
        const Triangle halves[2] = {{quad.v0, quad.v1, quad.v2}, {quad.v0, quad.v2, quad.v3}};
        const Vec3f origin = narrow(widen(quad.v0) + test::any_unit(random) * random.uniform(0.0, 5.0));
        const Vec3d target = test::point_of(random, halves[random.below(2)]);
        const Ray<float> ray = {origin, narrow(target - widen(origin))};
        std::optional<test::Big> nearest;
        for (const Triangle& half : halves) {
            const auto hit = test::hit_triangle(test::big(ray.origin), test::big(ray.direction), test::big(half.v0),
                                                test::big(half.v1), test::big(half.v2));
            if (hit && (!nearest || hit->t < *nearest)) nearest = hit->t;
        }
        double t = 0;
        ASSERT_EQ(first_hit(quad, ray, t), nearest.has_value()) << "case " << number;
        if (!nearest) continue;
        ++hits;
        ASSERT_LE(test::error_in_ulps(narrow(t), *nearest), 1) << "case " << number;
        ASSERT_TRUE(may_touch_quad(make_filter_ray(ray), quad)) << "case " << number;
    }
    EXPECT_GT(hits, 9000);
}

TEST(Quad, LetsNothingThroughItsDiagonal) {
    for (std::uint64_t number = 0; number < 100000; ++number) {
        Random random(number);
        Quad quad = any_quad(random);
        const Vec3d v0 = widen(quad.v0), v2 = widen(quad.v2);
        // the other corners to the left and to the right of the diagonal, which most rays then meet from inside
        const Vec3d across = test::any_across(random, normalize(v2 - v0));
        quad.v1 = narrow((v0 + v2) * 0.5 + across);
        quad.v3 = narrow((v0 + v2) * 0.5 - across);
        const Vec3f origin = narrow(v0 + cross(across, normalize(v2 - v0)) * random.uniform(0.5, 50.0));
        const Vec3d target = v0 + (v2 - v0) * random.uniform(0.05, 0.95);
        double t = 0;
        ASSERT_TRUE(first_hit(quad, Ray<float>{origin, narrow(target - widen(origin))}, t)) << "case " << number;
    }
}

TEST(Quad, CoordinatesRunAlongItsEdges) {
    const auto at = [](const Quad& quad, float x, float y) {
        const Ray<float> ray = {{x, y, 1}, {0, 0, -1}};
        double t = 0;
        EXPECT_TRUE(first_hit(quad, ray, t));
        const bool first = is_in_first_half(record_hit(quad, ray, t, false, true));
        const auto corners = first ? barycentrics(quad.v0, quad.v1, quad.v2, ray, true)
                                   : barycentrics(quad.v0, quad.v2, quad.v3, ray, true);
        const auto c = quad_coordinates<float>(corners, first);
        return Vec3d{c.u, c.v, 0};
    };
    for (const Vec3f& p : {Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{1, 1, 0}, Vec3f{0, 1, 0}, Vec3f{0.75F, 0.25F, 0},
                           Vec3f{0.25F, 0.75F, 0}, Vec3f{0.5F, 0.5F, 0}}) {
        EXPECT_EQ(at(unit_quad, p.x, p.y), Vec3d(widen(p)));
    }
    const Quad kite = {{0, 0, 0}, {2, -1, 0}, {4, 0, 0}, {2, 3, 0}};
    EXPECT_EQ(at(kite, 2, 0), Vec3d(0.5, 0.5, 0));  // the middle of the diagonal
    EXPECT_EQ(at(kite, 2, 1.5F), Vec3d(0.25, 0.75, 0));
}

TEST(Quad, BoundsHoldTheCorners) {
    const Aabb box = bounds(Quad{{3, -1, 2}, {1, 5, 0}, {2, 2, 7}, {0, 0, 9}});
    EXPECT_EQ(box.lower, Vec3f(0, -1, 0));
    EXPECT_EQ(box.upper, Vec3f(3, 5, 9));
}

}  // namespace
}  // namespace tandem
