/// The walk of a ray through the binary BVH: nearer child first, with a stack in local memory.
/// Source: T. Aila, S. Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009.
#pragma once

#include "tandem/kernel/traversal/bvh.h"
#include "tandem/kernel/traversal/proposal.h"
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

/// The sphere around entry `i`; the primitive itself if that is a sphere.
TANDEM_HD_INLINE Sphere load_entry_sphere(const BvhView& bvh, std::uint32_t i) {
    const Float4 q = load_float4(&bvh.entry_spheres[i]);
    return {{q.a, q.b, q.c}, q.d};
}

TANDEM_HD_INLINE void count(unsigned long long* counter) {
    if (counter == nullptr) return;
#if TANDEM_ON_DEVICE
    atomicAdd(counter, 1ULL);
#else
    ++*counter;
#endif
}

/// How a walk ended.
struct WalkEnd {
    bool stopped;
    bool stack_was_full;  ///< some leaves were not visited
};

/// Calls leaf(child) for the leaves that the ray may hit in [start, limit], until one returns true. `leaf` may lower
/// `limit`.
template <class Leaf>
TANDEM_HD_INLINE WalkEnd walk(const BvhNode* nodes, const SlabRay& slab, float start, const float& limit,
                              const Leaf& leaf) {
    std::int32_t stack[max_bvh_depth];
    int depth = 0;
    bool overflow = false;  // checked after the loop, because another branch in the loop would make warps diverge
    std::int32_t at = 0;
    while (true) {
        if (at >= 0) {
            const BvhNode& node = nodes[at];
            const Float4 xy0 = load_float4(node.xy[0]);
            const Float4 xy1 = load_float4(node.xy[1]);
            const Float4 z = load_float4(node.z);
            const Float4 children = load_float4(node.child);
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
            if (leaf(at)) return {true, overflow};
        }
        if (depth == 0) break;
        at = stack[--depth];
    }
    return {false, overflow};
}

}  // namespace bvh_detail

}  // namespace tandem
