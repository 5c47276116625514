/// The traversal of the hierarchy by a ray: nearest child first, the others on a stack in local memory.
/// Source: T. Aila, S. Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009.
#pragma once

#include "tandem/kernel/traversal/hit_interval.h"
#include "tandem/kernel/traversal/node_ray.h"
#include "tandem/kernel/traversal/proposal.h"

namespace tandem {

/// A Bvh. The pointers are to memory of the traversing side: host or device.
struct BvhView {
    const BvhNode* nodes;
    const Sphere* entry_spheres;
    const std::uint32_t* entry_ids;
    const EntryTriangle* entry_triangles;  ///< null unless all primitives are triangles
    const RoughPlacement* placements;      ///< of the ellipsoids, then the parallelepipeds; or see placed_by_entry
    StructureFrame frame;
    unsigned long long* stack_overflows;  ///< counts rays whose stack was full; may be null
    /// The bits of 8 in half precision, whose lower byte becomes that of a plane. A member, so that it is no constant
    /// to the compiler: a permutation of bytes takes one constant, which is its pattern.
    std::uint32_t bits_of_8 = 0x4800U;
    std::uint32_t placed_by_entry =
        0;  ///< 1: all primitives are parallelepipeds, with placements in the order of entries
};

namespace bvh_detail {

struct alignas(16) Load16 {
    std::uint32_t a, b, c, d;
};

/// Loads 16 bytes at once; on the GPU through the read-only cache, and 128 bytes around them into the L2 cache:
/// neighbours in memory are near each other in the tree.
TANDEM_HD_INLINE Load16 load_16(const void* address) {
#if TANDEM_ON_DEVICE
    Load16 v;
    asm("ld.global.nc.L2::128B.v4.u32 {%0, %1, %2, %3}, [%4];"
        : "=r"(v.a), "=r"(v.b), "=r"(v.c), "=r"(v.d)
        : "l"(address));
    return v;
#else
    Load16 v;
    std::memcpy(&v, address, sizeof(v));
    return v;
#endif
}

TANDEM_HD_INLINE BvhNode load_node(const BvhNode* nodes, std::int32_t index) {
    const auto* address = reinterpret_cast<const char*>(nodes + index);
    const Load16 p = load_16(address), q = load_16(address + 16), r = load_16(address + 32);
    return {{float_of(p.a), float_of(p.b), float_of(p.c)},
            p.d,
            static_cast<std::int32_t>(q.a),
            static_cast<std::int32_t>(q.b),
            q.c,
            q.d,
            r.a,
            r.b,
            r.c,
            r.d};
}

/// The sphere around entry `i`; the primitive itself if that is a sphere.
TANDEM_HD_INLINE Sphere load_entry_sphere(const BvhView& bvh, std::uint32_t i) {
    const Load16 q = load_16(&bvh.entry_spheres[i]);
    return {{float_of(q.a), float_of(q.b), float_of(q.c)}, float_of(q.d)};
}

TANDEM_HD_INLINE EntryTriangle load_entry_triangle(const BvhView& bvh, std::uint32_t i) {
    const auto* address = reinterpret_cast<const char*>(bvh.entry_triangles + i);
    const Load16 p = load_16(address), q = load_16(address + 16), r = load_16(address + 32);
    return {{{float_of(p.a), float_of(p.b), float_of(p.c)},
             {float_of(p.d), float_of(q.a), float_of(q.b)},
             {float_of(q.c), float_of(q.d), float_of(r.a)},
             float_of(r.b)},
            r.c,
            static_cast<FaceSides>(r.d)};
}

TANDEM_HD_INLINE RoughPlacement load_placement(const BvhView& bvh, std::uint32_t i) {
    const auto* address = reinterpret_cast<const char*>(bvh.placements + i);
    const Load16 p = load_16(address), q = load_16(address + 16), r = load_16(address + 32), s = load_16(address + 48);
    const auto vector = [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return Vec3f{float_of(x), float_of(y), float_of(z)};
    };
    return {{vector(p.a, p.b, p.c), vector(p.d, q.a, q.b), vector(q.c, q.d, r.a)},
            vector(r.b, r.c, r.d),
            vector(s.a, s.b, s.c),
            float_of(s.d)};
}

TANDEM_HD_INLINE void count(unsigned long long* counter) {
    if (counter == nullptr) return;
#if TANDEM_ON_DEVICE
    atomicAdd(counter, 1ULL);
#else
    ++*counter;
#endif
}

/// How a traversal ended.
struct WalkEnd {
    bool stopped;
    bool stack_was_full;  ///< not all entries were visited
};

/// The stack of a traversal, in local memory.
struct LocalStack {
    std::int32_t entries[bvh_stack_size];

    TANDEM_HD_INLINE void set(int i, std::int32_t child) { entries[i] = child; }
    // NOLINTNEXTLINE(clang-analyzer-core.uninitialized.UndefReturn): set before
    [[nodiscard]] TANDEM_HD_INLINE std::int32_t get(int i) const { return entries[i]; }
};

/// The state of a traversal: a place in the hierarchy, and on a stack. The stack belongs to the caller: as a member,
/// its array would move the whole state to local memory.
struct Walk {
    std::int32_t at;   ///< 0 or more: a node; negative: ~entry; or no_child, at the end
    std::int32_t top;  ///< of the stack, in a register, so that the next node is known before the memory answers
    int depth;         ///< of the rest of the stack; above 0 at the end: it was full

    /// At the root.
    template <class Stack>
    TANDEM_HD_INLINE static Walk from_root(Stack& stack) {
        stack.set(0, no_child);  // below the last
        return {0, no_child, 1};
    }
    [[nodiscard]] TANDEM_HD_INLINE bool is_done() const { return at == no_child; }
    [[nodiscard]] TANDEM_HD_INLINE bool is_at_entry() const { return at < 0; }
    [[nodiscard]] TANDEM_HD_INLINE std::uint32_t entry() const { return static_cast<std::uint32_t>(~at); }

    template <class Stack>
    TANDEM_HD_INLINE void pop(const Stack& stack) {
        at = top;
        top = stack.get(--depth);
    }
    /// From a node to the nearest child that the ray enters within [start, limit], or to the top of the stack.
    template <bool starts_late, class Stack>
    TANDEM_HD_INLINE void descend(Stack& stack, const BvhView& bvh, const NodeRay& ray, float start, float limit) {
        const BvhNode node = load_node(bvh.nodes, at);
        const EnteredChildren entered = enter_children<starts_late>(node, bvh.bits_of_8, ray, start, limit);
        const auto child = [&](int i) { return child_of(node, entered.key[i] & 3); };
        if (entered.key[0] == no_child) {
            pop(stack);
            return;
        }
        // a full stack ends the traversal, without a branch of its own, because that would make warps diverge
        constexpr int fullest = bvh_stack_size - (bvh_width - 1);
        const bool is_full = depth > fullest;
        depth = is_full ? fullest : depth;
        // the farthest child lowest, without a branch within a branch
        const bool one = entered.key[1] != no_child, two = entered.key[2] != no_child;
        const bool three = entered.key[3] != no_child;
        const std::int32_t second = child(2), third = child(3);
        if (one) stack.set(depth, top);
        if (two) stack.set(depth + 1, three ? third : second);
        if (three) stack.set(depth + 2, second);
        top = one ? child(1) : top;
        depth += (one ? 1 : 0) + (two ? 1 : 0) + (three ? 1 : 0);
        at = is_full ? no_child : child(0);
    }
};

/// Calls leaf(entry) for the entries that the ray may hit in [start, limit], until one returns true. `leaf` may lower
/// `limit`. `starts_late`: whether `start` may be positive.
template <bool starts_late, class Leaf>
TANDEM_HD_INLINE WalkEnd walk(const BvhView& bvh, const NodeRay& ray, float start, const float& limit,
                              const Leaf& leaf) {
    LocalStack stack;
    Walk at = Walk::from_root(stack);
    while (!at.is_done()) {
        if (!at.is_at_entry()) at.descend<starts_late>(stack, bvh, ray, start, limit);
        if (at.is_at_entry()) {
            if (leaf(at.entry())) return {true, false};
            at.pop(stack);
        }
    }
    return {false, at.depth > 0};
}

}  // namespace bvh_detail

}  // namespace tandem
