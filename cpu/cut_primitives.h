/// Ellipsoids and parallelepipeds as thin as needles, in pieces for Embree's hierarchy: most of the box around a needle
/// that lies along no axis is empty, and among many needles a ray enters most boxes in vain. All pieces lead to the
/// whole primitive, so decisions do not change; a ray that enters several of its boxes decides several times. Tested by
/// tests/cpu/cut_primitives_test.cpp and tests/agree/needles_test.cpp.
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

struct CutPrimitives {
    std::vector<std::uint8_t> counts;     ///< the pieces of each primitive; empty if none is cut
    std::vector<PrimitivePiece> further;  ///< the pieces after the first of each primitive
};

/// Cuts those of the primitives [0, count) whose boxes become much smaller, where other primitives are near. `bounds`:
/// of the scene. In scenes with alpha masks it cuts nothing, because shadow rays count there how many masked primitives
/// they pass. Triangles are not cut: that made packets slower (docs/performance/cpu.md). To be called in a TBB arena.
///
/// Method: as cuda/cut_kernels.h, but with eight pieces for each primitive that fits along the box, and at most
///         most_pieces. The primitives near are counted in a grid.
[[nodiscard]] CutPrimitives cut_primitives(const SceneView& scene, std::uint32_t count, const Aabb& bounds);

/// The bounds of a piece, not padded.
[[nodiscard]] Aabb piece_bounds(const SceneView& scene, const PrimitivePiece& piece);

}  // namespace tandem
