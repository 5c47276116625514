/// What the leaves of a tree hold. Included by .cu files.
#pragma once

#include "cuda/build_bvh.h"
#include "tandem/kernel/shapes/body_pieces.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem::cuda {

/// Rays that pass alpha masks count each entry that they hit as a primitive (kernel/masked_hits.h).
[[nodiscard]] inline bool may_have_pieces(const SceneView& scene) {
    return scene.triangle_count + scene.ellipsoid_count + scene.parallelepiped_count > 0 && has_no_masks(scene);
}

/// The primitives of a scene, or pieces of them.
struct LeafItems {
    SceneView scene;
    const Piece* pieces;  ///< null: item i is primitive i

    [[nodiscard]] __device__ std::uint32_t primitive(std::uint32_t item) const {
        return pieces == nullptr ? item : pieces[item].primitive;
    }
    /// Not padded.
    [[nodiscard]] __device__ Aabb bounds(std::uint32_t item) const {
        if (pieces == nullptr) return primitive_bounds(scene, item);
        const Piece piece = pieces[item];
        Aabb result;
        visit_primitive(scene, piece.primitive, [&]<class Primitive>(const Primitive& primitive) {
            result = tandem::bounds(primitive);
            if constexpr (can_have_pieces<Primitive>) {
                if (piece.count > 1) {
                    result = bounds_within(primitive, slab_of_piece(result, piece.number, piece.count));
                }
            }
        });
        return result;
    }
};

}  // namespace tandem::cuda
