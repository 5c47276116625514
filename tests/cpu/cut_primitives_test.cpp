#include "cpu/cut_primitives.h"

#include <gtest/gtest.h>

#include "support/hair.h"
#include "support/needles.h"

namespace tandem {
namespace {

Aabb bounds_of(const SceneView& scene) {
    Aabb box;
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) box = merge(box, primitive_bounds(scene, id));
    return box;
}
CutPrimitives cut(const SceneView& scene) { return cut_primitives(scene, primitive_count(scene), bounds_of(scene)); }

std::size_t pieces_of(const PreparedScene& scene) {
    const CutPrimitives result = cut(view(scene));
    if (result.further.empty()) {
        EXPECT_TRUE(result.counts.empty());
        return 0;
    }
    std::size_t pieces = 0;
    for (const std::uint8_t count : result.counts) pieces += count - 1U;
    EXPECT_EQ(result.further.size(), pieces);
    for (const PrimitivePiece& piece : result.further) {
        EXPECT_EQ(piece.count, result.counts[piece.primitive]);
        EXPECT_TRUE(piece.number >= 1 && piece.number < piece.count);
    }
    return pieces;
}

TEST(CutPrimitives, AreNeedlesAmongMany) {
    test::Random random(8);
    PreparedScene many = test::needles(random, 1'000, 1);
    EXPECT_GT(pieces_of(many), 10'000U);
    EXPECT_LT(pieces_of(test::needles(random, 1'000, 0.02)), 100U) << "shorter than their distances";
    EXPECT_LT(pieces_of(test::needles(random, 2, 1)), 20U) << "few others near";
    many.triangles.push_back({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    many.material_of.push_back(0);
    EXPECT_GT(pieces_of(many), 10'000U);
}

TEST(CutPrimitives, AreNoThickOrAxisAlignedOnes) {
    test::Random random(9);
    PreparedScene scene;
    const auto add = [&](const Vec3d& extent) {
        Placement placement;
        placement.centre = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
        placement.half_extent = extent;
        placement.object_from_world = {{{1 / extent.x, 0, 0}, {0, 1 / extent.y, 0}, {0, 0, 1 / extent.z}}};
        scene.parallelepipeds.push_back({placement});
        scene.material_of.push_back(0);
    };
    for (int i = 0; i < 2'000; ++i) add({0.5, 0.001, 0.001});
    EXPECT_EQ(pieces_of(scene), 0U);
    scene.parallelepipeds.clear();
    scene.material_of.clear();
    for (int i = 0; i < 2'000; ++i) add({0.5, 0.4, 0.3});
    EXPECT_EQ(pieces_of(scene), 0U);
}

// The inverse of such a matrix is too inexact (kernel/shapes/body_pieces.h).
TEST(CutPrimitives, AreNoneOfExtremeShapes) {
    test::Random random(10);
    PreparedScene scene = test::needles(random, 1'000, 1);
    for (Ellipsoid& body : scene.ellipsoids) body.object_from_world.row[0] = body.object_from_world.row[0] * 1e9;
    for (Parallelepiped& body : scene.parallelepipeds) {
        body.object_from_world.row[0] = body.object_from_world.row[0] * 1e9;
    }
    EXPECT_EQ(pieces_of(scene), 0U);
}

TEST(CutTriangles, AreLongOnesAmongMany) {
    test::Random random(13);
    const PreparedScene scene = test::hair(random, 20'000, 7, {.width = 0.01F});
    const CutPrimitives result = cut_triangles(view(scene), bounds_of(view(scene)));
    ASSERT_EQ(result.counts.size(), 20'000U);
    EXPECT_GT(result.further.size(), 100'000U);
    EXPECT_EQ(result.first_piece(7, 2).primitive, 9U);
    for (const PrimitivePiece& piece : result.further) {
        ASSERT_GE(piece.primitive, 7U) << "a sphere";
        EXPECT_EQ(piece.count, result.counts[piece.primitive - 7]);
        EXPECT_TRUE(piece.number >= 1 && piece.number < piece.count);
    }
    const PreparedScene few = test::hair(random, 2'000, 0, {.width = 0.01F});
    EXPECT_TRUE(cut_triangles(view(few), bounds_of(view(few))).further.empty()) << "a line hits few boxes";
}

TEST(CutTriangles, AreNoThickOrMaskedOnes) {
    test::Random random(14);
    PreparedScene scene = test::hair(random, 20'000, 0, {.width = 0.01F});
    SceneView masked = view(scene);
    masked.masked_kinds = PrimitiveKinds::triangle;
    EXPECT_TRUE(cut_triangles(masked, bounds_of(masked)).further.empty());
    for (std::size_t i = 1; i < scene.triangles.size(); i += 4'000) {
        Triangle& t = scene.triangles[i];
        t.v2 = t.v0 + Vec3f{t.v0.y - t.v1.y, t.v1.x - t.v0.x, 0};
    }
    const CutPrimitives result = cut_triangles(view(scene), bounds_of(view(scene)));
    ASSERT_FALSE(result.further.empty());
    for (std::size_t i = 1; i < scene.triangles.size(); i += 4'000) EXPECT_EQ(result.counts[i], 1);
}

TEST(CutPrimitives, AreNoneInScenesWithAlphaMasks) {
    test::Random random(11);
    const PreparedScene scene = test::needles(random, 1'000, 1);
    SceneView masked = view(scene);
    masked.masked_kinds = PrimitiveKinds::parallelepiped;
    EXPECT_TRUE(cut(masked).further.empty());
}

}  // namespace
}  // namespace tandem
