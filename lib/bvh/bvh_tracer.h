/// Tracing through the two-child hierarchy: nearer child first, stack in local memory.
/// Source: T. Aila, S. Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009.
#pragma once

#include "tandem/bvh/bvh.h"
#include "tandem/bvh/proposal.h"
#include "tandem/bvh/slab.h"
#include "tandem/geometry/intersect.h"

namespace tandem {

/// The arrays of a Bvh in the memory of the side that traverses it.
struct BvhView {
    const BvhNode* nodes;
    const Sphere* entry_spheres;
    const std::uint32_t* entry_ids;
    StructureFrame frame;
};

namespace bvh_detail {

struct alignas(16) Float4 {
    float a, b, c, d;
};

/// 16 bytes at once; on the GPU through the read-only cache.
TANDEM_HD Float4 load_float4(const void* address) {
#if TANDEM_ON_DEVICE
    const float4 v = __ldg(static_cast<const float4*>(address));
    return {v.x, v.y, v.z, v.w};
#else
    Float4 v;
    std::memcpy(&v, address, sizeof(v));
    return v;
#endif
}

}  // namespace bvh_detail

/// `kind_set` as with LoopTracerFor.
template <std::uint32_t kind_set>
struct BvhTracerFor {
    static constexpr std::uint32_t kinds = kind_set;

    SceneView scene;
    BvhView bvh;

    template <class Real>
    TANDEM_HD Closest<Real> closest(const Ray<Real>& ray, bool active) const {
        Closest<Real> best = no_hit<Real>();
        if (!active) return best;
        const Proposal<Real> proposal = propose(ray, bvh.frame, true);
        if (!proposal.active) return best;
        const FilterRay<Real> filter = make_filter_ray(ray);
        const SlabRay slab = make_slab_ray(to_plain(proposal.ray.origin), to_plain(proposal.ray.direction));
        float limit = 3e38F;
        std::int32_t stack[max_bvh_depth];
        int depth = 0;
        std::int32_t at = 0;
        while (true) {
            if (at >= 0) {
                const BvhNode& node = bvh.nodes[at];
                const bvh_detail::Float4 xy0 = bvh_detail::load_float4(node.xy[0]);
                const bvh_detail::Float4 xy1 = bvh_detail::load_float4(node.xy[1]);
                const bvh_detail::Float4 z = bvh_detail::load_float4(node.z);
                const bvh_detail::Float4 children = bvh_detail::load_float4(node.child);
                const float entry0 = slab_entry(slab, xy0.a, xy0.b, xy0.c, xy0.d, z.a, z.b, limit);
                const float entry1 = slab_entry(slab, xy1.a, xy1.b, xy1.c, xy1.d, z.c, z.d, limit);
                const bool enter0 = entry0 <= limit;
                const bool enter1 = entry1 <= limit;
                const auto child0 = static_cast<std::int32_t>(bits_of(children.a));
                const auto child1 = static_cast<std::int32_t>(bits_of(children.b));
                if (enter0 && enter1) {
                    const bool second_first = entry1 < entry0;
                    stack[depth++] = second_first ? child0 : child1;
                    at = second_first ? child1 : child0;
                    continue;
                }
                if (enter0 || enter1) {
                    at = enter0 ? child0 : child1;
                    continue;
                }
            } else {
                try_leaf(at, filter, proposal, best, limit);
            }
            if (depth == 0) return best;
            at = stack[--depth];
        }
    }

  private:
    template <class Real>
    TANDEM_HD void try_leaf(std::int32_t leaf, const FilterRay<Real>& filter, const Proposal<Real>& proposal,
                            Closest<Real>& best, float& limit) const {
        const std::uint32_t first = leaf_first(leaf);
        const std::uint32_t end = first + leaf_count(leaf);
        for (std::uint32_t i = first; i < end; ++i) {
            const bvh_detail::Float4 q = bvh_detail::load_float4(&bvh.entry_spheres[i]);
            const Sphere around = {{q.a, q.b, q.c}, q.d};
            if constexpr (!is_fast<Real>) {  // there the test costs hardly more than its filter
                if (!may_touch_sphere(filter, around.centre, around.radius)) continue;
            }
            const std::uint32_t id = bvh.entry_ids[i];
            const Double<Real> before = best.t;
            if (id < scene.sphere_count) {
                decide(around, id, filter.ray, true, best);
            } else {
                intersect_primitive<Real, kinds>(scene, id, filter, true, best);
            }
            if (best.t < before) limit = to_plain(proposal.limit(best.t));
        }
    }
};
using BvhTracer = BvhTracerFor<PrimitiveKinds::all>;

}  // namespace tandem
