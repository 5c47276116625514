/// Shadow rays: whether something blocks a light at a point. Tested by tests/kernel/shadow_test.cpp.
#pragma once

#include "tandem/kernel/incident_light.h"
#include "tandem/kernel/masked_hits.h"

namespace tandem {

/// Whether rays are counted one by one. Without rays from surfaces there are as many as samples.
template <class Effects>
TANDEM_HD constexpr bool counts_rays() {
    return Effects::has_any(counted_ray_effects);
}
template <class Effects, class Real>
TANDEM_HD void count_rays(const Mask<Real>& traced, UInt<Real>& rays) {
    if (counts_rays<Effects>()) rays = rays + select(traced, UInt<Real>(1U), UInt<Real>(0U));
}

namespace shadow_detail {

template <class Real, class From, class Tracer>
TANDEM_HD_CALL_ON(device)
Closest<Real> closest_by_call(const Tracer& tracer, Ray<Real> ray, From source, Mask<Real> active,
                              Double<Real> farthest) {
    return tracer.closest(ray, source, active, farthest);
}

}  // namespace shadow_detail

/// Tracer::closest() for paths and for shadow rays through alpha masks.
///
/// Without effects that scatter, paths and shadow rays share one out-of-line copy, if the tracer tests all primitives.
/// With such effects two copies are faster. A tracer with a hierarchy is never called out of line: after such a call
/// the barrier of the block stopped with "illegal instruction" on an H200 (docs/performance/paths.md, "Barriers").
template <class Effects, class Real, class From, class Tracer>
TANDEM_HD Closest<Real> nearest_hit(const Tracer& tracer, const Ray<Real>& ray, const From& source,
                                    const Mask<Real>& active, const Double<Real>& farthest = no_hit<Real>().t) {
    constexpr EffectMask scattering = bouncing_effects - Effect::cutouts;
    if constexpr (!Tracer::has_hierarchy) {
        if (Effects::has(Effect::cutouts) && !Effects::has_any(scattering)) {
            return shadow_detail::closest_by_call<Real>(tracer, ray, source, active, farthest);
        }
    }
    return tracer.closest(ray, source, active, farthest);
}

namespace shadow_detail {

/// Whether a shadow ray through alpha masks is blocked, by searches for the nearest hit, one after the other.
template <class Effects, class Real, class Tracer>
TANDEM_HD Mask<Real> is_blocked_one_by_one(const Tracer& tracer, const SceneView& scene,
                                           const ShadowRay<Real>& shadow) {
    PathSource<Real> source = {shadow.source};
    Mask<Real> open = shadow.active;
    Mask<Real> blocked(false);
    for (std::uint32_t passed = 0; passed < max_masked_hits; ++passed) {
        const Closest<Real> hit = nearest_hit<Effects>(tracer, shadow.ray, source, open, shadow.t_max);
        const Mask<Real> found = open && hit.primitive != UInt<Real>(no_primitive) && hit.t < shadow.t_max;
        if (!any(found)) return blocked;
        const Mask<Real> passes =
            hit.primitive == shadow.source.light || !is_opaque_at<Tracer::kinds>(scene, shadow.ray, source, hit, found);
        blocked = blocked || (found && !passes);
        open = found && passes;
        if (!any(open)) return blocked;
        source.last_masked.t = select(open, hit.t, source.last_masked.t);
        source.last_masked.primitive = select(open, hit.primitive, source.last_masked.primitive);
    }
    return blocked || open;
}

}  // namespace shadow_detail

/// Whether a shadow ray is blocked by an opaque surface: it passes alpha masks where they are open, and the backs of
/// culled faces. Adds one to `rays` for each ray, however many masks it passes.
///
/// With masks, what blocks a ray does not depend on the order of its hits. So it is one search in a hierarchy. Tracers
/// that test all primitives search for the nearest hit again and again, with code that paths need anyway: that is
/// faster among few primitives (docs/performance/hierarchies.md).
template <class Effects, class Real, class Tracer>
TANDEM_HD Mask<Real> is_blocked_by_opaque(const Tracer& tracer, const SceneView& scene, const ShadowRay<Real>& shadow,
                                          UInt<Real>& rays) {
    count_rays<Effects, Real>(shadow.active, rays);
    // Linked kernels have one search with and without culled faces, and so compile in less time: the link knows which
    // kinds can be culled, none of them without the effect.
    if (!is_linked && (!Effects::has(Effect::cutouts) || has_no_cutouts(scene))) {
        return tracer.occluded(shadow.ray, shadow.t_max, shadow.source, shadow.active);
    }
    if (!Effects::has(Effect::cutouts) || has_no_masks(scene)) {
        return tracer.occluded(shadow.ray, shadow.t_max, CulledShadowSource<Real>{shadow.source}, shadow.active);
    }
    if constexpr (requires { tracer.finds_blockers(); }) {
        if (tracer.finds_blockers()) {
            MaskedHits<Tracer::kinds, Real> hits(scene, shadow);
            const MaskedShadowSource<Real> source = {shadow.source, shadow.source.light};
            return tracer.find_blocker(shadow.ray, shadow.t_max, source, shadow.active, hits);
        }
    }
    return shadow_detail::is_blocked_one_by_one<Effects>(tracer, scene, shadow);
}

/// Whether `light` is blocked at `point`, in the lanes of `active`. A light exactly at the point counts as blocked.
template <class Effects, class Real, class Tracer>
TANDEM_HD_CALL_ON(host)
Mask<Real> is_blocked(const Tracer& tracer, const SceneView& scene, const IncidentLight<Real>& light,
                      const SurfacePoint<Real>& point, const Mask<Real>& active, UInt<Real>& rays) {
    ShadowRay<Real> shadow = spawn_shadow_ray(point, light.position_or_direction, light.primitive, light.is_far);
    shadow.active = shadow.active && active;
    return (active && !shadow.active) || is_blocked_by_opaque<Effects>(tracer, scene, shadow, rays);
}

}  // namespace tandem
