// first_hit and barycentrics of a triangle against exact arithmetic on the same floats.
#include "tandem/kernel/shapes/triangle.h"

#include <gtest/gtest.h>

#include "support/adversarial_triangles.h"
#include "support/case_name.h"
#include "support/exact_geometry.h"

namespace tandem {
namespace {

using test::TriangleCase;

std::optional<test::TriangleHit> exact_hit(const TriangleCase& c) {
    return test::hit_triangle(test::big(c.ray.origin), test::big(c.ray.direction), test::big(c.triangle.v0),
                              test::big(c.triangle.v1), test::big(c.triangle.v2));
}

std::string describe(int kind, std::uint64_t number, const TriangleCase& c) {
    return "triangle_case(" + std::to_string(kind) + ", " + std::to_string(number) + ") \"" +
           test::triangle_kinds[kind] + "\": " + test::reproducer(c.triangle) + ", " + test::reproducer(c.ray);
}

/// Is t the double nearest to the exact value, but for 2^-16 of a unit?
bool is_nearest_double(double t, const test::Big& exact) {
    const double ulp = std::nextafter(t, HUGE_VAL) - t;
    return abs(test::Big(t) - exact) <= test::Big(ulp * (0.5 + 0x1p-16));
}

class TriangleAgainstOracle : public testing::TestWithParam<int> {};

TEST_P(TriangleAgainstOracle, DecidesRightAndGivesTheNearestT) {
    const int kind = GetParam();
    const std::string name = test::triangle_kinds[kind];
    const bool never = name == "degenerate" || name == "in the plane";
    int hits = 0, wrong = 0, coarse = 0, astray = 0;
    constexpr std::uint64_t count = 20000;
    for (std::uint64_t number = 0; number < count; ++number) {
        const TriangleCase c = test::triangle_case(kind, number);
        if (!is_traceable(c.ray)) continue;
        double t = 0;
        const bool hit = first_hit(c.triangle, c.ray, t);
        const auto exact = exact_hit(c);
        if (hit != exact.has_value()) {
            if (++wrong <= 3) ADD_FAILURE() << (hit ? "false hit: " : "missed: ") << describe(kind, number, c);
            continue;
        }
        if (!hit) continue;
        ++hits;
        if (test::error_in_ulps(narrow(t), exact->t) > 1 || !is_nearest_double(t, exact->t)) {
            if (++coarse <= 3) ADD_FAILURE() << "t = " << t << ": " << describe(kind, number, c);
        }
        double t_limited = 0;
        for (const double farthest : {t, 2 * t}) {
            ASSERT_TRUE(first_hit(c.triangle, c.ray, t_limited, true, farthest) && t_limited == t)
                << "as far as " << farthest << ": " << describe(kind, number, c);
        }
        const bool found_beyond = first_hit(c.triangle, c.ray, t_limited, true, t / 2);
        ASSERT_TRUE(!found_beyond || t_limited == t) << describe(kind, number, c);
        const auto at = barycentrics(c.triangle.v0, c.triangle.v1, c.triangle.v2, c.ray, true);
        ASSERT_TRUE(at.u >= 0 && at.v >= 0 && at.u <= 1 && at.v <= 1 && at.u + at.v <= 1)
            << at.u << " " << at.v << ": " << describe(kind, number, c);
        if (abs(at.u - exact->u) > 0x1p-22 || abs(at.v - exact->v) > 0x1p-22) {
            if (++astray <= 3) ADD_FAILURE() << at.u << " " << at.v << ": " << describe(kind, number, c);
        }
    }
    EXPECT_EQ(wrong, 0) << "wrong decisions of " << count;
    EXPECT_EQ(coarse, 0) << "of " << hits << " hits";
    EXPECT_EQ(astray, 0) << "of " << hits << " hits";
    if (never) {
        EXPECT_EQ(hits, 0);
    } else {
        EXPECT_GT(hits, 100) << "the generator has lost its aim";
    }
}

// The tier precise: rays whose bits no float holds. The filter must let their hits pass as well.
TEST_P(TriangleAgainstOracle, DecidesRightForRaysInDouble) {
    const int kind = GetParam();
    for (std::uint64_t number = 0; number < 4000; ++number) {
        const TriangleCase c = test::triangle_case(kind, number);
        if (!is_traceable(c.ray)) continue;
        test::Random random(number);
        const auto off = [&](const Vec3f& v) {
            Vec3d moved = widen(v);
            for (int i = 0; i < 3; ++i) moved[i] *= 1 + random.uniform(-0x1p-24, 0x1p-24);
            return moved;
        };
        const Ray<double> ray = {off(c.ray.origin), random.coin() ? off(c.ray.direction) : widen(c.ray.direction)};
        double t = 0;
        const bool hit = first_hit(c.triangle, ray, t);
        const auto exact = test::hit_triangle(test::big(ray.origin), test::big(ray.direction), test::big(c.triangle.v0),
                                              test::big(c.triangle.v1), test::big(c.triangle.v2));
        ASSERT_EQ(hit, exact.has_value()) << describe(kind, number, c);
        if (!hit) continue;
        ASSERT_TRUE(is_nearest_double(t, exact->t)) << describe(kind, number, c);
        ASSERT_TRUE(may_touch_triangle(make_filter_ray(ray), c.triangle.v0, c.triangle.v1, c.triangle.v2))
            << describe(kind, number, c);
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, TriangleAgainstOracle,
                         testing::Range(0, static_cast<int>(std::size(test::triangle_kinds))),
                         [](const auto& info) { return test::case_name(test::triangle_kinds[info.param]); });

const Triangle unit_triangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST(Triangle, LeavesOutWhatIsTooFar) {
    const Ray<float> ray = {{0.25F, 0.25F, 1}, {0, 0, -2}};
    double t = 0;
    EXPECT_FALSE(first_hit(unit_triangle, ray, t, true, 0.49));
    EXPECT_TRUE(first_hit(unit_triangle, ray, t, true, 0.5)) << "at the same t ids decide";
}

TEST(Triangle, IsClosedAndHasTwoSides) {
    for (const float side : {1.0F, -1.0F}) {
        for (const Vec3f& at : {Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0.5F, 0.5F, 0},
                                Vec3f{0, 0.25F, 0}, Vec3f{0.125F, 0, 0}, Vec3f{0.25F, 0.25F, 0}}) {
            double t = 0;
            EXPECT_TRUE(first_hit(unit_triangle, Ray<float>{{at.x, at.y, side}, {0, 0, -2 * side}}, t))
                << at.x << " " << at.y;
            EXPECT_EQ(t, 0.5);
        }
        const float beyond = std::nextafter(0.5F, 1.0F);
        double t = 0;
        EXPECT_FALSE(first_hit(unit_triangle, Ray<float>{{0.5F, beyond, side}, {0, 0, -side}}, t));
        EXPECT_FALSE(first_hit(unit_triangle, Ray<float>{{-0x1p-149F, 0.5F, side}, {0, 0, -side}}, t));
    }
}

TEST(Triangle, OriginInThePlaneAndLinesInThePlaneMiss) {
    double t = 0;
    EXPECT_FALSE(first_hit(unit_triangle, Ray<float>{{0.25F, 0.25F, 0}, {0, 0, 1}}, t));
    EXPECT_FALSE(first_hit(unit_triangle, Ray<float>{{0.25F, 0.25F, 0}, {0.3F, 0, -1e-20F}}, t));
    EXPECT_FALSE(first_hit(unit_triangle, Ray<float>{{-1, 0.25F, 0}, {1, 0, 0}}, t));
    EXPECT_FALSE(first_hit(unit_triangle, Ray<float>{{-1, 0, 0}, {1, 0, 0}}, t)) << "along an edge";
    EXPECT_FALSE(first_hit(unit_triangle, Ray<float>{{0.25F, 0.25F, 1}, {0, 0, 1}}, t)) << "behind";
    EXPECT_TRUE(first_hit(unit_triangle, Ray<float>{{0.25F, 0.25F, 0x1p-149F}, {0, 0, -1}}, t));
    EXPECT_EQ(t, 0x1p-149);
}

// Coplanar triangles that overlap give the same t to the last bit: the id decides, and nothing flickers.
TEST(Triangle, CoplanarOnesAgreeOnT) {
    int pairs = 0;
    for (std::uint64_t number = 0; number < 20000; ++number) {
        test::Random random(number);
        const float height = random.uniform(-1.0F, 1.0F);
        const int up = static_cast<int>(random.below(3));
        const auto corner = [&] {
            Vec3f v = {random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)};
            v[up] = height;
            return v;
        };
        const Triangle a = {corner(), corner(), corner()}, b = {corner(), corner(), corner()};
        const Vec3f origin = narrow(test::any_unit(random) * 3.0);
        const Ray<float> ray = {origin, narrow(test::point_of(random, a) - widen(origin))};
        double t_a = 0, t_b = 0;
        if (!first_hit(a, ray, t_a) || !first_hit(b, ray, t_b)) continue;
        ++pairs;
        ASSERT_EQ(t_a, t_b) << "case " << number;
    }
    EXPECT_GT(pairs, 500);
}

TEST(Triangle, DegeneracyIsExact) {
    for (std::uint64_t number = 0; number < 20000; ++number) {
        for (const int kind : {0, 5, 10, 11, 15}) {
            const Triangle t = test::triangle_case(kind, number).triangle;
            const auto normal = test::cross(test::big(t.v1) - test::big(t.v0), test::big(t.v2) - test::big(t.v0));
            ASSERT_EQ(is_degenerate(t.v0, t.v1, t.v2), normal.x == 0 && normal.y == 0 && normal.z == 0)
                << test::reproducer(t);
        }
    }
}

TEST(Triangle, NormalIsCounterClockwise) {
    EXPECT_EQ(triangle_normal(unit_triangle.v0, unit_triangle.v1, unit_triangle.v2), Vec3d(0, 0, 1));
    EXPECT_EQ(triangle_normal(unit_triangle.v0, unit_triangle.v2, unit_triangle.v1), Vec3d(0, 0, -1));
}

TEST(Triangle, NanAndInfinityMiss) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {nan, infinity, -infinity}) {
        for (int i = 0; i < 6; ++i) {
            Ray<float> ray = {{0.25F, 0.25F, -3}, {0, 0, 1}};
            (i < 3 ? ray.origin : ray.direction)[i % 3] = bad;
            double t = 0;
            EXPECT_FALSE(is_traceable(ray) && first_hit(unit_triangle, ray, t)) << i << " is " << bad;
        }
    }
    double t = 0;
    EXPECT_FALSE(first_hit(Triangle{{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}}, Ray<float>{{0, 0, -3}, {0, 0, 1}}, t));
    EXPECT_FALSE(first_hit(unit_triangle, Ray<float>{{0, nan, -3}, {0, 0, 1}}, t));
}

TEST(Triangle, BoundsHoldTheCorners) {
    const Aabb box = bounds(Triangle{{3, -1, 2}, {1, 5, 0}, {2, 2, 7}});
    EXPECT_EQ(box.lower, Vec3f(1, -1, 0));
    EXPECT_EQ(box.upper, Vec3f(3, 5, 7));
}

}  // namespace
}  // namespace tandem
