/// BVHs in GPU memory, for tests.
#pragma once

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "cuda/build_bvh.h"
#include "cuda/cuda_backend.h"
#include "cuda/device_scene.h"
#include "tandem/compile/build_bvh.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/traversal/collapse.h"
#include "tandem/kernel/traversal/make_node.h"
#include "tandem/scene/named_scenes.h"

namespace tandem::cuda {

template <class T>
std::vector<T> download(const T* from, std::size_t count) {
    std::vector<T> values(from == nullptr ? 0 : count);
    if (values.empty()) return values;
    check(cudaMemcpy(values.data(), from, count * sizeof(T), cudaMemcpyDeviceToHost), "downloading a BVH");
    return values;
}

inline Bvh download(const BuiltBvh& built, const SceneView& scene) {
    const std::size_t entries = built.entry_count + spare_entries;
    return {download(built.view.nodes, built.node_count), download(built.view.entry_spheres, entries),
            download(built.view.entry_ids, entries),
            download(built.view.placements,
                     placed_by_entry(scene) ? entries : scene.ellipsoid_count + scene.parallelepiped_count),
            download(built.view.entry_triangles, entries)};
}

inline PreparedScene with_material(PreparedScene scene) {
    scene.material_of.assign(scene.spheres.size() + scene.boxes.size() + scene.triangles.size() + scene.quads.size(),
                             0);
    scene.materials.emplace_back();
    scene.optics.emplace_back();
    return scene;
}

inline PreparedScene of_spheres(std::vector<Sphere> spheres) {
    PreparedScene scene;
    scene.spheres = std::move(spheres);
    return with_material(std::move(scene));
}

inline PreparedScene named(const char* name) { return prepare(named_scene(name)); }

/// The cost of a tree by the surface area heuristic, with the weights of collapse.h, from the padded bounds of what it
/// holds. Square metres: not yet relative to the area of the root.
class Cost {
  public:
    Cost(const Bvh& bvh, const SceneView& scene, const Padding& padding) : bvh_(bvh), scene_(scene), padding_(padding) {
        add_node(0);
    }
    [[nodiscard]] double area() const { return sum_; }

  private:
    Aabb add_node(std::int32_t index) {
        const BvhNode& node = bvh_.nodes[static_cast<std::size_t>(index)];
        Aabb all;
        for (int child = 0; child < bvh_width; ++child) {
            if (!has_child(node, child)) continue;
            const std::int32_t code = child_of(node, child);
            const Aabb box =
                code >= 0 ? add_node(code)
                          : pad(primitive_bounds(scene_, bvh_.entry_ids[static_cast<std::size_t>(~code)]), padding_);
            if (code < 0) sum_ += 0.6 * wide_half_area(box);
            all = merge(all, box);
        }
        sum_ += wide_half_area(all);
        return all;
    }

    const Bvh& bvh_;
    const SceneView& scene_;
    Padding padding_;
    double sum_ = 0;
};

/// Skips its tests where there is no GPU.
class NeedsGpu : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!why_cuda_unavailable().empty()) GTEST_SKIP() << why_cuda_unavailable();
    }
};

}  // namespace tandem::cuda
