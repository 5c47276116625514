/// Writes the entries of a BVH. Included by .cu files.
#pragma once

#include "cuda/build_bvh.h"
#include "cuda/build_tree.h"
#include "cuda/scene_bounds.h"
#include "tandem/kernel/traversal/hit_interval.h"
#include "tandem/kernel/traversal/make_node.h"

namespace tandem::cuda {

__device__ inline void write_entry(const SceneView& scene, const TreeArrays& to, std::uint32_t entry,
                                   std::uint32_t id) {
    to.ids[entry] = id;
    if (to.triangles != nullptr) to.triangles[entry] = entry_triangle(scene.triangles[id], id);
    if (to.placed_by_entry) to.placements[entry] = rough_placement(scene.parallelepipeds[id]);
    visit_primitive(scene, id, [&](const auto& primitive) { to.spheres[entry] = sphere_around(primitive); });
}

/// Spare entries, which absent children may refer to: copies of the last one.
static __global__ void spare_entries_kernel(TreeArrays to, std::uint32_t count) {
    const std::uint32_t entry = count + threadIdx.x;
    to.ids[entry] = to.ids[count - 1];
    to.spheres[entry] = to.spheres[count - 1];
    if (to.triangles != nullptr) to.triangles[entry] = to.triangles[count - 1];
    if (to.placed_by_entry) to.placements[entry] = to.placements[count - 1];
}

static __global__ void placements_kernel(SceneView scene, RoughPlacement* placements) {
    const std::uint32_t i = thread_number();
    if (i < scene.ellipsoid_count) {
        placements[i] = rough_placement(scene.ellipsoids[i]);
    } else if (i < scene.ellipsoid_count + scene.parallelepiped_count) {
        placements[i] = rough_placement(scene.parallelepipeds[i - scene.ellipsoid_count]);
    }
}

/// Writes the parts that no node of the tree writes: the spare entries behind `entries`, and the placements that are
/// not in the order of entries.
inline void write_rest(const SceneView& scene, const TreeArrays& to, std::uint32_t entries, const char* doing,
                       cudaStream_t stream) {
    const std::uint32_t placements = to.placed_by_entry ? 0 : scene.ellipsoid_count + scene.parallelepiped_count;
    launch(doing, spare_entries_kernel, 1, spare_entries, stream, to, entries);
    if (placements == 0) return;
    launch(doing, placements_kernel, (placements + build_block - 1) / build_block, build_block, stream, scene,
           to.placements);
}

}  // namespace tandem::cuda
