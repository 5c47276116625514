// The reject filters may not drop a hit. The test in double says what a hit is; sphere_test and box_test hold it to the
// exact answer.
#include "tandem/kernel/shapes/filter.h"

#include <gtest/gtest.h>

#include <vector>

#include "math/lane_operations.h"
#include "support/adversarial_rays.h"
#include "support/adversarial_triangles.h"
#include "support/exact_geometry.h"
#include "tandem/kernel/shapes/crossing.h"

namespace tandem {
namespace {

using test::Random;
static_assert(sizeof(Sphere) == 16 && sizeof(Ray<float>) == 24, "passed as floats");

constexpr std::uint64_t rays_per_kind = 80000;

/// The filters as packets run them, on every instruction set that this processor has: some fuse their products.
const std::vector<test::LaneOperations>& packets() {
    static const auto list = [] {
        std::vector<test::LaneOperations> found = {test::lane_operations_v2()};
        if (test::has_v3()) found.push_back(test::lane_operations_v3());
        if (test::has_v4()) found.push_back(test::lane_operations_v4());
        return found;
    }();
    return list;
}

void check(const Sphere& sphere, const Ray<float>& ray, const std::string& where, int& hits, int& rejected) {
    if (!is_traceable(ray)) return;
    double t = 0;
    const FilterRay<float> f = make_filter_ray(ray);
    bool passes =
        may_touch_sphere(f, sphere.centre, sphere.radius) && !is_behind_sphere(f, sphere.centre, sphere.radius);
    if (!passes) ++rejected;
    if (!first_hit(sphere, ray, t)) return;
    for (const auto& packet : packets()) passes = passes && packet.may_touch_sphere(&sphere.centre.x, &ray.origin.x);
    ++hits;
    ASSERT_TRUE(passes) << "rejected a hit at t = " << t << ": " << where << ", " << test::reproducer(ray);
}

void check(const Box& box, const Ray<float>& ray, const std::string& where, int& hits, int& rejected) {
    if (!is_traceable(ray)) return;
    double t = 0;
    bool passes = may_touch_box(make_filter_ray(ray), box.lower, box.upper);
    if (!passes) ++rejected;
    if (!first_hit<float>(cross_box(box, ray), t)) return;
    for (const auto& packet : packets()) passes = passes && packet.may_touch_box(&box.lower.x, &ray.origin.x);
    ++hits;
    ASSERT_TRUE(passes) << "rejected a hit at t = " << t << ": " << where << ", " << test::reproducer(ray);
}

void check(const Triangle& triangle, const Ray<float>& ray, const std::string& where, int& hits, int& rejected) {
    if (!is_traceable(ray)) return;
    double t = 0;
    bool passes = may_touch_triangle(make_filter_ray(ray), triangle.v0, triangle.v1, triangle.v2);
    if (!passes) ++rejected;
    if (!first_hit(triangle, ray, t)) return;
    for (const auto& packet : packets()) passes = passes && packet.may_touch_triangle(&triangle.v0.x, &ray.origin.x);
    ++hits;
    ASSERT_TRUE(passes) << "rejected a hit at t = " << t << ": " << where << ", " << test::reproducer(ray);
}

TEST(Filter, NeverRejectsASphereThatIsHit) {
    int hits = 0, rejected = 0;
    for (int kind = 0; kind < static_cast<int>(std::size(test::sphere_kinds)); ++kind) {
        for (std::uint64_t number = 0; number < rays_per_kind; ++number) {
            const auto c = test::sphere_case(kind, number);
            const auto where = [&] {
                return "sphere_case(" + std::to_string(kind) + ", " + std::to_string(number) + ")";
            };
            check(c.sphere, c.ray, where(), hits, rejected);
            if (HasFatalFailure()) return;
        }
    }
    EXPECT_GT(hits, 400000);
    EXPECT_GT(rejected, 50000) << "a filter that rejects nothing is no filter";
}

TEST(Filter, KnowsWhatIsBehindARay) {
    const auto is_behind = [](const Vec3f& origin, const Vec3f& direction) {
        return is_behind_sphere(make_filter_ray(Ray<float>{origin, direction}), {0, 0, 0}, 1);
    };
    EXPECT_TRUE(is_behind({0, 0, 2}, {0, 0, 1}));
    EXPECT_TRUE(is_behind({0, 0, 1.001F}, {5, 0, 0.01F}));
    EXPECT_FALSE(is_behind({0, 0, 2}, {0, 0, -1}));
    EXPECT_FALSE(is_behind({0, 0, 0.999F}, {0, 0, 1})) << "inside";
    EXPECT_FALSE(is_behind({0, 0, 1}, {0, 0, 1})) << "on the surface there is doubt";
    const auto may_touch = [](float z, float dz) {
        return may_touch_triangle(make_filter_ray(Ray<float>{{0.25F, 0.25F, z}, {0, 0, dz}}), {0, 0, 0}, {1, 0, 0},
                                  {0, 1, 0});
    };
    EXPECT_TRUE(may_touch(1, -1) && may_touch(-1, 1));
    EXPECT_FALSE(may_touch(1, 1) || may_touch(-1, -1)) << "behind";
    EXPECT_TRUE(may_touch(1e-9F, 1)) << "so near to the plane there is doubt";
}

TEST(Filter, NeverRejectsABoxThatIsHit) {
    int hits = 0, rejected = 0;
    for (int kind = 0; kind < static_cast<int>(std::size(test::box_kinds)); ++kind) {
        for (std::uint64_t number = 0; number < rays_per_kind; ++number) {
            const auto c = test::box_case(kind, number);
            const auto where = [&] { return "box_case(" + std::to_string(kind) + ", " + std::to_string(number) + ")"; };
            check(c.box, c.ray, where(), hits, rejected);
            if (HasFatalFailure()) return;
        }
    }
    EXPECT_GT(hits, 300000);
    EXPECT_GT(rejected, 50000);
}

TEST(Filter, NeverRejectsATriangleThatIsHit) {
    int hits = 0, rejected = 0;
    for (int kind = 0; kind < static_cast<int>(std::size(test::triangle_kinds)); ++kind) {
        for (std::uint64_t number = 0; number < rays_per_kind; ++number) {
            const auto c = test::triangle_case(kind, number);
            const auto where = [&] {
                return "triangle_case(" + std::to_string(kind) + ", " + std::to_string(number) + ")";
            };
            check(c.triangle, c.ray, where(), hits, rejected);
            if (HasFatalFailure()) return;
        }
    }
    EXPECT_GT(hits, 300000);
    EXPECT_GT(rejected, 50000);
}

// Sizes, distances and lengths over all magnitudes that a scene may hold, each on its own: products under- and
// overflow here. Lines through a point of the body's surface or just inside it.
TEST(Filter, HoldsOverAllMagnitudes) {
    int hits = 0, rejected = 0;
    for (std::uint64_t number = 0; number < 800000; ++number) {
        Random random(number);
        const auto any_point = [&](double lower, double upper) {
            return test::any_unit(random) * std::exp2(random.uniform(lower, upper));
        };
        const Vec3d centre = random.coin() ? Vec3d{0, 0, 0} : any_point(-100, 58);
        const double size = std::exp2(random.uniform(-120.0, 58.0));
        const Vec3d origin =
            random.coin() ? centre + test::any_unit(random) * (size * random.uniform(0.0, 3.0)) : any_point(-120, 58);
        const Vec3d target = centre + test::any_unit(random) * (size * random.uniform(0.9, 1.0));
        const double length = std::exp2(random.uniform(-140.0, 58.0));
        const Ray<float> ray = {narrow(origin), narrow(normalize(target - origin) * length)};
        const auto where = "magnitudes " + std::to_string(number);
        check(Sphere{narrow(centre), static_cast<float>(size)}, ray, where, hits, rejected);
        const Vec3d half = {size * random.uniform(0.0, 1.0), size, size * random.uniform(0.0, 1.0)};
        check(Box{narrow(centre - half), narrow(centre + half)}, ray, where, hits, rejected);
        // the target lies on an edge, or nearly
        const Vec3d along = test::any_unit(random) * (size * random.uniform(0.0, 1.0));
        const Vec3d aside = test::any_unit(random) * (size * std::exp2(random.uniform(-20.0, 0.0)));
        check(Triangle{narrow(target - along), narrow(target + along), narrow(target + aside)}, ray, where, hits,
              rejected);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(hits, 400000);
    EXPECT_GT(rejected, 50000);
}

TEST(Filter, NanPasses) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto f = make_filter_ray(Ray<float>{{nan, 0, 0}, {0, 0, 1}});
    EXPECT_TRUE(may_touch_sphere(f, {0, 0, 0}, 1));
    EXPECT_TRUE(may_touch_box(f, {-1, -1, -1}, {1, 1, 1}));
    EXPECT_TRUE(may_touch_triangle(f, {-1, -1, -1}, {1, 1, 1}, {1, 0, 0}));
}

}  // namespace
}  // namespace tandem
