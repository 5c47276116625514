/// Light that a path hits by itself, and its MIS weight against the light samples of the previous vertex;
/// share_of_sample() in lit_vertex.h is the other half.
#pragma once

#include "tandem/kernel/area_lights.h"
#include "tandem/kernel/environment_lights.h"
#include "tandem/kernel/path_state.h"

namespace tandem {

/// The MIS weight of the emission of a surface that a path hits, in the lanes of `emits`. `point`: the hit point.
///
/// Method: both densities of the power heuristic are for `sampled_from`, the point for which the direction was sampled.
///         The ray starts slightly above a face, where a near light looks larger. So the light is scaled by the ratio
///         of its projected solid angles, seen from `sampled_from` and from the ray's origin. For a glossy lobe, which
///         is no longer known, the density is the one with which the direction was sampled, including the choice of the
///         lobe.
template <class Effects, class Real>
TANDEM_HD Real share_of_found(const SceneView& scene, const PathState<Effects, Real, true>& path,
                              const Closest<Real>& hit, const SurfacePoint<Real>& point, const Mask<Real>& emits) {
    using D = Double<Real>;
    const Real whole(1.0F);
    if (!Effects::has_any(effects_of_scattering_lobes) || !Effects::has(Effect::area_lights)) return whole;
    const Mask<Real> glossy = Mask<Real>(Effects::has_any(effects_of_glossy_lobes)) && path.pdf < D(0.0);
    const Mask<Real> shared = emits && (path.pdf > D(0.0) || glossy);
    if (scene.area_light_count == 0 || !any(shared)) return whole;
    const D zero(0.0);
    const D one(1.0);
    const Vec3<D> sampled_from = widen(path.sampled_from);
    const Vec3<D> raised = widen(path.ray.origin) - sampled_from;  // along the normal, if at all
    const Vec3<D> along = widen(path.ray.direction);
    const Vec3<D> way = {raised.x + hit.t * along.x, raised.y + hit.t * along.y, raised.z + hit.t * along.z};
    const D inverse = inverse_square_root(dot(way, way));
    const Vec3<D> direction = way * inverse;
    const D length2 = dot(along, along);
    const D shorter = hit.t * square_root(length2) * inverse;  // length of the ray over that of `way`
    const D cosine = path.pdf * constant<D>(pi);
    const D seen_cosine = cosine * shorter + square_root(dot(raised, raised)) * inverse;
    const D facing = dot(along, point.normal) * inverse_square_root(length2);
    const Mask<Real> faces = facing != zero;
    const D turned = select(faces, dot(direction, point.normal) / select(faces, facing, one), one);
    // for a light seen edge-on the ratio is unbounded
    const D brighter = select(glossy, one, seen_cosine / cosine);
    const D growth = (brighter * turned) * (shorter * shorter);
    const D bounded = select(growth < D(2.0), greater(growth, zero), D(2.0));
    const D other = area_light_pdf<Real>(scene, hit.primitive, sampled_from, direction, shared);
    const D pdf = select(glossy, -path.pdf, cosine_hemisphere_pdf(seen_cosine));
    const D share = power_heuristic(pdf, other) * bounded;
    return select(shared, to_real<Real>(share), whole);
}

/// The environment `view` for a path that leaves the scene, with its MIS weight against the sample of the previous
/// vertex.
template <class Effects, class Real, bool bounces, class View>
TANDEM_HD_CALL_ON(host)
Vec3<Real> found_environment(const SceneView& scene, const View& view, const PathState<Effects, Real, bounces>& path) {
    using D = Double<Real>;
    const auto sight = see_environment<Real>(view, widen(path.ray.direction));
    if constexpr (bounces) {
        const bool scatters = Effects::has_any(effects_of_scattering_lobes);
        if (!scatters || !has_environment_light<Effects>(scene)) return sight.radiance;
        const D zero(0.0);
        const D own = select(path.pdf < zero, -path.pdf, path.pdf);  // negative for a glossy lobe
        const D share = select(own > zero, power_heuristic(own, sight.pdf), D(1.0));
        return sight.radiance * to_real<Real>(share);
    } else {
        return sight.radiance;
    }
}

/// The environment of the scene, or the gradient, for a path that leaves it.
template <class Effects, class Real, bool bounces>
TANDEM_HD Vec3<Real> found_background(const SceneView& scene, const PathState<Effects, Real, bounces>& path) {
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is)      \
    if (Effects::has(needs) && is_there(scene.name)) {                     \
        return found_environment(scene, view_of(scene.name, scene), path); \
    }
#include "tandem/kernel/lights/lights.def"
    return background(scene.environment, path.ray.direction);
}

/// Adds the background to paths that hit nothing, in the lanes of `missed`.
template <class Effects, class Real, bool bounces>
TANDEM_HD void see_background(const SceneView& scene, const Mask<Real>& missed, PathState<Effects, Real, bounces>& path,
                              Vec3<Real>& radiance) {
    using D = Double<Real>;
    const Vec3<Real> seen = found_background(scene, path);
    if constexpr (bounces) {
        path.absorb(scene, D(__builtin_huge_val()), UInt<Real>(no_medium), missed);
        Mask<Real> shows = missed;
        // `illuminates` concerns diffuse surfaces only
        if (Effects::has(Effect::indirect) && scene.environment.illuminates == 0) shows = shows && !(path.pdf > D(0.0));
        radiance = select(shows, radiance + path.throughput * seen, radiance);
    } else {
        radiance = select(missed, seen, radiance);
    }
}

}  // namespace tandem
