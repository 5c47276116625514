/// propose() for one ray in float, without divisions and roots: the set-up of a ray costs as much as visiting some
/// nodes.
///
/// Bound, with u = 2^-24: the square of the length errs by 3 u, its inverse root by 4 u more, and the products round
/// once. So every component of the direction is within u of its own size of a line in the true direction, up to a
/// common factor within 6 u of 1, and the length is within 9 u. In t the common factor cancels: a crossing of the
/// bounds errs by 4 u because of the reciprocal, and by 6 u because of roundings. So the margin is 16 u where the ray
/// is moved, and 32 u where near and far are compared. The moved origin is rounded once, and the entry is at most 26 u
/// * 8193 S < 2^-6 S before the bounds.
#pragma once

#include "tandem/kernel/traversal/node_ray.h"
#include "tandem/kernel/traversal/proposal.h"

namespace tandem {

namespace proposal_detail {

/// Out of line: for the few rays that start very far away, or whose direction is very short.
TANDEM_HD_CALL Proposal<float> propose_slowly(Ray<float> ray, StructureFrame frame) {
    return propose(ray, frame, true);
}

/// The power of two that brings a normal float into [1, 2), and its inverse.
struct Scaling {
    float down, up;
};
TANDEM_HD_INLINE Scaling scaling_of(float largest) {
    const std::uint32_t exponent = bits_of(largest) & 0x7F800000U;
    return {float_of(0x7F000000U - exponent), float_of(exponent)};
}

}  // namespace proposal_detail

/// Needs a traceable ray. As propose().
TANDEM_HD_INLINE Proposal<float> propose_quickly(const Ray<float>& ray, const StructureFrame& frame) {
    using namespace proposal_detail;
    const Vec3f& o = ray.origin;
    const Vec3f& d = ray.direction;
    const float largest = rough_greater(rough_greater(absolute(d.x), absolute(d.y)), absolute(d.z));
    const float out = rough_greater(rough_greater(absolute(o.x), absolute(o.y)), absolute(o.z));
    const float limit = reach(frame.bounds);
    if (largest < least_length || out > near_by * limit) [[unlikely]] {
        return propose_slowly(ray, frame);
    }
    const auto [down, up] = scaling_of(largest);
    const Vec3f scaled = d * down;
    const float length2 = loose_dot(scaled, scaled);
    const float inverse_length = rough_inverse_square_root(length2);
    Proposal<float> proposal;
    proposal.ray = {o, scaled * inverse_length};
    proposal.length = length2 * inverse_length * up;
    proposal.t_offset = 0.0;
    proposal.active = true;
    if (out > limit) {
        const Vec3f inverse = make_node_ray(o, proposal.ray.direction).inverse_direction;
        float near = -3e38F, far = 3e38F;
        const auto slab = [&](float lower, float upper, float origin, float over) {
            const float a = (lower - origin) * over, b = (upper - origin) * over;
            near = rough_greater(near, rough_lesser(a, b));
            far = rough_lesser(far, rough_greater(a, b));
        };
        slab(frame.bounds.lower.x, frame.bounds.upper.x, o.x, inverse.x);
        slab(frame.bounds.lower.y, frame.bounds.upper.y, o.y, inverse.y);
        slab(frame.bounds.lower.z, frame.bounds.upper.z, o.z, inverse.z);
        proposal.active = near <= far * (1.0F + 32.0F * float_roundoff) && far > 0.0F;
        if (near > 0.0F) {
            const float t = near * (1.0F - 16.0F * float_roundoff) * (inverse_length * down);
            proposal.t_offset = widen(t);
            proposal.ray.origin = narrow(widen(o) + widen(d) * proposal.t_offset);  // whose products are exact
        }
    }
    return proposal;
}

}  // namespace tandem
