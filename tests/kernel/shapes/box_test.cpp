// cross_box against exact arithmetic on the same floats.
#include "tandem/kernel/shapes/box.h"

#include <gtest/gtest.h>

#include "support/adversarial_rays.h"
#include "support/case_name.h"
#include "support/exact_geometry.h"

namespace tandem {
namespace {

using test::BoxCase;

std::string describe(int kind, std::uint64_t number, const BoxCase& c) {
    char box[200];
    std::snprintf(box, sizeof box, "Box{{%aF, %aF, %aF}, {%aF, %aF, %aF}}", static_cast<double>(c.box.lower.x),
                  static_cast<double>(c.box.lower.y), static_cast<double>(c.box.lower.z),
                  static_cast<double>(c.box.upper.x), static_cast<double>(c.box.upper.y),
                  static_cast<double>(c.box.upper.z));
    return "box_case(" + std::to_string(kind) + ", " + std::to_string(number) + ") \"" + test::box_kinds[kind] +
           "\": " + box + ", " + test::reproducer(c.ray);
}

class BoxAgainstOracle : public testing::TestWithParam<int> {};

TEST_P(BoxAgainstOracle, DecidesRightAndIsWithinOneUlp) {
    const int kind = GetParam();
    int hits = 0, wrong = 0, coarse = 0, turned = 0;
    constexpr std::uint64_t count = 20000;
    for (std::uint64_t number = 0; number < count; ++number) {
        const BoxCase c = test::box_case(kind, number);
        if (!is_traceable(c.ray)) continue;
        double t = 0;
        const auto crossing = cross_box(c.box, c.ray);
        const bool hit = first_hit<float>(crossing, t);
        const auto exact = test::hit_box(test::big(c.ray.origin), test::big(c.ray.direction), test::big(c.box.lower),
                                         test::big(c.box.upper));
        if (hit != exact.has_value()) {
            if (++wrong <= 3) ADD_FAILURE() << (hit ? "false hit: " : "missed: ") << describe(kind, number, c);
            continue;
        }
        if (!hit) continue;
        ++hits;
        const double error = test::error_in_ulps(narrow(t), exact->t);
        if (error > 1 && ++coarse <= 3) ADD_FAILURE() << error << " ulp: " << describe(kind, number, c);

        // the axis counts where no other comes within rounding of it
        const Vec3d normal = face_normal(record_hit<float>(crossing, widen(c.ray.direction), false));
        const double along = normal[exact->axis] * static_cast<double>(c.ray.direction[exact->axis]);
        ASSERT_EQ(norm1(normal), 1.0) << describe(kind, number, c);
        const bool right = exact->entering ? along < 0 : along > 0;
        if (!right && test::nearly_tied(test::big(c.ray.origin), test::big(c.ray.direction), test::big(c.box.lower),
                                        test::big(c.box.upper), *exact)) {
            continue;
        }
        if (!right && ++turned <= 3) ADD_FAILURE() << "normal: " << describe(kind, number, c);
    }
    EXPECT_EQ(wrong, 0) << "wrong decisions of " << count;
    EXPECT_EQ(coarse, 0) << "of " << hits << " hits";
    EXPECT_EQ(turned, 0) << "of " << hits << " hits";
    EXPECT_GT(hits, 100) << "the generator has lost its aim";
}

INSTANTIATE_TEST_SUITE_P(Kinds, BoxAgainstOracle, testing::Range(0, static_cast<int>(std::size(test::box_kinds))),
                         [](const auto& info) { return test::case_name(test::box_kinds[info.param]); });

const Box unit_box = {{-1, -1, -1}, {1, 1, 1}};

TEST(Box, RayInThePlaneOfAFaceHits) {
    for (const float side : {-1.0F, 1.0F}) {
        for (const float zero : {0.0F, -0.0F}) {
            double t = 0;
            ASSERT_TRUE(first_hit<float>(cross_box(unit_box, Ray<float>{{side, 0, -3}, {zero, zero, 1}}), t));
            EXPECT_EQ(t, 2.0);
            const float outside = std::nextafter(side, 2 * side);
            EXPECT_FALSE(first_hit<float>(cross_box(unit_box, Ray<float>{{outside, 0, -3}, {zero, zero, 1}}), t));
        }
    }
}

TEST(Box, TieAtACornerGoesToTheLowestAxis) {
    const Ray<float> ray = {{-3, -3, -3}, {1, 1, 1}};
    const auto crossing = cross_box(unit_box, ray);
    EXPECT_EQ(crossing.near_axis, 0U);
    EXPECT_EQ(crossing.far_axis, 0U);
    EXPECT_EQ(face_normal(record_hit<float>(crossing, widen(ray.direction), false)), (Vec3d{-1, 0, 0}));
}

TEST(Box, OriginOnAFace) {
    double t = 0;
    EXPECT_FALSE(first_hit<float>(cross_box(unit_box, Ray<float>{{1, 0, 0}, {1, 0.5F, 0}}), t)) << "outward";
    ASSERT_TRUE(first_hit<float>(cross_box(unit_box, Ray<float>{{1, 0, 0}, {-1, 0, 0}}), t)) << "inward";
    EXPECT_EQ(t, 2.0);
    ASSERT_TRUE(first_hit<float>(cross_box(unit_box, Ray<float>{{1, 0, 0}, {0, 1, 0}}), t)) << "along: to the edge";
    EXPECT_EQ(t, 1.0);
}

TEST(Box, OriginInsideReportsTheExitWithAnOutwardNormal) {
    const Ray<float> ray = {{0, 0, 0}, {0, -2, 0.5F}};
    const auto crossing = cross_box(unit_box, ray);
    double t = 0;
    ASSERT_TRUE(first_hit<float>(crossing, t));
    EXPECT_EQ(t, 0.5);
    EXPECT_EQ(face_normal(record_hit<float>(crossing, widen(ray.direction), false)), (Vec3d{0, -1, 0}));
}

TEST(Box, NanAndInfinityMiss) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {nan, infinity, -infinity}) {
        for (int i = 0; i < 6; ++i) {
            Ray<float> ray = {{0.5F, 0.25F, -3}, {0, 0, 1}};
            (i < 3 ? ray.origin : ray.direction)[i % 3] = bad;
            double t = 0;
            EXPECT_FALSE(is_traceable(ray) && first_hit<float>(cross_box(unit_box, ray), t)) << i << " is " << bad;
        }
    }
    double t = 0;
    EXPECT_FALSE(first_hit<float>(cross_box(Box{{nan, -1, -1}, {1, 1, 1}}, Ray<float>{{0, 0, -3}, {0, 0, 1}}), t));
    EXPECT_FALSE(first_hit<float>(cross_box(unit_box, Ray<float>{{0, 0, -3}, {0, nan, 1}}), t));
    EXPECT_FALSE(first_hit<float>(cross_box(unit_box, Ray<float>{{nan, 0, -3}, {0, 0, 1}}), t));
}

}  // namespace
}  // namespace tandem
