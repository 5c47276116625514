/// Rays that leave surfaces. No offset and no least t keeps such a ray from the surface that it starts on: it says which
/// primitive that is and on which side it leaves, and each kind of primitive knows what follows. Right at every scale,
/// however near the next surface is (docs/numerics.md).
///
/// Closed convex bodies (sphere, box, ellipsoid, parallelepiped): a ray that leaves outward cannot meet its body again;
/// one that leaves inward meets the far side, and always does, so that it never gets lost inside. A new kind adds one
/// overload of leave_inward(); flat ones, which cannot be met again either way, return Mask<Real>(false).
#pragma once

#include "tandem/geometry/affine.h"
#include "tandem/geometry/hit.h"

namespace tandem {

/// What a ray leaves. A ray in space leaves no_primitive.
template <class Real>
struct Source {
    UInt<Real> primitive = UInt<Real>(no_primitive);
    Mask<Real> inside = Mask<Real>(false);  ///< it leaves inward: its direction against the outward normal is negative
};
using RaySource = Source<float>;

/// A source for rays that leave no surface, such as camera rays: the code for sources is then not even compiled.
struct NoSource {};

/// What a shadow ray leaves, and what it runs to: hits on the light's own primitive do not count.
template <class Real>
struct ShadowSource : Source<Real> {
    UInt<Real> light = UInt<Real>(no_primitive);
};

namespace source_detail {

/// The far crossing of a ray that goes inward is in front of it; where rounding has put the origin behind the surface it
/// would not be, and comes at once.
template <class D>
TANDEM_HD D in_front(const D& t) {
    return greater(t, D(0x1p-1022));
}

template <class Real>
TANDEM_HD Double<Real> far_crossing(const SphereRoots<Real>& roots) {
    using D = Double<Real>;
    // A line that passes the ball by, because rounding has put the origin outside: where it comes nearest.
    const Mask<Real> ahead = roots.b >= D(0.0);
    const D numerator = select(roots.crosses, select(ahead, roots.q, roots.c), roots.b);
    const D denominator = select(roots.crosses && !ahead, roots.q, roots.a);
    return in_front(numerator / denominator);
}

}  // namespace source_detail

// Where a ray that leaves a primitive inward meets it again: t, in double, rounded to within 1 ulp of float of where the
// line through the ray leaves the body. The root at the origin is not formed, so nothing has to tell the two apart.

template <class Real>
TANDEM_HD Mask<Real> leave_inward(const Sphere& sphere, const Ray<Real>& ray, Double<Real>& t) {
    t = source_detail::far_crossing(sphere_roots(sphere, ray));
    return Mask<Real>(true);
}

template <class Real>
TANDEM_HD Mask<Real> leave_inward(const Box& box, const Ray<Real>& ray, Double<Real>& t) {
    t = source_detail::in_front(cross_box(box, ray).t_far);
    return Mask<Real>(true);
}

template <class Real>
TANDEM_HD Mask<Real> leave_inward(const Ellipsoid& body, const Ray<Real>& ray, Double<Real>& t) {
    t = source_detail::far_crossing(ellipsoid_roots(body.placement, ray));
    return Mask<Real>(true);
}

template <class Real>
TANDEM_HD Mask<Real> leave_inward(const Parallelepiped& body, const Ray<Real>& ray, Double<Real>& t) {
    t = source_detail::in_front(cross_parallelepiped(to_object(body.placement, ray)).t_far);
    return Mask<Real>(true);
}

/// Where is a hit on primitive `id` the far side of what the ray left inward?
template <class Real>
TANDEM_HD Mask<Real> leaves_inward(const Source<Real>& source, std::uint32_t id) {
    return source.inside && source.primitive == UInt<Real>(id);
}
template <class Real>
TANDEM_HD Mask<Real> leaves_inward(NoSource, std::uint32_t) {
    return Mask<Real>(false);
}

/// The first point of primitive `id` in front of a ray that comes from `source`.
template <class Real, class Primitive>
TANDEM_HD Mask<Real> first_from(NoSource, const Primitive& primitive, std::uint32_t, const Ray<Real>& ray,
                                Double<Real>& t) {
    return first_in_front(primitive, ray, t);
}

template <class Real, class Primitive>
TANDEM_HD Mask<Real> first_from(const Source<Real>& source, const Primitive& primitive, std::uint32_t id,
                                const Ray<Real>& ray, Double<Real>& t) {
    Mask<Real> hit = first_in_front(primitive, ray, t);
    const Mask<Real> own = source.primitive == UInt<Real>(id);
    if (any(own)) {
        Double<Real> t_again;
        const Mask<Real> again = leave_inward(primitive, ray, t_again) && source.inside;
        hit = select(own, again, hit);
        t = select(own, t_again, t);
    }
    return hit;
}

template <class Real, class Primitive>
TANDEM_HD Mask<Real> first_from(const ShadowSource<Real>& source, const Primitive& primitive, std::uint32_t id,
                                const Ray<Real>& ray, Double<Real>& t) {
    const Source<Real>& surface = source;
    const Mask<Real> hit = first_from(surface, primitive, id, ray, t);
    return hit && source.light != UInt<Real>(id);
}

}  // namespace tandem
