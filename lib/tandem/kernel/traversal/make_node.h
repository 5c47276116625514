/// Makes the nodes and entries of a BVH, on the host and on the GPU.
#pragma once

#include "tandem/kernel/shapes/affine.h"
#include "tandem/kernel/shapes/quad.h"
#include "tandem/kernel/traversal/bvh.h"
#include "tandem/math/aabb.h"

namespace tandem {

namespace make_node_detail {

TANDEM_HD_INLINE double power_of_two(int exponent) {
    return double_of(static_cast<std::uint64_t>(exponent + 1023) << 52);
}
TANDEM_HD_INLINE double floor_of(double x) {
    const double rounded = round_to_int(x);
    return rounded > x ? rounded - 1 : rounded;
}
TANDEM_HD_INLINE double ceil_of(double x) { return -floor_of(-x); }

/// One axis of a node's grid: corner + 2^exponent * byte.
struct GridAxis {
    float corner;
    int exponent;

    /// The finest grid whose bytes reach from `lower` to `upper`, with 1/32 step to spare (node_ray.h needs 2^-12).
    TANDEM_HD_INLINE GridAxis(float lower, float upper) {
        const double extent = widen(upper) - widen(lower);
        const double step = greater(extent / 255, 1e-300);
        const int floor_log2 = static_cast<int>(bits_of(step) >> 52) - 1023;
        exponent = floor_log2 - 1 > least_step_exponent ? floor_log2 - 1 : least_step_exponent;
        while (!reaches(lower, upper)) ++exponent;
    }
    [[nodiscard]] TANDEM_HD_INLINE std::uint32_t below(float plane) const {
        return byte(floor_of(steps_to(plane) - spare));
    }
    [[nodiscard]] TANDEM_HD_INLINE std::uint32_t above(float plane) const {
        return byte(ceil_of(steps_to(plane) + spare));
    }

  private:
    static constexpr double spare = 1.0 / 32;

    TANDEM_HD_INLINE bool reaches(float lower, float upper) {
        corner = round_sum_down(widen(lower), -2 * spare * power_of_two(exponent));
        return ceil_of(steps_to(upper) + spare) <= 255;
    }
    [[nodiscard]] TANDEM_HD_INLINE double steps_to(float plane) const {
        return (widen(plane) - widen(corner)) * power_of_two(-exponent);
    }
    TANDEM_HD_INLINE static std::uint32_t byte(double steps) {
        return static_cast<std::uint32_t>(lesser(greater(steps, 0.0), 255.0));
    }
};

}  // namespace make_node_detail

/// The node whose children have these boxes, the inner ones first. `first_inner`: the index of the first inner child;
/// `first_entry`: that of the first leaf's entry.
TANDEM_HD_INLINE BvhNode make_node(const Aabb* boxes, int count, int inner, std::int32_t first_inner,
                                   std::int32_t first_entry) {
    BvhNode node{};
    Aabb all = boxes[0];
    for (int i = 1; i < count; ++i) all = merge(all, boxes[i]);
    const auto set_axis = [&](unsigned axis, float Vec3f::*of, std::uint32_t& lower, std::uint32_t& upper) {
        const make_node_detail::GridAxis grid(all.lower.*of, all.upper.*of);
        node.corner[axis] = grid.corner;
        node.frame |= frame_exponent(grid.exponent) << (8 * axis);
        lower = 0xFFFFFFFFU;  // empty
        for (int i = 0; i < count; ++i) {
            lower = (lower & ~(0xFFU << (8 * i))) | grid.below(boxes[i].lower.*of) << (8 * i);
            upper |= grid.above(boxes[i].upper.*of) << (8 * i);
        }
    };
    set_axis(0, &Vec3f::x, node.lower_x, node.upper_x);
    set_axis(1, &Vec3f::y, node.lower_y, node.upper_y);
    set_axis(2, &Vec3f::z, node.lower_z, node.upper_z);
    node.frame |= static_cast<std::uint32_t>(inner) << 24;
    node.first_inner = first_inner;
    node.leaf_base = inner - 1 - first_entry;
    return node;
}

namespace make_node_detail {

/// The smallest sphere around `middle` that contains all points.
template <class... Points>
TANDEM_HD_INLINE Sphere sphere_to(const Vec3f& middle, const Points&... points) {
    double radius2 = 0;
    const auto reach_for = [&](const Vec3f& point) {
        const Vec3d offset = widen(point) - widen(middle);
        radius2 = greater(radius2, dot(offset, offset));
    };
    (reach_for(points), ...);
    return {middle, round_up(square_root(radius2) * (1 + 1e-15))};
}

}  // namespace make_node_detail

// The sphere of an entry, which contains the primitive.
TANDEM_HD_INLINE Sphere sphere_around(const Sphere& sphere) { return sphere; }
TANDEM_HD_INLINE Sphere sphere_around(const Placement& body) { return body.bounding_sphere; }
TANDEM_HD_INLINE Sphere sphere_around(const Box& box) {
    const Vec3f middle = (box.lower + box.upper) * 0.5F;
    const Vec3d lower = widen(middle) - widen(box.lower);
    const Vec3d upper = widen(box.upper) - widen(middle);
    const Vec3d far = {greater(lower.x, upper.x), greater(lower.y, upper.y), greater(lower.z, upper.z)};
    return {middle, round_up(square_root(dot(far, far)) * (1 + 1e-15))};
}
TANDEM_HD_INLINE Sphere sphere_around(const Triangle& t) {
    return make_node_detail::sphere_to(centre(bounds(t)), t.v0, t.v1, t.v2);
}
TANDEM_HD_INLINE Sphere sphere_around(const Quad& q) {
    return make_node_detail::sphere_to(centre(bounds(q)), q.v0, q.v1, q.v2, q.v3);
}

/// Whether the placements of a tree are in the order of its entries: BvhView::placed_by_entry.
TANDEM_HD_INLINE bool placed_by_entry(const SceneView& scene) {
    return scene.parallelepiped_count > 0 && scene.parallelepiped_count == primitive_count(scene);
}

/// The entry of a triangle in a tree of triangles alone.
TANDEM_HD_INLINE EntryTriangle entry_triangle(const Triangle& t, std::uint32_t id) {
    return {edges_of(t.v0, t.v1, t.v2), id, t.attributes.sides};
}

}  // namespace tandem
