/// The query ray of a proposal as the bounds of hits need it.
#pragma once

#include "tandem/kernel/shapes/filter.h"
#include "tandem/kernel/traversal/proposal.h"

namespace tandem {

/// A ray in float with a unit direction. The query parameter of a hit at t is s = (t - t_offset) |d|, with the length
/// of the true direction; it grows with t. Proposal::limit() and start() bound it.
///
/// With u = 2^-24, every component of the direction is within 2 u of its own size of a line in the true direction, up
/// to a common factor within 6 u of 1. So the point at s is within 9 u s of the true one.
/// `drift` bounds the distance of the origin from the true one, and the change of s by the rounding of t and t_offset
/// in double: 8 u S + 3 u t_offset * length for an origin that was moved, where S is the reach of the scene's bounds
/// (the rounding of the origin is sqrt(3) u S; t errs by 2^-26 of itself at most); 2 u S where an origin in double was
/// rounded; for others 1e-30, so that no margin underflows.
template <class F>
struct QueryRayOf {
    Vec3<F> origin;
    Vec3<F> direction;
    F drift;
    // for a ray that passes alpha masks: bounds of the query parameter of its last masked hit
    F start = F(0.0F);   ///< not above it
    F passed = F(0.0F);  ///< not below it
};
/// One ray.
using QueryRay = QueryRayOf<float>;

/// Needs proposal.active. `source`: of any type that test_primitive() takes.
template <class Real, class From>
TANDEM_HD_INLINE QueryRayOf<Float<Real>> make_query_ray(const Proposal<Real>& proposal, const StructureFrame& frame,
                                                        const From& source) {
    using F = Float<Real>;
    using D = Double<Real>;
    constexpr bool is_rounded = std::is_same_v<Scalar<Real>, double>;
    const float unit = float_roundoff * reach(frame.bounds);
    F drift(is_rounded ? 2.0F * unit + 1e-30F : 1e-30F);
    const Mask<Real> is_moved = proposal.t_offset > D(0.0);
    if (any(is_moved)) {
        const F moved_by = narrow(proposal.t_offset * widen(proposal.length));
        drift = select(is_moved, F(8.0F * unit) + F(3.0F * float_roundoff) * moved_by + F(1e-30F), drift);
    }
    QueryRayOf<F> query = {proposal.ray.origin, proposal.ray.direction, drift};
    if constexpr (std::is_base_of_v<Source<Real>, From>) {
        // a ray never misses the solid that it leaves inward, and the filter allows for this error of its origin
        if (any(source.inside)) {
            query.drift = select(source.inside, drift + F(filter_margin) * norm1(query.origin), drift);
        }
    }
    if constexpr (std::is_same_v<From, PathSource<Real>>) {
        const Mask<Real> has_passed = source.last_masked.t > D(0.0);
        if (any(has_passed)) [[unlikely]] {
            query.start = select(has_passed, proposal.start(source.last_masked.t), query.start);
            query.passed = select(has_passed, greater(proposal.limit(source.last_masked.t), F(1e-30F)), query.passed);
        }
    }
    return query;
}

}  // namespace tandem
