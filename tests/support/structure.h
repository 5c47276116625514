// A prepared scene with the hierarchy that the CUDA backend traces, in host memory.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>

#include "tandem/compile/build_bvh.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/shapes/body_pieces.h"
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

/// A structure whose hierarchy holds every primitive in `count` pieces, as the GPU's may. Of triangles and solids.
inline Structure in_pieces(PreparedScene scene, std::uint32_t count) {
    Structure structure(std::move(scene));
    const SceneView whole = view(structure.scene);
    PreparedScene pieces;
    for (std::uint32_t id = 0; id < primitive_count(whole); ++id) {
        visit_primitive(whole, id, [&]<class Primitive>(const Primitive& primitive) {
            for (std::uint32_t i = 0; i < count; ++i) {
                if constexpr (can_have_pieces<Primitive>) {
                    const Aabb box = bounds_within(primitive, slab_of_piece(bounds(primitive), i, count));
                    pieces.boxes.push_back({box.lower, box.upper});
                }
            }
        });
    }
    Bvh bvh = build_bvh(view(pieces), structure.frame.padding);
    if (!placed_by_entry(whole)) bvh.placements = structure.bvh.placements;
    for (std::size_t i = 0; i < bvh.entry_ids.size(); ++i) {
        const std::uint32_t id = bvh.entry_ids[i] /= count;
        visit_primitive(whole, id, [&]<class Primitive>(const Primitive& primitive) {
            bvh.entry_spheres[i] = sphere_around(primitive);
            if constexpr (std::is_same_v<Primitive, Triangle>) {
                bvh.entry_triangles.push_back(entry_triangle(primitive, id));
            }
            if constexpr (std::is_same_v<Primitive, Parallelepiped>) {
                if (placed_by_entry(whole)) bvh.placements.push_back(rough_placement(primitive));
            }
        });
    }
    structure.bvh = std::move(bvh);
    return structure;
}

}  // namespace tandem::test
