/// Traverses the binary BVH: nearer child first, with a stack in local memory.
/// Source: T. Aila, S. Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009.
#pragma once

#include "tandem/kernel/traversal/bvh.h"
#include "tandem/kernel/traversal/proposal.h"
#include "tandem/kernel/traversal/ray_tracer.h"
#include "tandem/kernel/traversal/slab.h"

namespace tandem {

/// A Bvh. The pointers are to memory of the traversing side: host or device.
struct BvhView {
    const BvhNode* nodes;
    const Sphere* entry_spheres;
    const std::uint32_t* entry_ids;
    StructureFrame frame;
    unsigned long long* stack_overflows;  ///< counts rays whose stack was full; may be null
};

namespace bvh_detail {

struct alignas(16) Float4 {
    float a, b, c, d;
};

/// Loads 16 bytes at once; on the GPU through the read-only cache.
TANDEM_HD_INLINE Float4 load_float4(const void* address) {
#if TANDEM_ON_DEVICE
    const float4 v = __ldg(static_cast<const float4*>(address));
    return {v.x, v.y, v.z, v.w};
#else
    Float4 v;
    std::memcpy(&v, address, sizeof(v));
    return v;
#endif
}

TANDEM_HD_INLINE void count(unsigned long long* counter) {
    if (counter == nullptr) return;
#if TANDEM_ON_DEVICE
    atomicAdd(counter, 1ULL);
#else
    ++*counter;
#endif
}

/// Tests every primitive, for a ray whose stack overflowed: slow but correct. That cannot happen with a BVH from
/// build_bvh(). A separate function, so that other rays need no registers for it. Kernels that are linked for a scene
/// do not contain it, because their BVHs always come from build_bvh(); an overflow is still counted.
template <std::uint32_t kinds, class Real, class From>
TANDEM_HD_CALL Closest<Real> try_all(SceneView scene, Ray<Real> ray, From source, Closest<Real> best) {
    const FilterRay<Real> filter = make_filter_ray(ray);
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) {
        intersect_primitive<Real, kinds>(scene, id, filter, source, true, best);
    }
    return best;
}

}  // namespace bvh_detail

/// `kind_set`: as for LoopTracerFor.
template <std::uint32_t kind_set>
struct BvhStructure {
    static constexpr std::uint32_t kinds = kind_set;
    static constexpr bool has_hierarchy = true;

    SceneView scene;
    BvhView bvh;

    template <Search search, class Real, class From>
    TANDEM_HD_INLINE void find(const Ray<Real>& ray, const From& source, Closest<Real>& best) const {
        const Proposal<Real> proposal = propose(ray, bvh.frame, true);
        if (!proposal.active) return;
        const FilterRay<Real> filter = make_filter_ray(ray);
        const SlabRay slab = make_slab_ray(to_plain(proposal.ray.origin), to_plain(proposal.ray.direction));
        const Double<Real> t_max = best.t;
        // a constant for other rays: with start_for() nvcc spills more, and nearest hits take 6 % longer
        constexpr bool may_start_late = std::is_same_v<From, PathSource<Real>>;
        const float start = may_start_late ? to_plain(proposal.start_for(source)) : 0.0F;
        float limit = search == Search::any ? to_plain(proposal.limit(t_max)) : 3e38F;
        std::int32_t stack[max_bvh_depth];
        int depth = 0;
        bool overflow = false;  // checked after the loop, because another branch in the loop would make warps diverge
        std::int32_t at = 0;
        while (true) {
            if (at >= 0) {
                const BvhNode& node = bvh.nodes[at];
                const bvh_detail::Float4 xy0 = bvh_detail::load_float4(node.xy[0]);
                const bvh_detail::Float4 xy1 = bvh_detail::load_float4(node.xy[1]);
                const bvh_detail::Float4 z = bvh_detail::load_float4(node.z);
                const bvh_detail::Float4 children = bvh_detail::load_float4(node.child);
                const float entry0 = slab_entry(slab, xy0.a, xy0.b, xy0.c, xy0.d, z.a, z.b, start, limit);
                const float entry1 = slab_entry(slab, xy1.a, xy1.b, xy1.c, xy1.d, z.c, z.d, start, limit);
                const bool enter0 = entry0 <= limit;
                const bool enter1 = entry1 <= limit;
                const auto child0 = static_cast<std::int32_t>(bits_of(children.a));
                const auto child1 = static_cast<std::int32_t>(bits_of(children.b));
                if (enter0 && enter1) {
                    const bool second_first = entry1 < entry0;
                    overflow = overflow || depth == max_bvh_depth;
                    depth = depth < max_bvh_depth ? depth : max_bvh_depth - 1;
                    stack[depth++] = second_first ? child0 : child1;
                    at = second_first ? child1 : child0;
                    continue;
                }
                if (enter0 || enter1) {
                    at = enter0 ? child0 : child1;
                    continue;
                }
            } else {
                try_leaf(at, filter, source, proposal, best, limit);
                if constexpr (search == Search::any) {
                    if (best.t < t_max) return;
                }
            }
            if (depth == 0) break;
            at = stack[--depth];
        }
        if (overflow) [[unlikely]] {
            bvh_detail::count(bvh.stack_overflows);
            if constexpr (!is_linked) best = bvh_detail::try_all<kinds>(scene, ray, source, best);
        }
    }

  private:
    template <class Real, class From>
    TANDEM_HD_INLINE void try_leaf(std::int32_t leaf, const FilterRay<Real>& filter, const From& source,
                                   const Proposal<Real>& proposal, Closest<Real>& best, float& limit) const {
        const std::uint32_t first = leaf_first(leaf);
        const std::uint32_t end = first + leaf_count(leaf);
        for (std::uint32_t i = first; i < end; ++i) {
            const bvh_detail::Float4 q = bvh_detail::load_float4(&bvh.entry_spheres[i]);
            const Sphere around = {{q.a, q.b, q.c}, q.d};
            if constexpr (!is_fast<Real>) {  // in the tier fast the test costs hardly more than the filter
                if (!may_touch_sphere(filter, around.centre, around.radius)) continue;
            }
            const std::uint32_t id = bvh.entry_ids[i];
            const Double<Real> t_before = best.t;
            if (may_have(PrimitiveKinds::sphere) &&
                (!may_have(kinds & ~PrimitiveKinds::sphere) || id < scene.sphere_count)) {
                test_primitive(around, id, filter.ray, source, true, best);
            } else {
                intersect_primitive<Real, kinds>(scene, id, filter, source, true, best);
            }
            if (best.t < t_before) limit = to_plain(proposal.limit(best.t));
        }
    }
};

template <std::uint32_t kind_set>
using BvhTracerFor = RayTracer<BvhStructure<kind_set>>;
using BvhTracer = BvhTracerFor<PrimitiveKinds::all>;

}  // namespace tandem
