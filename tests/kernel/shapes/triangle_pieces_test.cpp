// The pieces of a triangle: every point is in the bounds of one, and for long, thin triangles they are small.
#include "tandem/kernel/shapes/triangle_pieces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"
#include "tandem/kernel/traversal/collapse.h"
#include "tandem/kernel/traversal/proposal.h"

namespace tandem {
namespace {

using test::Random;

Vec3f anywhere(Random& random) {
    return {random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)};
}

Aabb piece(const Triangle& triangle, std::uint32_t number, std::uint32_t count) {
    return bounds_within(triangle, slab_of_piece(bounds(triangle), number, count));
}

TEST(TrianglePieces, AreTwoForEachPrimitiveAlongTheTriangle) {
    EXPECT_EQ(pieces_along(1, 0), 1U);
    EXPECT_EQ(pieces_along(1, 1), 2U);
    EXPECT_EQ(pieces_along(1, 26), 5U);
    EXPECT_EQ(pieces_along(1, 27), 6U);
    EXPECT_EQ(pieces_along(0.5, 27), 3U);
    EXPECT_EQ(pieces_along(0.5, 4'000'000'000U), most_pieces);
}

TEST(TrianglePieces, HoldEveryPoint) {
    Random random(1);
    for (int i = 0; i < 20'000; ++i) {
        const float scale = std::abs(random.log_uniform(-20.0, 15.0));
        const Vec3f at = random.coin() ? Vec3f{0, 0, 0} : anywhere(random);
        Triangle triangle{(at + anywhere(random)) * scale, (at + anywhere(random)) * scale,
                          (at + anywhere(random)) * scale};
        if (random.coin()) triangle.v2 = triangle.v0 + anywhere(random) * (1e-3F * scale);
        if (random.below(4) == 0) triangle.v1.x = triangle.v0.x;
        const Padding padding = make_structure_frame(bounds(triangle), BoxErrors::of_distance).padding;
        const std::uint32_t count = 1 + random.below(16);
        for (int k = 0; k < 20; ++k) {
            double u = random.uniform(0.0, 1.0), v = random.uniform(0.0, 1.0);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            if (k % 4 == 0) v = 0;
            if (k == 1) u = 0, v = 1;
            const Vec3d v0 = widen(triangle.v0);
            const Vec3d point = v0 + (widen(triangle.v1) - v0) * u + (widen(triangle.v2) - v0) * v;
            bool is_held = false;
            for (std::uint32_t number = 0; number < count; ++number) {
                const Aabb box = pad(piece(triangle, number, count), padding);
                bool is_in = true;
                for (int axis = 0; axis < 3; ++axis) {
                    is_in = is_in && widen(box.lower[axis]) <= point[axis] && point[axis] <= widen(box.upper[axis]);
                }
                is_held = is_held || is_in;
            }
            ASSERT_TRUE(is_held) << "triangle " << i << ", point " << k << ", " << count << " pieces";
        }
    }
}

TEST(TrianglePieces, OfThinTrianglesAreSmall) {
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec3f root = anywhere(random);
        const Triangle triangle{root, root + anywhere(random), root + anywhere(random) * 1e-4F};
        const double whole = wide_half_area(bounds(triangle));
        double sum = 0;
        for (std::uint32_t number = 0; number < 8; ++number) sum += wide_half_area(piece(triangle, number, 8));
        EXPECT_LT(sum, whole / 8 + 1e-2) << i;
    }
}

TEST(TrianglePieces, AreOfSlivers) {
    EXPECT_TRUE(is_sliver({{0, 0, 0}, {1, 1, 1}, {0, 0.01F, 0}}));
    EXPECT_FALSE(is_sliver({{0, 0, 0}, {1, 0, 0}, {0, 0.01F, 0}})) << "along an axis";
    EXPECT_FALSE(is_sliver({{0, 0, 0}, {1, 1, 1}, {1, 0, 0}}));
    EXPECT_FALSE(is_sliver({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}})) << "a point";
}

TEST(TrianglePieces, LieWithinTheTrianglesBox) {
    const Triangle triangle{{0, 0, 0}, {8, 4, 0}, {8, 0, 2}};
    const Aabb second = piece(triangle, 1, 2);
    EXPECT_EQ(second.lower.x, 4);
    EXPECT_EQ(second.upper.x, 8);
    EXPECT_EQ(second.lower.y, 0);
    EXPECT_EQ(second.upper.y, 4);
    EXPECT_EQ(second.upper.z, 2);
    const Aabb first = piece(triangle, 0, 2);
    EXPECT_EQ(first.upper.y, 2);
    EXPECT_EQ(first.upper.z, 1);
    EXPECT_EQ(piece(triangle, 0, 1).upper.x, 8);
}

}  // namespace
}  // namespace tandem
