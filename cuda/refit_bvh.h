/// Moves a BVH with its primitives: between frames of an animation their number stays the same, and near primitives
/// stay near.
#pragma once

#include "cuda/build_bvh.h"

namespace tandem::cuda {

/// Gives the nodes and entries of `built`, in place, the boxes of the primitives of `scene`, whose arrays are in GPU
/// memory and which has as many primitives of each kind as the scene that the tree was built for. Which primitives a
/// node holds does not change. Waits for the stream. The result has the memory of `built`, and its own frame and cost.
///
/// Method: level by level from the leaves up, one thread a node; a node's boxes are made from those of its children by
///         the functions that build_bvh() uses, so where nothing has moved the bytes stay the same. No order of threads
///         matters, so the same scene and tree always give the same bytes. The depth stays, so no stack overflows.
/// Throws EnvironmentError if the GPU lacks the memory. Tested by tests/cuda/refit_bvh_test.cpp.
[[nodiscard]] BuiltBvh refit_bvh(const SceneView& scene, const BuiltBvh& built, BuildMemory& memory,
                                 cudaStream_t stream);

/// The factor by which the cost of rays may rise before a tree is built again. Chosen by measurement
/// (docs/performance/hierarchies.md).
inline constexpr double most_wear = 1.05;

/// Whether a tree that was `built` and refitted has become so bad that it should be built again: by its cost relative
/// to the area of the root, or by the sum of the areas themselves. The first alone would miss a primitive that moves
/// far away, which makes the root large; the second alone would miss an object that shrinks while its parts change
/// places.
[[nodiscard]] inline bool is_worn(const BuiltBvh& refitted, const BuiltBvh& built) {
    const bool is_fit = refitted.cost <= most_wear * built.cost &&
                        refitted.cost * refitted.root_area <= most_wear * built.cost * built.root_area;
    return !is_fit;
}

/// How many primitives of each kind a scene has.
struct KindCounts {
#define TANDEM_PRIMITIVE(Type, name, names) std::uint32_t name = 0;
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    friend bool operator==(const KindCounts&, const KindCounts&) = default;
};
[[nodiscard]] inline KindCounts kind_counts(const SceneView& scene) {
    KindCounts counts;
#define TANDEM_PRIMITIVE(Type, name, names) counts.name = scene.name##_count;
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    return counts;
}

/// A BVH that is kept over several scenes.
class LastingBvh {
  public:
    /// The BVH of `scene`: the previous one, refitted, if that fits and is `allowed`; else a new one.
    [[nodiscard]] BuiltBvh of(const SceneView& scene, BuildMemory& memory, cudaStream_t stream, bool allowed);
    /// Whether the last one was refitted.
    [[nodiscard]] bool was_refitted() const { return was_refitted_; }

  private:
    BuiltBvh built_{};  ///< as it was built; without nodes: none
    KindCounts counts_{};
    bool was_refitted_ = false;
};

}  // namespace tandem::cuda
