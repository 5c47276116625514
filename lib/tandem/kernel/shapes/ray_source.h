/// Rays that leave surfaces. Neither an offset nor a minimum t prevents self-intersection. Instead a ray carries its
/// source, the primitive and the side, and each kind of primitive handles it. This is correct at every scale, however
/// near the next surface is (docs/numerics.md).
///
/// Closed convex solids (sphere, box, ellipsoid, parallelepiped): a ray that leaves outward cannot hit its solid again;
/// one that leaves inward always hits the far side, so it never leaks. A ray that leaves a face cannot hit it again. A
/// new kind of solid needs one overload of first_hit_or_exit().
#pragma once

#include "tandem/kernel/shapes/affine.h"
#include "tandem/kernel/shapes/hit.h"
#include "tandem/kernel/shapes/quad.h"
#include "tandem/kernel/shapes/source.h"

namespace tandem {

/// Converts a caller's source to the types of a tier. `Real` of one lane.
template <class Real>
TANDEM_HD_INLINE Source<Real> to_real(const RaySource& source) {
    return {source.primitive, source.inside};
}

/// The source of rays that leave no surface, such as camera rays. No code for sources is compiled for it.
struct NoSource {};

/// For rays that continue through alpha masks: the source, and the last masked hit. The ray keeps its origin, and only
/// hits after the masked one count, in the order of t and then id. So a surface in the plane of a masked one, at the
/// same t, is still hit.
template <class Real>
struct PathSource : Source<Real> {
    Closest<Real> last_masked = {Double<Real>(0.0), UInt<Real>(no_primitive)};
};

/// Whether a hit comes after the last masked hit, and so counts.
template <class Real>
TANDEM_HD_INLINE Mask<Real> is_beyond(const Closest<Real>& last_masked, const Double<Real>& t,
                                      const UInt<Real>& primitive) {
    return t > last_masked.t || (t == last_masked.t && primitive > last_masked.primitive);
}

/// The source and the target of a shadow ray: hits on the light's own primitive do not count.
template <class Real>
struct ShadowSource : Source<Real> {
    UInt<Real> light = UInt<Real>(no_primitive);
};

/// A shadow ray in a scene with culled faces: it passes their backs.
template <class Real>
struct CulledShadowSource : ShadowSource<Real> {};

/// A shadow ray in a scene with alpha masks: it may pass those, the backs of culled faces, and the light.
template <class Real>
struct MaskedShadowSource : Source<Real> {
    UInt<Real> light = UInt<Real>(no_primitive);
};

/// Whether rays from a source of this type pass the backs of culled faces.
template <class Real, class From>
inline constexpr bool passes_backs =
    std::is_same_v<From, PathSource<Real>> || std::is_same_v<From, CulledShadowSource<Real>> ||
    std::is_same_v<From, MaskedShadowSource<Real>>;

namespace source_detail {

/// Makes t positive. The far crossing of an inward ray is in front of it, unless rounding moved the origin out of the
/// solid; then the hit is at once.
template <class Real>
TANDEM_HD_INLINE Double<Real> in_front(const Double<Real>& t) {
    return greater(t, constant<Double<Real>>(is_fast<Real> ? 0x1p-126 : 0x1p-1022));
}

}  // namespace source_detail

// The nearest hit in front of the origin or, in the lanes of `own`, the exit of a ray that leaves the same solid
// inward; in the lanes of `active`. t is within 1 ulp of float of the entry or exit of the ray's line. For `own` the
// root at the origin is not computed, so that it need not be told from the exit.

template <class Real>
TANDEM_HD_INLINE Mask<Real> first_hit_or_exit(const SphereRoots<Real>& roots, const Mask<Real>& own, Double<Real>& t) {
    const Double<Real> root = nearest_root(roots, own);
    t = select(own, source_detail::in_front<Real>(root), root);
    return own || (roots.crosses && root > Double<Real>(0.0));
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> first_hit_or_exit(const BoxCrossing<Real>& crossing, const Mask<Real>& own,
                                              Double<Real>& t) {
    const Mask<Real> hit = first_hit<Real>(crossing, t);
    t = select(own, source_detail::in_front<Real>(crossing.t_far), t);
    return hit || own;
}

template <class Real>
TANDEM_HD_INLINE Mask<Real> first_hit_or_exit(const Sphere& sphere, const Ray<Real>& ray, const Mask<Real>& own,
                                              const Mask<Real>& active, Double<Real>& t) {
    return active && first_hit_or_exit(sphere_roots<Real>(sphere, ray, {active, own}), own, t);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> first_hit_or_exit(const Box& box, const Ray<Real>& ray, const Mask<Real>& own,
                                              const Mask<Real>& active, Double<Real>& t) {
    return active && first_hit_or_exit(cross_box(box, ray), own, t);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> first_hit_or_exit(const Ellipsoid& body, const Ray<Real>& ray, const Mask<Real>& own,
                                              const Mask<Real>& active, Double<Real>& t) {
    return active && first_hit_or_exit(ellipsoid_roots<Real>(body, ray, {active, own}), own, t);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> first_hit_or_exit(const Parallelepiped& body, const Ray<Real>& ray, const Mask<Real>& own,
                                              const Mask<Real>& active, Double<Real>& t) {
    return active && first_hit_or_exit(cross_parallelepiped(to_object(body, ray)), own, t);
}

template <class Primitive>
inline constexpr bool is_face = std::is_same_v<Primitive, Triangle> || std::is_same_v<Primitive, Quad>;

/// The lanes whose ray can hit primitive `id`: not those that left it outward or left a face, nor those that have it
/// certainly `behind` them.
template <class Real, class Primitive>
TANDEM_HD_INLINE Mask<Real> can_meet(const Source<Real>& source, std::uint32_t id, const Mask<Real>& behind) {
    const Mask<Real> own = source.primitive == UInt<Real>(id);
    if constexpr (is_face<Primitive>) return !own && !behind;
    return select(own, source.inside, !behind);
}
/// A ray does not hit a triangle again after a masked hit on it.
template <class Real, class Primitive>
TANDEM_HD_INLINE Mask<Real> can_meet(const PathSource<Real>& source, std::uint32_t id, const Mask<Real>& behind) {
    const Source<Real>& surface = source;
    const Mask<Real> meets = can_meet<Real, Primitive>(surface, id, behind);
    if constexpr (!std::is_same_v<Primitive, Triangle>) return meets;
    return meets && source.last_masked.primitive != UInt<Real>(id);
}
template <class Real, class Primitive>
TANDEM_HD_INLINE Mask<Real> can_meet(NoSource, std::uint32_t, const Mask<Real>& behind) {
    return !behind;
}

/// Visits the primitives for which can_meet() depends on the source of a ray.
template <class Real, class Visit>
TANDEM_HD_INLINE void for_each_source(const Source<Real>& source, const Visit& visit) {
    visit(source.primitive);
}
template <class Real, class Visit>
TANDEM_HD_INLINE void for_each_source(const PathSource<Real>& source, const Visit& visit) {
    visit(source.primitive);
    visit(source.last_masked.primitive);
}
template <class Visit>
TANDEM_HD_INLINE void for_each_source(NoSource, const Visit&) {}

/// The lanes where a hit on primitive `id` is the far side of the solid that the ray left inward.
template <class Real>
TANDEM_HD_INLINE Mask<Real> leaves_inward(const Source<Real>& source, std::uint32_t id) {
    return source.inside && source.primitive == UInt<Real>(id);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> leaves_inward(NoSource, std::uint32_t) {
    return Mask<Real>(false);
}

/// Whether a hit at `t` on primitive `id` is on its far side: where the ray left the primitive inward, and where it has
/// passed a masked hit on the near side of the solid.
template <class Real, class Primitive>
TANDEM_HD_INLINE Mask<Real> is_far_side(const PathSource<Real>& source, const Primitive& primitive, std::uint32_t id,
                                        const Ray<Real>& ray, const Double<Real>& t, const Mask<Real>& here) {
    Mask<Real> far = leaves_inward<Real>(source, id);
    if constexpr (!is_face<Primitive>) {
        const Mask<Real> has_passed = here && !far && source.last_masked.t > Double<Real>(0.0);
        if (any(has_passed)) [[unlikely]] {
            Double<Real> first(0.0);
            far = far || (first_hit(primitive, ray, first, has_passed) && has_passed && t > first);
        }
    }
    return far;
}

/// The nearest hit of a ray from `source` on primitive `id`, in the lanes of `active`. A hit on a face beyond
/// `farthest` may be omitted.
template <class Real, class Primitive>
TANDEM_HD_INLINE Mask<Real> first_hit_from(NoSource, const Primitive& primitive, std::uint32_t, const Ray<Real>& ray,
                                           const Mask<Real>& active, const Double<Real>& farthest, Double<Real>& t) {
    if constexpr (is_face<Primitive>) {
        return first_hit(primitive, ray, t, active, farthest);
    } else {
        return first_hit(primitive, ray, t, active);
    }
}

// A ray does not hit again a solid that it leaves outward, nor a face, nor a quad, even a folded one. Tested first,
// because at the origin of the ray only exact arithmetic could decide.
template <class Real, class Primitive>
TANDEM_HD_INLINE Mask<Real> first_hit_from(const Source<Real>& source, const Primitive& primitive, std::uint32_t id,
                                           const Ray<Real>& ray, const Mask<Real>& active, const Double<Real>& farthest,
                                           Double<Real>& t) {
    const Mask<Real> own = source.primitive == UInt<Real>(id);
    if constexpr (is_face<Primitive>) {
        return first_hit(primitive, ray, t, active && !own, farthest);
    } else {
        const Mask<Real> meets = active && (!own || source.inside);
        if (!any(meets)) return meets;
        return first_hit_or_exit(primitive, ray, own, meets, t);
    }
}

namespace source_detail {

// The second crossing of a ray with a solid that it does not start on; 0 if there is none. Out of line, because it is
// rare: a ray must pass a masked hit on a solid and hit the same solid again.
template <class Real, class Body>
TANDEM_HD_CALL Double<Real> second_crossing(Body body, Ray<Real> ray, Mask<Real> active) {
    Double<Real> t(0.0);
    (void)first_hit_or_exit(body, ray, active, active, t);
    return t;
}

}  // namespace source_detail

// A ray may hit a primitive a second time after a masked hit on it: a solid on its far side, a folded quad on its other
// half. `culls`: culled faces let rays pass from behind.
template <class Real, class Primitive>
TANDEM_HD_INLINE Mask<Real> first_hit_from(const PathSource<Real>& source, const Primitive& primitive, std::uint32_t id,
                                           const Ray<Real>& ray, const Mask<Real>& active, const Double<Real>& farthest,
                                           Double<Real>& t, bool culls) {
    const UInt<Real> number(id);
    const Source<Real>& surface = source;
    if constexpr (is_face<Primitive>) {
        culls = culls && primitive.attributes.sides == FaceSides::culled;
        const auto counts = [&](Mask<Real> hit, const Double<Real>& at, const Vec3f& b, const Vec3f& c) {
            hit = hit && is_beyond<Real>(source.last_masked, at, number);
            if (culls && any(hit)) hit = hit && !comes_from_behind(ray, geometric_normal<Real>(primitive.v0, b, c));
            return hit;
        };
        if constexpr (std::is_same_v<Primitive, Quad>) {
            return first_that_counts(primitive, ray, t, active && source.primitive != number, farthest, counts);
        } else {
            const Mask<Real> hit = first_hit_from(surface, primitive, id, ray, active, farthest, t);
            if (!culls && !any(source.last_masked.t > Double<Real>(0.0))) [[likely]]
                return hit;
            return counts(hit, t, primitive.v1, primitive.v2);
        }
    } else {
        Mask<Real> hit = first_hit_from(surface, primitive, id, ray, active, farthest, t);
        if (!any(source.last_masked.t > Double<Real>(0.0))) [[likely]]
            return hit;
        const auto before =
            hit && source.last_masked.t > Double<Real>(0.0) && !is_beyond<Real>(source.last_masked, t, number);
        if (any(before)) {
            t = select(before, source_detail::second_crossing<Real>(primitive, ray, before), t);
            hit = hit && (!before || is_beyond<Real>(source.last_masked, t, number));
        }
        return hit;
    }
}

template <class Real, class Primitive>
TANDEM_HD_INLINE Mask<Real> first_hit_from(const ShadowSource<Real>& source, const Primitive& primitive,
                                           std::uint32_t id, const Ray<Real>& ray, const Mask<Real>& active,
                                           const Double<Real>& farthest, Double<Real>& t) {
    const Source<Real>& surface = source;
    return first_hit_from(surface, primitive, id, ray, active && source.light != UInt<Real>(id), farthest, t);
}

// `culls`: whether faces of this kind can be culled.
template <class Real, class Primitive>
TANDEM_HD_INLINE Mask<Real> first_hit_from(const CulledShadowSource<Real>& source, const Primitive& primitive,
                                           std::uint32_t id, const Ray<Real>& ray, const Mask<Real>& active,
                                           const Double<Real>& farthest, Double<Real>& t, bool culls = true) {
    if constexpr (is_face<Primitive>) {
        const PathSource<Real> path = {source};
        const Mask<Real> counts = active && source.light != UInt<Real>(id);
        return first_hit_from(path, primitive, id, ray, counts, farthest, t, culls);
    } else {
        const ShadowSource<Real>& shadow = source;
        return first_hit_from(shadow, primitive, id, ray, active, farthest, t);
    }
}

}  // namespace tandem
