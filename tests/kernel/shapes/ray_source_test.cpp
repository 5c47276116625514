// Rays that start on a surface: never the root at the origin, and the far one within 1 ulp of exact arithmetic on the
// same floats (cases A8 and B11 of the catalogue).
#include "tandem/kernel/shapes/ray_source.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/aim.h"
#include "support/exact_geometry.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::Big;
using test::BigVector;

constexpr std::uint32_t own_id = 7;

/// A unit direction with the given cosine against `normal`.
Vec3d with_cosine(const Vec3d& normal, double cosine, test::Random& random) {
    const Vec3d across = normalize(cross(normal, test::any_unit(random)));
    return normal * cosine + across * std::sqrt((1 - cosine) * (1 + cosine));
}

/// The far root of a line and a ball; where the line misses it by rounding, its nearest point to the centre; at least
/// the smallest t there is.
Big far_root(const Sphere& sphere, const Ray<float>& ray) {
    const BigVector offset = test::big(ray.origin) - test::big(sphere.centre);
    const BigVector d = test::big(ray.direction);
    const Big a = test::dot(d, d);
    const Big b = -test::dot(offset, d);
    const Big discriminant = b * b - a * (test::dot(offset, offset) - Big(sphere.radius) * Big(sphere.radius));
    const Big t = (b + (discriminant > 0 ? Big(sqrt(discriminant)) : Big(0))) / a;
    return t > Big(0x1p-1022) ? t : Big(0x1p-1022);
}

struct SizeAndDistance {
    double radius;
    double distance;  ///< of the centre from the origin
};

class SphereSurface : public testing::TestWithParam<SizeAndDistance> {};

TEST_P(SphereSurface, IsLeftOutwardAndCrossedInward) {
    int inward = 0, outward = 0, coarse = 0;
    for (std::uint64_t number = 0; number < 20'000; ++number) {
        test::Random random(number);
        const Sphere sphere = {narrow(test::any_unit(random) * GetParam().distance),
                               static_cast<float>(GetParam().radius)};
        const Vec3d normal = test::any_unit(random);
        const double magnitude = number % 5 == 0 ? 0 : std::exp2(random.uniform(-24.0, 0.0));
        const double cosine = number % 2 == 0 ? magnitude : -magnitude;
        const Ray<float> ray = {narrow(widen(sphere.centre) + normal * widen(sphere.radius)),
                                narrow(with_cosine(normal, cosine, random) * std::exp2(random.uniform(-30.0, 30.0)))};
        const RaySource source = {own_id, cosine < 0};
        double t = -1;
        const bool hit = first_hit_from<float>(source, sphere, own_id, ray, true, HUGE_VAL, t);
        ASSERT_EQ(hit, source.inside) << "case " << number << ": " << test::reproducer(ray);
        ++(hit ? inward : outward);
        if (!hit) continue;
        ASSERT_GT(t, 0) << "case " << number << ": " << test::reproducer(ray);
        const double error = test::error_in_ulps(narrow(t), far_root(sphere, ray));
        if (error > 1 && ++coarse <= 3)
            ADD_FAILURE() << error << " ulp, case " << number << ": " << test::reproducer(ray);
        // for another primitive in the same place, the origin is anywhere
        double t_other = 0, t_free = 0;
        const bool other = first_hit_from<float>(source, sphere, own_id + 1, ray, true, HUGE_VAL, t_other);
        ASSERT_EQ(other, first_hit_from<float>(NoSource{}, sphere, own_id + 1, ray, true, HUGE_VAL, t_free))
            << "case " << number;
        if (other) {
            ASSERT_EQ(t_other, t_free) << "case " << number;
        }
    }
    EXPECT_EQ(coarse, 0);
    EXPECT_GT(inward, 5'000);
    EXPECT_GT(outward, 5'000);
}

INSTANTIATE_TEST_SUITE_P(Scales, SphereSurface,
                         testing::Values(SizeAndDistance{1e-3, 0}, SizeAndDistance{1e-3, 1}, SizeAndDistance{1, 3},
                                         SizeAndDistance{1, 1000}, SizeAndDistance{1, 1e5},
                                         SizeAndDistance{6.4e6, 6.4e6}, SizeAndDistance{1e-20, 1e-19},
                                         SizeAndDistance{1e15, 1e16}));

class BoxSurface : public testing::TestWithParam<SizeAndDistance> {};

TEST_P(BoxSurface, IsLeftOutwardAndCrossedInward) {
    for (std::uint64_t number = 0; number < 20'000; ++number) {
        test::Random random(number);
        const Vec3d centre = test::any_unit(random) * GetParam().distance;
        const auto half = [&] { return GetParam().radius * random.uniform(0.1, 1.0); };
        const Vec3d extent = {half(), half(), half()};
        const Box box = {narrow(centre - extent), narrow(centre + extent)};
        const int axis = static_cast<int>(random.below(3));
        const double side = random.coin() ? 1 : -1;
        Vec3d normal{0, 0, 0};
        normal[axis] = side;
        Vec3f origin;
        for (int i = 0; i < 3; ++i) {
            const float s = number % 7 == 0 ? 1.0F : random.uniform(0.0F, 1.0F);  // sometimes a corner
            origin[i] = std::min(box.upper[i], box.lower[i] + s * (box.upper[i] - box.lower[i]));
        }
        origin[axis] = side > 0 ? box.upper[axis] : box.lower[axis];
        const double magnitude = number % 5 == 0 ? 0 : std::exp2(random.uniform(-24.0, 0.0));
        Vec3d direction = with_cosine(normal, random.coin() ? magnitude : -magnitude, random);
        if (number % 5 == 0) direction[axis] = 0;
        const Ray<float> ray = {origin, narrow(direction)};
        const RaySource source = {own_id, widen(ray.direction[axis]) * side < 0};
        double t = -1;
        const bool hit = first_hit_from<float>(source, box, own_id, ray, true, HUGE_VAL, t);
        ASSERT_EQ(hit, source.inside) << "case " << number << ": " << test::reproducer(ray);
        if (!hit) continue;
        // the earliest exit of the three slabs
        Big exit;
        bool moves = false;
        for (int i = 0; i < 3; ++i) {
            if (ray.direction[i] == 0) continue;
            const Big face = ray.direction[i] > 0 ? Big(box.upper[i]) : Big(box.lower[i]);
            const Big at = (face - Big(origin[i])) / Big(ray.direction[i]);
            if (!moves || at < exit) exit = at;
            moves = true;
        }
        if (exit < Big(0x1p-1022)) exit = Big(0x1p-1022);
        ASSERT_LE(test::error_in_ulps(narrow(t), exit), 1) << "case " << number << ": " << test::reproducer(ray);
    }
}

INSTANTIATE_TEST_SUITE_P(Scales, BoxSurface,
                         testing::Values(SizeAndDistance{1e-3, 1}, SizeAndDistance{1, 3}, SizeAndDistance{1, 1000},
                                         SizeAndDistance{1e6, 1e6}));

TEST(ShadowSource, DoesNotSeeTheLight) {
    const Sphere light = {{0, 0, 5}, 1};
    const Ray<float> ray = {{0, 0, 0}, {0, 0, 1}};
    ShadowSource<float> source;
    double t = 0;
    EXPECT_TRUE(first_hit_from<float>(source, light, 3, ray, true, HUGE_VAL, t));
    source.light = 3;
    EXPECT_FALSE(first_hit_from<float>(source, light, 3, ray, true, HUGE_VAL, t));
    EXPECT_TRUE(first_hit_from<float>(source, light, 4, ray, true, HUGE_VAL, t));
}

/// Where a ray along -z from z = 4 hits a face, as a path's; infinity for a miss.
template <class Face>
double first_of_path(const Face& face, bool culls, double last_masked = 0) {
    const Ray<float> ray = {{0.125F, 0.5F, 4}, {0, 0, -1}};
    PathSource<float> source;
    if (last_masked > 0) source.last_masked = {last_masked, 3};
    double t = HUGE_VAL;
    return first_hit_from<float>(source, face, 3, ray, true, HUGE_VAL, t, culls) ? t : HUGE_VAL;
}

TEST(PathSource, PassesTheBackOfACulledFace) {
    const Vec3f a{0, 0, 1}, b{1, 0, 1}, c{0, 1, 1};
    for (const FaceSides sides : {FaceSides::single_sided, FaceSides::double_sided, FaceSides::culled}) {
        Triangle front = {a, b, c};
        Triangle back = {a, c, b};
        front.attributes.sides = back.attributes.sides = sides;
        for (const bool culls : {false, true}) {
            EXPECT_EQ(first_of_path(front, culls), 3);
            EXPECT_EQ(first_of_path(back, culls), culls && sides == FaceSides::culled ? HUGE_VAL : 3);
        }
    }
}

TEST(CulledShadowSource, PassesTheBackOfACulledFace) {
    const Vec3f a{0, 0, 1}, b{1, 0, 1}, c{0, 1, 1};
    const Ray<float> ray = {{0.125F, 0.5F, 4}, {0, 0, -1}};
    for (const FaceSides sides : {FaceSides::single_sided, FaceSides::double_sided, FaceSides::culled}) {
        Triangle front = {a, b, c};
        Triangle back = {a, c, b};
        front.attributes.sides = back.attributes.sides = sides;
        CulledShadowSource<float> source;
        const auto is_hit = [&](const auto& face, bool culls = true) {
            double t = 0;
            return first_hit_from(source, face, 3, ray, true, HUGE_VAL, t, culls);
        };
        EXPECT_TRUE(is_hit(front));
        EXPECT_EQ(is_hit(back), sides != FaceSides::culled);
        EXPECT_TRUE(is_hit(back, false));
        EXPECT_TRUE(is_hit(Sphere{{0, 0, 0}, 1}));
        source.light = 3;
        EXPECT_FALSE(is_hit(front)) << "the light itself";
        source = {};
        source.primitive = 3;
        EXPECT_FALSE(is_hit(front)) << "the ray leaves it";
    }
}

// Folded along the diagonal, the upper half seen from behind, the lower one from the front.
TEST(PathSource, PassesTheCulledHalfOfAFoldedQuad) {
    Quad folded = {{-1, -1, 1}, {-1, 1, 2}, {1, 1, 1}, {-1, 1, 0.5F}};
    folded.attributes.sides = FaceSides::culled;
    const double upper = first_of_path(folded, false);
    const double lower = first_of_path(folded, true);
    ASSERT_LT(upper, lower);
    EXPECT_EQ(first_of_path(folded, false, upper), lower);
    EXPECT_EQ(first_of_path(folded, true, upper), lower);
    EXPECT_EQ(first_of_path(folded, true, lower), HUGE_VAL);
    folded.attributes.sides = FaceSides::double_sided;
    EXPECT_EQ(first_of_path(folded, true), upper);
}

}  // namespace
}  // namespace tandem
