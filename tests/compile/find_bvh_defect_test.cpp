// The inspection of hierarchies: it finds what is wrong with one, and nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

#include "support/hair.h"
#include "support/needles.h"
#include "support/random.h"
#include "support/structure.h"
#include "tandem/compile/prepare.h"
#include "tandem/kernel/shapes/body_pieces.h"
#include "tandem/kernel/traversal/make_node.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using test::in_pieces;
using test::Structure;

TEST(BvhDefects, AreFound) {
    Structure structure(prepare(named_scene("mixed/100")));
    const SceneView scene = view(structure.scene);
    const Padding padding = structure.frame.padding;
    Bvh twice = structure.bvh;
    twice.entry_ids[0] = twice.entry_ids[1];
    EXPECT_NE(find_bvh_defect(twice, scene, padding), "");
    Bvh shrunk = structure.bvh;
    shrunk.nodes[0].upper_y -= 1;
    EXPECT_NE(find_bvh_defect(shrunk, scene, padding), "");
    Bvh cut = structure.bvh;
    cut.nodes[0].first_inner = 1 << 20;
    EXPECT_NE(find_bvh_defect(cut, scene, padding), "");
    test::Random random(27);
    for (PreparedScene cut_up : {test::hair(random, 50), test::needles(random, 25, 1)}) {
        Structure pieces = in_pieces(std::move(cut_up), 4);
        const std::uint32_t first = pieces.bvh.entry_ids[0];
        for (std::size_t i = 1; i < pieces.bvh.entry_ids.size(); ++i) {
            if (pieces.bvh.entry_ids[i] == first) continue;
            pieces.bvh.entry_ids[0] = pieces.bvh.entry_ids[i];  // a piece less of one, and one more of another
            break;
        }
        EXPECT_NE(find_bvh_defect(pieces.bvh, view(pieces.scene), pieces.frame.padding), "");
    }
}

// A needle between two far spheres, whose pieces come in reverse order: on the grid of the node both have the same
// place along the needle, and others across it.
TEST(BvhDefects, AreNotFoundInPiecesOnACoarseGrid) {
    constexpr float far = 0x1p20F;
    PreparedScene scene;
    scene.spheres = {{{-far, -far, -far}, 1}, {{far, far, far}, 1}};
    Parallelepiped needle{};
    const Matrix3 edges = {{{2000, -0.1, 0}, {1000, 0.2, 0}, {0, 0, 0.1}}};  // columns
    needle.object_from_world = inverse(edges);
    needle.centre = {5000, -500, 0};  // a plane of the grid is at y = -963
    needle.half_extent = {2000.1, 1000.2, 0.1};
    scene.parallelepipeds = {needle};
    scene.material_of.assign(3, 0);
    const Aabb boxes[] = {bounds_within(needle, slab_of_piece(bounds(needle), 1, 2)),
                          bounds_within(needle, slab_of_piece(bounds(needle), 0, 2)), bounds(scene.spheres[0]),
                          bounds(scene.spheres[1])};
    const Padding padding = make_structure_frame(merge(boxes[2], boxes[3])).padding;
    Aabb padded[4];
    std::transform(std::begin(boxes), std::end(boxes), padded, [&](const Aabb& box) { return pad(box, padding); });
    Bvh bvh;
    bvh.nodes = {make_node(padded, 4, 0, 0, 0)};
    bvh.entry_ids = {2, 2, 0, 1};
    bvh.entry_spheres.resize(4);
    EXPECT_EQ(find_bvh_defect(bvh, view(scene), padding), "");
}

}  // namespace
}  // namespace tandem
