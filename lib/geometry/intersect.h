/// A ray against one primitive of a scene, and against all of them.
#pragma once

#include "tandem/geometry/filter.h"
#include "tandem/geometry/hit.h"
#include "tandem/scene/scene_view.h"

namespace tandem {

/// Keeps the nearer of `best` and a point at t, in the lanes of `hit`.
template <class Real>
TANDEM_HD void offer(const Mask<Real>& hit, const Double<Real>& t, std::uint32_t primitive, Closest<Real>& best) {
    const UInt<Real> id(primitive);
    const Mask<Real> closer = hit && is_closer(t, id, best);
    best.t = select(closer, t, best.t);
    best.primitive = select(closer, id, best.primitive);
}

/// Keeps the nearer of `best` and the first point in front of the ray's origin, in the lanes of `candidate`, which the
/// filter let through.
template <class Real>
TANDEM_HD void decide(const Sphere& sphere, std::uint32_t id, const Ray<Real>& ray, const Mask<Real>& candidate,
                      Closest<Real>& best) {
    Double<Real> t;
    offer<Real>(first_in_front(sphere, ray, t) && candidate, t, id, best);
}
template <class Real>
TANDEM_HD void decide(const Box& box, std::uint32_t id, const Ray<Real>& ray, const Mask<Real>& candidate,
                      Closest<Real>& best) {
    Double<Real> t;
    offer<Real>(first_in_front<Real>(cross_box(box, ray), t) && candidate, t, id, best);
}

// One primitive each: the float filter first, then the decision in double.

template <class Real>
TANDEM_HD void intersect(const Sphere& sphere, std::uint32_t id, const FilterRay<Real>& f, const Mask<Real>& active,
                         Closest<Real>& best) {
    if constexpr (is_fast<Real>) {
        decide(sphere, id, f.ray, active, best);  // hardly more work than the filter
    } else {
        const Mask<Real> candidate = active && may_touch_sphere(f, sphere.centre, sphere.radius);
        if (any(candidate)) decide(sphere, id, f.ray, candidate, best);
    }
}

template <class Real>
TANDEM_HD void intersect(const Box& box, std::uint32_t id, const FilterRay<Real>& f, const Mask<Real>& active,
                         Closest<Real>& best) {
    if constexpr (is_fast<Real>) {
        decide(box, id, f.ray, active, best);
    } else {
        const Mask<Real> candidate = active && may_touch_box(f, box.lower, box.upper);
        if (any(candidate)) decide(box, id, f.ray, candidate, best);
    }
}

template <class Real>
TANDEM_HD void intersect_ellipsoid(const Placement& placement, std::uint32_t id, const FilterRay<Real>& f,
                                   const Mask<Real>& active, Closest<Real>& best) {
    const Sphere& around = placement.bounding_sphere;
    const Mask<Real> candidate = active && may_touch_sphere(f, around.centre, around.radius);
    if (any(candidate)) {
        Double<Real> t;
        offer<Real>(first_in_front(ellipsoid_roots(placement, f.ray), t) && candidate, t, id, best);
    }
}

template <class Real>
TANDEM_HD void intersect_parallelepiped(const Placement& placement, std::uint32_t id, const FilterRay<Real>& f,
                                        const Mask<Real>& active, Closest<Real>& best) {
    const Sphere& around = placement.bounding_sphere;
    const Mask<Real> candidate = active && may_touch_sphere(f, around.centre, around.radius);
    if (any(candidate)) {
        Double<Real> t;
        const BoxCrossing<Real> crossing = cross_parallelepiped(to_object(placement, f.ray));
        offer<Real>(first_in_front<Real>(crossing, t) && candidate, t, id, best);
    }
}

/// Any primitive by its id.
template <class Real>
TANDEM_HD void intersect_primitive(const SceneView& scene, std::uint32_t id, const FilterRay<Real>& f,
                                   const Mask<Real>& active, Closest<Real>& best) {
    visit_primitive(
        scene, id, [&](const Sphere& sphere) TANDEM_INLINE_LAMBDA { intersect(sphere, id, f, active, best); },
        [&](const Box& box) TANDEM_INLINE_LAMBDA { intersect(box, id, f, active, best); },
        [&](const Placement& ellipsoid) TANDEM_INLINE_LAMBDA { intersect_ellipsoid(ellipsoid, id, f, active, best); },
        [&](const Placement& body) TANDEM_INLINE_LAMBDA { intersect_parallelepiped(body, id, f, active, best); });
}

/// Traces by asking every primitive: no structure, best for a few. Rays must be traceable (math/ray.h) in the lanes of
/// `active`, here and with the other tracers.
struct LoopTracer {
    SceneView scene;

    template <class Real>
    TANDEM_HD Closest<Real> closest(const Ray<Real>& ray, const Mask<Real>& active) const {
        Closest<Real> best = no_hit<Real>();
        const FilterRay<Real> f = make_filter_ray(ray);
        std::uint32_t id = 0;
        for (std::uint32_t i = 0; i < scene.sphere_count; ++i, ++id) intersect(scene.spheres[i], id, f, active, best);
        for (std::uint32_t i = 0; i < scene.box_count; ++i, ++id) intersect(scene.boxes[i], id, f, active, best);
        for (std::uint32_t i = 0; i < scene.ellipsoid_count; ++i, ++id) {
            intersect_ellipsoid(scene.ellipsoids[i], id, f, active, best);
        }
        for (std::uint32_t i = 0; i < scene.parallelepiped_count; ++i, ++id) {
            intersect_parallelepiped(scene.parallelepipeds[i], id, f, active, best);
        }
        return best;
    }
};

}  // namespace tandem
