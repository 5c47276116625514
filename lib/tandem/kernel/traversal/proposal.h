/// Proposals: the queries of rays to an acceleration structure. The structure only returns candidates; the tests of
/// primitives decide, with the original ray. So that no candidate is lost, the boxes are padded, and the query ray is
/// moved to where float is accurate: near the scene, with a unit direction.
///
/// Bound, with u = 2^-24 and S = reach of the scene's bounds, by BoxErrors:
///   of_scene     A slab test b * rcp - o * rcp with approximate reciprocals (Embree's) moves the planes by at most
///                13 u S when |o| <= S. Moving the origin adds 2 u S (it may end up to 2^-6 S beyond S), rounding it
///                1 u S, and rounding the direction 3 u S along a path of length 2 S. Boxes are padded by 32 u S.
///   of_distance  A slab test (b - o) * rcp errs by a part of the distance b - o along the axis: node_ray.h by 8 u. A
///                component of the direction errs by 2 u of itself, up to a factor that all have in common. One of the
///                origin is rounded by u |o| <= u |b| + u |b - o|, and before that misses by 2^-39 S if the origin was
///                moved; a component of the direction that is too small to invert is replaced, which moves the ray by
///                2^-57 S. So boxes are padded by 2^-38 S and 32 u of their own reach, where u would do, and the test
///                lets the exit grow by the rest, 22 u of itself. (Embree has such a test, but not for user geometry.)
/// Decisions give a t that errs by 2^-26 of itself at most, which is many times S for a ray from far enough away. So
/// the ends of a query allow for 2^-25 of t. Tested by tests/agree/structure_test.cpp; where a query starts, and its
/// ends, by tests/kernel/traversal/proposal_test.cpp.
#pragma once

#include "tandem/kernel/shapes/ray_source.h"
#include "tandem/math/lengths.h"

namespace tandem {

/// What the rounding errors of a structure's box tests are relative to: the reach of the scene, or the distance of the
/// box. If they are relative to the scene, boxes of primitives that are far smaller than the scene overlap.
enum class BoxErrors { of_scene, of_distance };

/// How far boxes are moved outward.
struct Padding {
    float least;            ///< metres
    float of_reach = 0.0F;  ///< times the reach of the box, in addition
};
TANDEM_HD_INLINE Aabb pad(const Aabb& box, const Padding& padding) {
    return pad(box, padding.least + padding.of_reach * reach(box));
}

/// The domain of an acceleration structure: its bounds, and the padding of its boxes.
struct StructureFrame {
    Aabb bounds;  ///< of all primitives, padded
    Padding padding;
};

/// `scene_bounds`: merged bounds of all primitives, not padded.
TANDEM_HD_INLINE StructureFrame make_structure_frame(const Aabb& scene_bounds, BoxErrors errors = BoxErrors::of_scene) {
    constexpr float share = 32.0F * float_roundoff;
    const float size = reach(scene_bounds);
    // the term 1e-30 keeps the padding a normal number, so that flush-to-zero inside Embree does not remove it
    const float whole = share * size + 1e-30F;
    const Padding padding = errors == BoxErrors::of_scene ? Padding{whole} : Padding{0x1p-38F * size + 1e-30F, share};
    return {pad(scene_bounds, 2.0F * whole), padding};
}

/// The query ray: parameter s = (t - t_offset) * length along a unit direction.
template <class Real>
struct Proposal {
    Ray<Float<Real>> ray;
    Real length;
    Double<Real> t_offset;
    Mask<Real> active;  ///< lanes whose ray may hit the bounds

    /// A float not below the query parameter of t: traversal may stop there.
    TANDEM_HD_INLINE Float<Real> limit(const Double<Real>& t) const {
        using D = Double<Real>;
        const D after = t * constant<D>(1.0 + error_of_t);
        const D s = (after - t_offset) * length_within(1.0) * constant<D>(1.0 + 0x1p-18);
        const D most = constant<D>(3e38);
        return narrow(select(s < most, s, most));
    }

    /// A float in [0, query parameter of t], the largest for an infinite t: traversal may start there for a ray whose
    /// last masked hit is at t, and may stop at a certain hit before it if any hit before t will do.
    TANDEM_HD_INLINE Float<Real> start(const Double<Real>& t) const {
        using D = Double<Real>;
        const D zero(0.0);
        const D before = t * constant<D>(1.0 - error_of_t);
        const D s = (before - t_offset) * length_within(-1.0) * constant<D>(1.0 - 0x1p-18);
        const D most = constant<D>(3e38);
        return narrow(select(s > zero, select(s < most, s, most), zero));
    }
    template <class From>
    TANDEM_HD_INLINE Float<Real> start_for(const From& source) const {
        if constexpr (std::is_base_of_v<PathSource<Real>, From>) {
            if (any(source.last_masked.t > Double<Real>(0.0))) [[unlikely]]
                return start(source.last_masked.t);
        }
        return Float<Real>(0.0F);
    }

    /// The approximate t of a hit that the structure itself found at s; the rounding of t_offset remains.
    TANDEM_HD_INLINE Double<Real> parameter(const Float<Real>& s) const { return widen(s) / widen(length) + t_offset; }

  private:
    /// Relative; twice that of decisions. In the tier fast not a bound.
    static constexpr double error_of_t = is_fast<Real> ? 0x1p-20 : 0x1p-25;

    /// `length` plus `sign` times the largest error of a subnormal length in float. A normal one errs by a few 2^-24 of
    /// itself, which the callers allow for.
    TANDEM_HD_INLINE Double<Real> length_within(double sign) const {
        if constexpr (is_fast<Real>) return widen(length);
        return widen(length) + constant<Double<Real>>(sign * 0x1p-149);
    }
};

/// proposal.limit(t) of one ray, without an operation where t is known to be infinite.
template <class Real>
TANDEM_HD_INLINE float first_limit(const Proposal<Real>& proposal, const Double<Real>& t) {
    return t < Double<Real>(__builtin_huge_val()) ? to_plain(proposal.limit(t)) : 3e38F;
}

namespace proposal_detail {

/// Limits for rays that are moved to the bounds in float: the largest coordinate of the origin, relative to the reach
/// of the bounds, and the least length of the direction. With a shorter direction the t of the bounds may overflow.
inline constexpr float near_by = 8192;
inline constexpr float least_length = 1e-15F;

/// The crossing of the bounds for rays that start outside. In float for origins `near_by`: the error of each t is below
/// 4 u t, and the margin is 16 u t. So no ray that may hit anything is lost, and the entry is at most 2^-6 of the reach
/// before the bounds, never behind them.
template <class Real>
TANDEM_HD_INLINE Crossing<Real> cross_bounds(const Aabb& bounds, const Ray<Real>& ray, bool is_near_by) {
    // A CPU divides twice as many floats as doubles at a time, and this runs for every camera ray. GPUs use double;
    // float has not been timed there. Rays in double are not narrowed.
    constexpr bool in_float = !TANDEM_ON_DEVICE && std::is_same_v<Scalar<Real>, float>;
    if (!in_float || !is_near_by) return cross_box(Box{bounds.lower, bounds.upper}, ray);
    const Real infinity(__builtin_huge_valf());
    Real t_near = -infinity, t_far = infinity;
    const auto slab = [&](float lower, float upper, const Real& o, const Real& d) {
        // d = 0 gives infinities with the right signs, or NaN exactly on the padded bounds, where there is no primitive
        const Real a = (Real(lower) - o) / d;
        const Real b = (Real(upper) - o) / d;
        t_near = greater(lesser(a, b), t_near);
        t_far = lesser(greater(a, b), t_far);
    };
    slab(bounds.lower.x, bounds.upper.x, ray.origin.x, ray.direction.x);
    slab(bounds.lower.y, bounds.upper.y, ray.origin.y, ray.direction.y);
    slab(bounds.lower.z, bounds.upper.z, ray.origin.z, ray.direction.z);
    const Real rounding(16.0F * float_roundoff);
    const Real one(1.0F);
    return {t_near <= t_far * (one + rounding), widen(t_near * (one - rounding)), widen(t_far)};
}

/// Whether a ray starts too far away, or is too short, to be moved to the bounds in one step.
template <class Real>
TANDEM_HD_INLINE Mask<Real> is_remote(const Ray<Real>& ray, const Aabb& bounds) {
    return max_norm(ray.origin) > Real(near_by * reach(bounds)) || max_norm(ray.direction) < Real(least_length);
}

/// A point of a ray, and its rounded parameter.
template <class Real>
struct RayPoint {
    Vec3<Double<Real>> point;
    Double<Real> t;
};

/// Moves a ray to the bounds, in the lanes of `active`, from so far away that one step in double would miss them: at
/// most 2^-6 of the reach before the bounds, and never behind them.
/// A step has 24 bits and ends before the bounds, by 2^-22 of the way. For a ray in float its products are then exact,
/// and so is the sum if it cancels: it is a multiple of the unit of both terms, and below 2^-22 of them.
template <class Real>
TANDEM_HD_CALL RayPoint<Real> approach(Aabb bounds, Vec3<Double<Real>> origin, Vec3<Double<Real>> direction,
                                       Mask<Real> active) {
    using D = Double<Real>;
    constexpr int most_steps = 9;  // from 1e18 to a scene of 1e-30, the least padding, and one to spare
    const Vec3<D> lower = broadcast<D>(bounds.lower), upper = broadcast<D>(bounds.upper);
    RayPoint<Real> entry = {origin, D(0.0)};
    TANDEM_KEEP_LOOP
    for (int i = 0; i < most_steps; ++i) {
        const D ahead = cross_box<Real>(lower, upper, entry.point, direction).t_near * D(1.0 - 0x1p-22);
        const D split = ahead * D(0x1p29 + 1.0);
        const D step = select(active && ahead > D(0.0), split - (split - ahead), D(0.0));
        // a ray in double has more bits: with these sums it still starts within 2^-39 of the reach if it comes from
        // within 2^34 times the reach
        entry.point = {multiply_add(step, direction.x, entry.point.x), multiply_add(step, direction.y, entry.point.y),
                       multiply_add(step, direction.z, entry.point.z)};
        entry.t = entry.t + step;
    }
    return entry;
}

}  // namespace proposal_detail

/// Needs traceable rays in the lanes of `active` (is_traceable()).
template <class Real>
TANDEM_HD_INLINE Proposal<Real> propose(const Ray<Real>& ray, const StructureFrame& frame, const Mask<Real>& active) {
    using D = Double<Real>;
    const Real largest = select(active, max_norm(ray.direction), Real(1.0F));
    const Vec3<Real> scaled = {ray.direction.x / largest, ray.direction.y / largest, ray.direction.z / largest};
    const Real scaled_length = square_root(dot(scaled, scaled));
    const Real inverse_length = Real(1.0F) / scaled_length;
    Proposal<Real> proposal;
    proposal.ray.direction =
        narrow(Vec3<Real>{scaled.x * inverse_length, scaled.y * inverse_length, scaled.z * inverse_length});
    proposal.length = largest * scaled_length;
    proposal.ray.origin = narrow(ray.origin);
    proposal.t_offset = D(0.0);
    proposal.active = active;
    const Mask<Real> outside = active && max_norm(ray.origin) > Real(reach(frame.bounds));
    if (any(outside)) {
        const bool is_near_by = !any(active && proposal_detail::is_remote(ray, frame.bounds));
        const Crossing<Real> c = proposal_detail::cross_bounds(frame.bounds, ray, is_near_by);
        const D zero(0.0);
        // in the tier fast t may overflow to infinity: the bounds are too far away
        const Mask<Real> in_reach = c.t_near < D(__builtin_huge_val());
        proposal.active = active && (!outside || (c.crosses && c.t_far > zero && in_reach));
        const Mask<Real> move = outside && proposal.active && c.t_near > zero;
        const Vec3<D> origin = widen(ray.origin), direction = widen(ray.direction);
        proposal_detail::RayPoint<Real> entry = {origin + direction * c.t_near, c.t_near};
        if constexpr (!is_fast<Real>) {
            if (!is_near_by) entry = proposal_detail::approach<Real>(frame.bounds, origin, direction, move);
        }
        proposal.t_offset = select(move, entry.t, zero);
        proposal.ray.origin = select(move, narrow(entry.point), proposal.ray.origin);
    }
    return proposal;
}

/// The origin of a proposal's ray before it was rounded to float: within 2^-39 S of the true ray.
template <class Real>
requires(!is_fast<Real>) TANDEM_HD_INLINE Vec3<Double<Real>> unrounded_origin(const Ray<Real>& ray,
                                                                              const StructureFrame& frame,
                                                                              const Proposal<Real>& proposal) {
    const Vec3<Double<Real>> origin = widen(ray.origin), direction = widen(ray.direction);
    const Mask<Real> is_moved = proposal.t_offset > Double<Real>(0.0);
    if (any(is_moved && proposal_detail::is_remote(ray, frame.bounds))) {
        return proposal_detail::approach<Real>(frame.bounds, origin, direction, is_moved).point;
    }
    return origin + direction * proposal.t_offset;
}

}  // namespace tandem
