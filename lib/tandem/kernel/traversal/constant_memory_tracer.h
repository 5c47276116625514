/// Traces a few spheres and boxes on a GPU. The data of the filters is in the kernel's parameters, at addresses known
/// at compile time, so the filters need no loads.
#pragma once

#include "tandem/kernel/traversal/certain_view.h"
#include "tandem/kernel/traversal/ray_tracer.h"

namespace tandem {

/// First all filters, without a branch; then, for the few primitives that pass, the decision in double.
struct ConstantMemoryStructure {
    static constexpr std::uint32_t kinds = PrimitiveKinds::sphere | PrimitiveKinds::box;
    static constexpr bool has_hierarchy = false;
    static constexpr std::uint32_t max_spheres = CertainView::max_spheres;
    static constexpr std::uint32_t max_boxes = CertainView::max_boxes;

    SceneView scene;
    Sphere spheres[max_spheres];
    BoxFilter boxes[max_boxes];
    Box faces[max_boxes];  ///< of the same boxes
    CertainView certain;   ///< of the job; not valid for rays that no camera sends
    bool culls_pixels = true;

    // one bit per slot: spheres, then boxes
    static constexpr std::uint32_t slot_count = max_spheres + max_boxes;
    static constexpr std::uint32_t all_slots = (1U << slot_count) - 1;
    TANDEM_HD_INLINE static constexpr std::uint32_t slot_of_sphere(std::uint32_t i) { return 1U << i; }
    TANDEM_HD_INLINE static constexpr std::uint32_t slot_of_box(std::uint32_t i) { return 1U << (max_spheres + i); }

    template <Search search, class Real, class From>
    TANDEM_HD_INLINE void find(const Ray<Real>& ray, const From& source, Closest<Real>& best) const {
        find_among<search>(all_slots, ray, source, best);
    }

    /// `slots`: those that the ray may hit, preferably the same for all threads of a warp.
    template <Search search, class Real, class From>
    TANDEM_HD_INLINE void find_among(std::uint32_t slots, const Ray<Real>& ray, const From& source,
                                     Closest<Real>& best) const {
        if (slots == 0) return;
        const FilterRay<Real> f = make_filter_ray(ray);
        const Double<Real> t_max = best.t;
        std::uint32_t candidates = 0;
#if TANDEM_ON_DEVICE
#pragma unroll
#endif
        for (std::uint32_t i = 0; i < max_spheres; ++i) {
            if (i == scene.sphere_count) break;
            if ((slots & slot_of_sphere(i)) == 0) continue;
            if constexpr (is_fast<Real>) {
                test_primitive(spheres[i], i, ray, source, true, best);
                continue;
            }
            if (may_touch_sphere(f, spheres[i].centre, spheres[i].radius)) candidates |= slot_of_sphere(i);
        }
#if TANDEM_ON_DEVICE
#pragma unroll
#endif
        for (std::uint32_t i = 0; i < max_boxes; ++i) {
            if (i == scene.box_count) break;
            if ((slots & slot_of_box(i)) == 0) continue;
            if (may_touch_box(f, boxes[i])) candidates |= slot_of_box(i);
        }
        for (; candidates != 0; candidates &= candidates - 1) {
            const auto slot = static_cast<std::uint32_t>(lowest_bit(candidates));
            if (slot < max_spheres) {
                test_primitive(scene.spheres[slot], slot, ray, source, true, best);
            } else {
                const std::uint32_t box = slot - max_spheres;
                test_primitive(scene.boxes[box], scene.sphere_count + box, ray, source, true, best);
            }
            if constexpr (search == Search::any) {
                if (best.t < t_max) return;
            }
        }
    }
};
using ConstantMemoryTracer = RayTracer<ConstantMemoryStructure>;

/// Whether the scene has few enough primitives, and only of these kinds.
TANDEM_HD_INLINE bool fits_constant_memory(const SceneView& scene) {
    return scene.sphere_count <= ConstantMemoryTracer::max_spheres &&
           scene.box_count <= ConstantMemoryTracer::max_boxes &&
           primitive_count(scene) == scene.sphere_count + scene.box_count;
}

/// `on_host`: the scene in host memory, to copy from; `scene`: the view that the tracer reads.
[[nodiscard]] inline ConstantMemoryTracer make_constant_memory_tracer(const SceneView& on_host,
                                                                      const SceneView& scene) {
    ConstantMemoryTracer tracer{};
    tracer.scene = scene;
    for (std::uint32_t i = 0; i < on_host.sphere_count; ++i) tracer.spheres[i] = on_host.spheres[i];
    for (std::uint32_t i = 0; i < on_host.box_count; ++i) {
        tracer.boxes[i] = make_box_filter(on_host.boxes[i].lower, on_host.boxes[i].upper);
        tracer.faces[i] = on_host.boxes[i];
    }
    return tracer;
}

}  // namespace tandem
