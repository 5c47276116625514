// A prepared scene with the hierarchy that the CUDA backend traces, in host memory.
#pragma once

#include <cstdint>
#include <utility>

#include "tandem/compile/build_bvh.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/traversal/bvh_tracer.h"
#include "tandem/kernel/traversal/make_node.h"

namespace tandem::test {

struct Structure {
    explicit Structure(PreparedScene prepared) : scene(std::move(prepared)) {
        const SceneView scene_view = view(scene);
        for (std::uint32_t id = 0; id < primitive_count(scene_view); ++id) {
            bounds = merge(bounds, primitive_bounds(scene_view, id));
        }
        frame = make_structure_frame(bounds, BoxErrors::of_distance);
        bvh = build_bvh(scene_view, frame.padding);
    }
    template <Decisions decisions = Decisions::in_leaves, std::uint32_t kinds = PrimitiveKinds::all>
    [[nodiscard]] BvhTracerFor<kinds, decisions> tracer() const {
        return {view(scene),
                {bvh.nodes.data(), bvh.entry_spheres.data(), bvh.entry_ids.data(), bvh.entry_triangles.data(),
                 bvh.placements.data(), frame, nullptr, BvhView{}.bits_of_8, placed_by_entry(view(scene)) ? 1U : 0U}};
    }
    PreparedScene scene;
    Aabb bounds;
    StructureFrame frame{};
    Bvh bvh;
};

}  // namespace tandem::test
