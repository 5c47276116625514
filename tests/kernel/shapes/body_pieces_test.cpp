// Pieces of solids: together they hold the whole.
#include "tandem/kernel/shapes/body_pieces.h"

#include <gtest/gtest.h>

#include "support/needles.h"
#include "tandem/kernel/traversal/proposal.h"

namespace tandem {
namespace {

bool contains(const Aabb& box, const Vec3d& point) {
    for (int axis = 0; axis < 3; ++axis) {
        if (point[axis] < double{box.lower[axis]} || point[axis] > double{box.upper[axis]}) return false;
    }
    return true;
}

// However a solid is cut, each of its points is in a piece. The padding stands for rounding; a quarter of that of a
// hierarchy is enough.
TEST(BodyPieces, HaveAllPointsOfTheSolid) {
    test::Random random(7);
    for (int round = 0; round < 40; ++round) {
        const PreparedScene scene = test::needles(random, 3, 1.5);
        Aabb all;
        for (std::uint32_t id = 0; id < primitive_count(view(scene)); ++id) {
            all = merge(all, primitive_bounds(view(scene), id));
        }
        Padding padding = make_structure_frame(all).padding;
        padding.least *= 0.25F;
        const auto check = [&](const Placement& solid, const Vec3d& local) {
            const Vec3d point = test::point_of(solid, local);
            for (const std::uint32_t count : {1U, 2U, 3U, 7U, 16U}) {
                int holders = 0;
                for (std::uint32_t i = 0; i < count; ++i) {
                    const Slab slab = slab_of_piece(bounds(solid), i, count);
                    holders += contains(pad(bounds_within(solid, slab), padding), point) ? 1 : 0;
                }
                ASSERT_GE(holders, 1) << "round " << round << ", local " << local.x << " " << local.y << " " << local.z
                                      << ", " << count << " pieces, condition " << condition(solid);
            }
        };
        for (int i = 0; i < 300; ++i) {
            const auto part = [&] { return random.coin() ? random.uniform(-1.0, 1.0) : random.coin() ? 1.0 : -1.0; };
            const Vec3d local = {part(), part(), part()};
            const auto number = static_cast<std::size_t>(random.below(3));
            check(scene.parallelepipeds[number], local);
            check(scene.ellipsoids[number], local * (1 / length(local)));
        }
    }
}

Parallelepiped box_of(const Vec3d& half_edges) {
    Parallelepiped box{};
    box.half_extent = half_edges;
    box.object_from_world = {{{1 / half_edges.x, 0, 0}, {0, 1 / half_edges.y, 0}, {0, 0, 1 / half_edges.z}}};
    return box;
}

TEST(BodyPieces, AreSmallIfTheSolidIsANeedleAcrossTheAxes) {
    EXPECT_TRUE(is_needle(box_of({1, 0.01, 0.001})));
    EXPECT_FALSE(is_needle(box_of({1, 0.9, 0.001}))) << "a plate";
    EXPECT_FALSE(is_needle(box_of({1, 0.9, 0.8})));
    EXPECT_FALSE(are_small(box_of({1, 0.01, 0.001}), 8)) << "along an axis";
    test::Random random(8);
    const PreparedScene scene = test::needles(random, 100, 1);
    int small = 0;
    for (const Ellipsoid& needle : scene.ellipsoids) small += are_small(needle, 8) ? 1 : 0;
    EXPECT_GT(small, 70);
}

// The inverse of such a matrix says little.
TEST(BodyPieces, AreWholeIfTheMatrixIsNearlySingular) {
    Parallelepiped box = box_of({1, 0.01, 1e-7});
    box.centre = {1, 2, 3};
    const Aabb whole = bounds(box), piece = bounds_within(box, slab_of_piece(whole, 0, 4));
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(piece.lower[axis], whole.lower[axis]);
        EXPECT_EQ(piece.upper[axis], whole.upper[axis]);
    }
    EXPECT_FALSE(are_small(box, 4));
}

}  // namespace
}  // namespace tandem
