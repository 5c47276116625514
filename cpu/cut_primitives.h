/// Long, thin primitives in pieces for hierarchies: most of the box around a primitive that lies along no axis is
/// empty, and among many of them a ray enters most boxes in vain. All pieces lead to the whole primitive, so decisions
/// do not change; a ray that enters several of its boxes decides several times. In scenes with alpha masks nothing is
/// cut, because shadow rays count there how many masked primitives they pass. Tested by
/// tests/cpu/cut_primitives_test.cpp, tests/agree/needles_test.cpp and tests/agree/hair_test.cpp.
#pragma once

#include <cstdint>
#include <vector>

#include "tandem/kernel/view/scene_view.h"
#include "tandem/math/aabb.h"

namespace tandem {

/// Piece `number` of a primitive that is cut into `count`.
struct PrimitivePiece {
    std::uint32_t primitive;
    std::uint16_t number, count;
};

/// Primitives one after the other, from some id on.
struct CutPrimitives {
    std::vector<std::uint8_t> counts;     ///< the pieces of each primitive; empty if none is cut
    std::vector<PrimitivePiece> further;  ///< the pieces after the first of each primitive

    /// Piece 0 of the primitive with id `first` + place, where `first` is the id of the first primitive.
    [[nodiscard]] PrimitivePiece first_piece(std::uint32_t first, std::size_t place) const {
        const std::uint16_t count = counts.empty() ? 1 : counts[place];
        return {first + static_cast<std::uint32_t>(place), 0, count};
    }
};

/// For Embree's hierarchy: cuts those of the primitives [0, count), ellipsoids and parallelepipeds as thin as needles,
/// whose boxes become much smaller, where other primitives are near. Triangles are not cut: that made packets slower
/// (docs/performance/cpu.md). `bounds`: of the scene. To be called in a TBB arena.
///
/// Method: as cuda/cut_kernels.h, but with eight pieces for each primitive that fits along the box, and at most
///         most_pieces. The primitives near are counted in a grid.
[[nodiscard]] CutPrimitives cut_primitives(const SceneView& scene, std::uint32_t count, const Aabb& bounds);

/// For groups (cpu/make_groups.h): cuts long, thin triangles, where many others are near. Only if may_cut_triangles().
/// `bounds`: of the scene. To be called in a TBB arena.
///
/// Method: as above, with one piece for each primitive that fits along the box, and at least six.
[[nodiscard]] CutPrimitives cut_triangles(const SceneView& scene, const Aabb& bounds);

/// Whether rays enter so many boxes of triangles before they hit one that pieces save more time than they take to
/// build. There coherent rays are faster through groups too, however narrow their packets are.
[[nodiscard]] bool may_cut_triangles(const SceneView& scene, const Aabb& bounds);

/// The bounds of a piece, not padded.
[[nodiscard]] Aabb piece_bounds(const SceneView& scene, const PrimitivePiece& piece);

}  // namespace tandem
