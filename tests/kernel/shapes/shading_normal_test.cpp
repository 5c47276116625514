// Normals of faces for shading: interpolation, opposite normals, sides.
#include "tandem/kernel/shapes/shading_normal.h"

#include <gtest/gtest.h>

#include "support/adversarial_triangles.h"

namespace tandem {
namespace {

const Triangle right_triangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

Ray<float> down(float x, float y, float side = 1) { return {{x, y, side}, {0, 0, -side}}; }

TEST(ShadingNormal, WithoutNormalsIsTheFacesOwn) {
    EXPECT_EQ(shading_normal(right_triangle, nullptr, down(0.25F, 0.25F), true), Vec3d(0, 0, 1));
    EXPECT_EQ(shading_normal(right_triangle, nullptr, down(0.25F, 0.25F, -1), true), Vec3d(0, 0, 1))
        << "from behind too";
}

TEST(ShadingNormal, IsThatOfACornerAtTheCorner) {
    const Vec3f normals[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    EXPECT_EQ(shading_normal(right_triangle, normals, down(0, 0), true), Vec3d(1, 0, 0));
    EXPECT_EQ(shading_normal(right_triangle, normals, down(1, 0), true), Vec3d(0, 1, 0));
    EXPECT_EQ(shading_normal(right_triangle, normals, down(0, 1), true), Vec3d(0, 0, 1));
    const Vec3d middle = shading_normal(right_triangle, normals, down(0.5F, 0), true);
    EXPECT_NEAR(middle.x, std::sqrt(0.5), 1e-15);
    EXPECT_NEAR(middle.y, std::sqrt(0.5), 1e-15);
    EXPECT_EQ(middle.z, 0);
}

TEST(ShadingNormal, OppositeNormalsFallBackToTheFacesOwn) {
    const Vec3f normals[] = {{1, 0, 0}, {-1, 0, 0}, {1, 0, 0}};
    EXPECT_EQ(shading_normal(right_triangle, normals, down(0.5F, 0), true), Vec3d(0, 0, 1));
    const Vec3f none[] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    EXPECT_EQ(shading_normal(right_triangle, none, down(0.25F, 0.25F), true), Vec3d(0, 0, 1));
}

TEST(ShadingNormal, OfADoubleSidedFaceTurnsToTheRay) {
    Triangle face = right_triangle;
    face.attributes.sides = FaceSides::double_sided;
    EXPECT_EQ(shading_normal(face, nullptr, down(0.25F, 0.25F, 1), true), Vec3d(0, 0, 1));
    EXPECT_EQ(shading_normal(face, nullptr, down(0.25F, 0.25F, -1), true), Vec3d(0, 0, -1));
    const Vec3f normals[] = {{0, 0.6F, 0.8F}, {0, 0.6F, 0.8F}, {0, 0.6F, 0.8F}};
    EXPECT_NEAR(shading_normal(face, normals, down(0.25F, 0.25F, -1), true).y, -0.6, 1e-7);
    EXPECT_NEAR(shading_normal(face, normals, down(0.25F, 0.25F, 1), true).y, 0.6, 1e-7);
}

TEST(ShadingNormal, IsUnitEverywhere) {
    for (int kind = 0; kind < static_cast<int>(std::size(test::triangle_kinds)); ++kind) {
        for (std::uint64_t number = 0; number < 2000; ++number) {
            const auto c = test::triangle_case(kind, number);
            double t = 0;
            if (!is_traceable(c.ray) || !first_hit(c.triangle, c.ray, t)) continue;
            test::Random random(number);
            const Vec3f normals[] = {narrow(test::any_unit(random)), narrow(test::any_unit(random)),
                                     narrow(test::any_unit(random))};
            for (const Vec3f* given : {static_cast<const Vec3f*>(nullptr), normals}) {
                const Vec3d n = shading_normal(c.triangle, given, c.ray, true);
                ASSERT_NEAR(dot(n, n), 1, 4e-15) << test::reproducer(c.triangle) << ", " << kind << ", " << number;
            }
        }
    }
}

TEST(ShadingNormal, OfAQuadIsContinuousOverTheDiagonal) {
    const Quad quad = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5F}, {0, 1, 0}};
    const Vec3f normals[] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    const auto at = [&](float x, float y) {
        double t = 0;
        EXPECT_TRUE(first_hit(quad, down(x, y), t));
        return shading_normal(quad, record_hit(quad, down(x, y), t, false, true), normals, down(x, y), true);
    };
    const Vec3d one_side = at(0.5F, 0.49999F), other_side = at(0.49999F, 0.5F);
    EXPECT_NEAR(one_side.x, other_side.x, 1e-4);
    EXPECT_NEAR(one_side.y, other_side.y, 1e-4);
    EXPECT_NEAR(one_side.z, other_side.z, 1e-4);
    EXPECT_EQ(at(1, 0), Vec3d(1, 0, 0));
    EXPECT_EQ(at(0, 1), Vec3d(-1, 0, 0));
}

}  // namespace
}  // namespace tandem
