/// Rays that leave surfaces. No offset and no minimum t keeps such a ray off the surface that it starts on. Instead it
/// carries its source: the primitive and the side. Each kind of primitive handles it. Correct at every scale, however
/// near the next surface is (docs/numerics.md).
///
/// Closed convex solids (sphere, box, ellipsoid, parallelepiped): a ray that leaves outward cannot hit its solid again;
/// one that leaves inward always hits the far side, so that it is never lost inside. A ray that leaves a face cannot
/// hit it again. A new kind of solid adds one overload of first_or_far().
#pragma once

#include "tandem/kernel/shapes/affine.h"
#include "tandem/kernel/shapes/hit.h"
#include "tandem/kernel/shapes/quad.h"

namespace tandem {

/// The source of a ray. A ray that starts in space has no_primitive.
template <class Real>
struct Source {
    UInt<Real> primitive = UInt<Real>(no_primitive);
    Mask<Real> inside = Mask<Real>(false);  ///< it leaves inward: its direction against the outward normal is negative
};
using RaySource = Source<float>;

/// A caller's source as the kernels of a tier take it. `Real` of one lane.
template <class Real>
TANDEM_HD Source<Real> to_real(const RaySource& source) {
    return {source.primitive, source.inside};
}

/// A source for rays that leave no surface, such as camera rays: the code for sources is then not even compiled.
struct NoSource {};

/// For rays that continue through alpha masks: the source, and the last masked hit that the ray has passed. The ray
/// keeps its origin, and hits count only if they come after that one in the order of hits, by t and then by id. So a
/// surface in the plane of a masked one, at the same t, is still hit.
template <class Real>
struct PathSource : Source<Real> {
    Closest<Real> passed = {Double<Real>(0.0), UInt<Real>(no_primitive)};
};

/// Does a hit count for a ray that has passed masked hits?
template <class Real>
TANDEM_HD Mask<Real> is_beyond(const Closest<Real>& passed, const Double<Real>& t, const UInt<Real>& primitive) {
    return t > passed.t || (t == passed.t && primitive > passed.primitive);
}

/// The source and the target of a shadow ray: hits on the light's own primitive do not count.
template <class Real>
struct ShadowSource : Source<Real> {
    UInt<Real> light = UInt<Real>(no_primitive);
};

namespace source_detail {

/// The far crossing of a ray that goes inward is in front of it; where rounding has put the origin behind the surface
/// it would not be, and comes at once.
template <class Real>
TANDEM_HD Double<Real> in_front(const Double<Real>& t) {
    return greater(t, constant<Double<Real>>(is_fast<Real> ? 0x1p-126 : 0x1p-1022));
}

template <class Real>
TANDEM_HD Double<Real> far_crossing(const SphereRoots<Real>& roots) {
    using D = Double<Real>;
    // A line that misses the sphere because rounding has put the origin outside: the point nearest to it.
    const Mask<Real> by_product = roots.crosses && roots.b < D(0.0);
    const D numerator = select(by_product, roots.c, select(roots.crosses, roots.q, roots.b));
    const D denominator = select(by_product, roots.q, roots.a);
    return in_front<Real>(numerator / denominator);
}

}  // namespace source_detail

// The first point in front of a ray or, in the lanes of `own`, where a ray that leaves the same solid inward hits it
// again; in the lanes of `active`. t is within 1 ulp of float of where the line through the ray enters or leaves the
// solid. The root at the origin is not computed, so that the two need not be told apart.

template <class Real>
TANDEM_HD Mask<Real> first_or_far(const SphereRoots<Real>& roots, const Mask<Real>& own, Double<Real>& t) {
    const Mask<Real> hit = first_in_front(roots, t);
    t = select(own, source_detail::far_crossing(roots), t);
    return hit || own;
}
template <class Real>
TANDEM_HD Mask<Real> first_or_far(const BoxCrossing<Real>& crossing, const Mask<Real>& own, Double<Real>& t) {
    const Mask<Real> hit = first_in_front<Real>(crossing, t);
    t = select(own, source_detail::in_front<Real>(crossing.t_far), t);
    return hit || own;
}

template <class Real>
TANDEM_HD Mask<Real> first_or_far(const Sphere& sphere, const Ray<Real>& ray, const Mask<Real>& own,
                                  const Mask<Real>& active, Double<Real>& t) {
    return active && first_or_far(sphere_roots<Real>(sphere, ray, {active, own}), own, t);
}
template <class Real>
TANDEM_HD Mask<Real> first_or_far(const Box& box, const Ray<Real>& ray, const Mask<Real>& own, const Mask<Real>& active,
                                  Double<Real>& t) {
    return active && first_or_far(cross_box(box, ray), own, t);
}
template <class Real>
TANDEM_HD Mask<Real> first_or_far(const Ellipsoid& body, const Ray<Real>& ray, const Mask<Real>& own,
                                  const Mask<Real>& active, Double<Real>& t) {
    return active && first_or_far(ellipsoid_roots<Real>(body, ray, {active, own}), own, t);
}
template <class Real>
TANDEM_HD Mask<Real> first_or_far(const Parallelepiped& body, const Ray<Real>& ray, const Mask<Real>& own,
                                  const Mask<Real>& active, Double<Real>& t) {
    return active && first_or_far(cross_parallelepiped(to_object(body, ray)), own, t);
}

template <class Primitive>
inline constexpr bool is_face = std::is_same_v<Primitive, Triangle> || std::is_same_v<Primitive, Quad>;

/// Which rays can hit primitive `id`, unless it is certainly `behind` them? Not those that have left it outward, or
/// left a face.
template <class Real, class Primitive>
TANDEM_HD Mask<Real> can_meet(const Source<Real>& source, std::uint32_t id, const Mask<Real>& behind) {
    const Mask<Real> own = source.primitive == UInt<Real>(id);
    if constexpr (is_face<Primitive>) return !own && !behind;
    return select(own, source.inside, !behind);
}
/// A triangle is not met again behind a hole in it.
template <class Real, class Primitive>
TANDEM_HD Mask<Real> can_meet(const PathSource<Real>& source, std::uint32_t id, const Mask<Real>& behind) {
    const Source<Real>& surface = source;
    const Mask<Real> meets = can_meet<Real, Primitive>(surface, id, behind);
    if constexpr (!std::is_same_v<Primitive, Triangle>) return meets;
    return meets && source.passed.primitive != UInt<Real>(id);
}
template <class Real, class Primitive>
TANDEM_HD Mask<Real> can_meet(NoSource, std::uint32_t, const Mask<Real>& behind) {
    return !behind;
}

/// Where is a hit on primitive `id` the far side of the solid that the ray left inward?
template <class Real>
TANDEM_HD Mask<Real> leaves_inward(const Source<Real>& source, std::uint32_t id) {
    return source.inside && source.primitive == UInt<Real>(id);
}
template <class Real>
TANDEM_HD Mask<Real> leaves_inward(NoSource, std::uint32_t) {
    return Mask<Real>(false);
}

/// Is a hit at `t` on primitive `id` on its far side? It is where the ray left the primitive inward, and where the ray
/// has passed a masked hit of the solid on its near side.
template <class Real, class Primitive>
TANDEM_HD Mask<Real> is_far_side(const PathSource<Real>& source, const Primitive& primitive, std::uint32_t id,
                                 const Ray<Real>& ray, const Double<Real>& t, const Mask<Real>& here) {
    Mask<Real> far = leaves_inward<Real>(source, id);
    if constexpr (!is_face<Primitive>) {
        const Mask<Real> passed = here && !far && source.passed.t > Double<Real>(0.0);
        if (any(passed)) [[unlikely]] {
            Double<Real> first(0.0);
            far = far || (first_in_front(primitive, ray, first, passed) && passed && t > first);
        }
    }
    return far;
}

/// The first point of primitive `id` in front of a ray that comes from `source`, in the lanes of `active`. A point of a
/// face beyond `farthest` may be left out.
template <class Real, class Primitive>
TANDEM_HD Mask<Real> first_from(NoSource, const Primitive& primitive, std::uint32_t, const Ray<Real>& ray,
                                const Mask<Real>& active, const Double<Real>& farthest, Double<Real>& t) {
    if constexpr (is_face<Primitive>) {
        return first_in_front(primitive, ray, t, active, farthest);
    } else {
        return first_in_front(primitive, ray, t, active);
    }
}

// A ray does not hit again what it leaves outward, nor a face on either side, nor a quad, even a folded one. This comes
// first: at the origin of the ray only exact arithmetic could decide.
template <class Real, class Primitive>
TANDEM_HD Mask<Real> first_from(const Source<Real>& source, const Primitive& primitive, std::uint32_t id,
                                const Ray<Real>& ray, const Mask<Real>& active, const Double<Real>& farthest,
                                Double<Real>& t) {
    const Mask<Real> own = source.primitive == UInt<Real>(id);
    if constexpr (is_face<Primitive>) {
        return first_in_front(primitive, ray, t, active && !own, farthest);
    } else {
        const Mask<Real> meets = active && (!own || source.inside);
        if (!any(meets)) return meets;
        return first_or_far(primitive, ray, own, meets, t);
    }
}

namespace source_detail {

// Where a ray crosses a body that it does not start on for the second time; 0 if it does not. A call, since this is
// rare: a ray must pass a masked hit on a body and hit the same body again.
template <class Real, class Body>
TANDEM_HD_CALL Double<Real> second_crossing(Body body, Ray<Real> ray, Mask<Real> active) {
    Double<Real> t(0.0);
    (void)first_or_far(body, ray, active, active, t);
    return t;
}

}  // namespace source_detail

// A ray may hit a primitive again that it hit before the last masked hit: a solid where it leaves it, a folded quad at
// its other half. `culls`: a culled face may be passed from behind.
template <class Real, class Primitive>
TANDEM_HD Mask<Real> first_from(const PathSource<Real>& source, const Primitive& primitive, std::uint32_t id,
                                const Ray<Real>& ray, const Mask<Real>& active, const Double<Real>& farthest,
                                Double<Real>& t, bool culls) {
    const UInt<Real> number(id);
    const Source<Real>& surface = source;
    if constexpr (is_face<Primitive>) {
        culls = culls && primitive.attributes.sides == FaceSides::culled;
        const auto counts = [&](Mask<Real> hit, const Double<Real>& at, const Vec3f& b,
                                const Vec3f& c) TANDEM_INLINE_LAMBDA {
            hit = hit && is_beyond<Real>(source.passed, at, number);
            if (culls && any(hit)) hit = hit && !comes_from_behind(ray, geometric_normal<Real>(primitive.v0, b, c));
            return hit;
        };
        if constexpr (std::is_same_v<Primitive, Quad>) {
            return first_that_counts(primitive, ray, t, active && source.primitive != number, farthest, counts);
        } else {
            const Mask<Real> hit = first_from(surface, primitive, id, ray, active, farthest, t);
            if (!culls && !any(source.passed.t > Double<Real>(0.0))) [[likely]]
                return hit;
            return counts(hit, t, primitive.v1, primitive.v2);
        }
    } else {
        Mask<Real> hit = first_from(surface, primitive, id, ray, active, farthest, t);
        if (!any(source.passed.t > Double<Real>(0.0))) [[likely]]
            return hit;
        const auto before = hit && source.passed.t > Double<Real>(0.0) && !is_beyond<Real>(source.passed, t, number);
        if (any(before)) {
            t = select(before, source_detail::second_crossing<Real>(primitive, ray, before), t);
            hit = hit && (!before || is_beyond<Real>(source.passed, t, number));
        }
        return hit;
    }
}

template <class Real, class Primitive>
TANDEM_HD Mask<Real> first_from(const ShadowSource<Real>& source, const Primitive& primitive, std::uint32_t id,
                                const Ray<Real>& ray, const Mask<Real>& active, const Double<Real>& farthest,
                                Double<Real>& t) {
    const Source<Real>& surface = source;
    return first_from(surface, primitive, id, ray, active && source.light != UInt<Real>(id), farthest, t);
}

}  // namespace tandem
