/// The nearest hit of a camera ray, where float decides it with certainty.
///
/// Needs: a valid CertainView, and a camera ray of its camera.
/// Gives: the primitive that the exact tests give, or that nothing is hit, or that float does not suffice. Of a box
///        also the axis of the face that the ray enters.
/// Method: as in hit_interval.h, with intervals of the parameter t |d|^2 and without a unit direction. A solid that may
///         or may not be hit, an overlap of the two nearest, and an edge of a box are left undecided.
/// Bounds: u = 2^-24, f = origin - centre, rounded to float.
///         Sphere: b = -f . d errs by 4 u |f| |d|, so b^2 errs by 8 u |f|^2 |d|^2; c |d|^2, with c < |f|^2, errs by
///         6 u |f|^2 |d|^2. So the discriminant b^2 - c |d|^2 errs by less than e = 24 u |f|^2 |d|^2 (`margin`, which
///         covers the rounding of e too). Above 4 e its sign is certain, and its root errs by less than e / root and
///         6 u |f| |d|. With b and the difference, the parameter errs by less than e / root + 16 u |f| |d| (`slack`).
///         The origin is outside the sphere, so b > 0 says that the sphere is ahead.
///         Box: quotients err by 8 u of themselves; the comparisons allow 33 u of both ends. NaN and infinity, from a
///         direction along an axis, make a box unsure, or a miss that holds.
/// Tested by tests/kernel/certain_light_test.cpp.
#pragma once

#include "tandem/kernel/shapes/filter.h"
#include "tandem/kernel/traversal/certain_view.h"
#include "tandem/math/rough.h"

namespace tandem {

struct CertainHit {
    static constexpr std::uint32_t none = 0xFF, unsure = 0xFE;
    std::uint32_t slot;  ///< i for sphere i, max_spheres + i for box i; or none, or unsure
    std::uint32_t axis;  ///< of the face of a box
};

namespace certain_detail {

/// One of the intervals so far, and the least lower end of the others: if the interval ends before that, its hit is the
/// nearest.
struct Nearest {
    static constexpr float infinity = __builtin_huge_valf();

    CertainHit hit = {CertainHit::none, 0};
    float begin = infinity, end = infinity;
    float next = infinity;

    /// `sure`: the solid is hit, within [from, to]; else the interval is [0, infinity], which overlaps all others.
    TANDEM_HD_INLINE void offer(bool sure, float from, float to, std::uint32_t slot, std::uint32_t axis) {
        from = sure ? from : 0.0F;
        to = sure ? to : infinity;
        const bool nearer = from < end;
        next = rough_lesser(next, nearer ? begin : from);
        hit.slot = nearer ? slot : hit.slot;
        hit.axis = nearer ? axis : hit.axis;
        begin = nearer ? from : begin;
        end = nearer ? to : end;
    }
    [[nodiscard]] TANDEM_HD_INLINE CertainHit result() const {
        const bool is_open = hit.slot != CertainHit::none && !(end < next);
        return {is_open ? CertainHit::unsure : hit.slot, hit.axis};
    }
};

TANDEM_HD_INLINE void meet(const CertainSphere& sphere, std::uint32_t slot, const Vec3f& d, float d2,
                           Nearest& nearest) {
    const float b = -loose_dot(sphere.rough_offset, d);
    const float discriminant = loose_multiply_add(b, b, -(sphere.rough_c * d2));
    const float e = sphere.margin * d2;
    if (discriminant < -e || b < -sphere.slack) return;
    const bool sure = discriminant > 4.0F * e && b > sphere.slack;
    const float inverse_root = rough_inverse_square_root(discriminant);
    const float t = loose_multiply_add(-discriminant, inverse_root, b);
    const float error = loose_multiply_add(e, inverse_root, sphere.slack);
    nearest.offer(sure, t - error, t + error, slot, 0);
}

TANDEM_HD_INLINE void meet(const CertainBox& box, std::uint32_t slot, const Vec3f& inverse, float d2,
                           Nearest& nearest) {
    const Vec3f a = box.rough_lower * inverse, b = box.rough_upper * inverse;
    const Vec3f in = {rough_lesser(a.x, b.x), rough_lesser(a.y, b.y), rough_lesser(a.z, b.z)};
    const Vec3f out = {rough_greater(a.x, b.x), rough_greater(a.y, b.y), rough_greater(a.z, b.z)};
    const float near = rough_greater(rough_greater(in.x, in.y), in.z);
    const float far = rough_lesser(rough_lesser(out.x, out.y), out.z);
    const float error = 33.0F * float_roundoff * (absolute(near) + absolute(far));
    if (near > far + error || far < -error) return;
    const std::uint32_t axis = near == in.x ? 0U : near == in.y ? 1U : 2U;
    const float second = rough_greater(axis == 0 ? in.y : in.x, axis == 2 ? in.y : in.z);
    const bool sure = near < far - error && near > error && second < near - error;
    nearest.offer(sure, (near - error) * d2, (near + error) * d2, slot, axis);
}

}  // namespace certain_detail

/// `slots`: the solids that the ray may hit, as in ConstantMemoryStructure; preferably the same for all threads of a
/// warp. `among_few`: they are in few_slots.
template <bool among_few = false>
TANDEM_HD_INLINE CertainHit certain_hit(const CertainView& view, const Vec3f& direction, std::uint32_t slots) {
    constexpr std::uint32_t all_spheres = (1U << CertainView::max_spheres) - 1;
    constexpr std::uint32_t spheres = among_few ? CertainView::few_spheres : CertainView::max_spheres;
    constexpr std::uint32_t boxes = among_few ? CertainView::few_boxes : CertainView::max_boxes;
    slots &= view.slots;
    certain_detail::Nearest nearest;
    const float d2 = loose_dot(direction, direction);
#if TANDEM_ON_DEVICE
#pragma unroll
#endif
    for (std::uint32_t i = 0; i < spheres; ++i) {
        // checks for the end only now and then, because the check costs as much as a slot
        if (!among_few && i % 4 == 0 && (slots & (all_spheres << i & all_spheres)) == 0) break;
        if ((slots >> i & 1U) != 0) certain_detail::meet(view.spheres[i], i, direction, d2, nearest);
    }
    if ((slots >> CertainView::max_spheres) != 0) {
        const Vec3f inverse = {rough_reciprocal(direction.x), rough_reciprocal(direction.y),
                               rough_reciprocal(direction.z)};
#if TANDEM_ON_DEVICE
#pragma unroll
#endif
        for (std::uint32_t i = 0; i < boxes; ++i) {
            const std::uint32_t slot = CertainView::max_spheres + i;
            // with a single slot, the test above has found its box
            if (boxes == 1 || (slots >> slot & 1U) != 0) {
                certain_detail::meet(view.boxes[i], slot, inverse, d2, nearest);
            }
        }
    }
    return nearest.result();
}

}  // namespace tandem
