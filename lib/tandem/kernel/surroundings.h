/// What surrounds a scene: the background that rays see if they leave it, and its picture as a light.
#pragma once

#include "tandem/kernel/area_light_sampling.h"
#include "tandem/kernel/path_state.h"

namespace tandem {

/// Is there a picture in place of the gradient?
template <class Effects>
TANDEM_HD bool has_environment_picture(const SceneView& scene) {
    return Effects::has(Effect::environment_picture) && scene.environment_picture.width != 0;
}

/// Do surfaces sample directions from it?
template <class Effects>
TANDEM_HD bool samples_environment_picture(const SceneView& scene) {
    return has_environment_picture<Effects>(scene) && Effects::has(Effect::environment_light) &&
           scene.environment.illuminates != 0;
}

/// What a surface reflects of the picture, by one direction that is sampled in proportion to its brightness: unbiased
/// together with what a path finds that follows a lobe, in the lanes of `followed`. Phong highlights do not show it, as
/// they do not show the gradient. Source: E. Veach, L. Guibas, 1995 (kernel/sampler/mis.h).
template <class Effects, class Real>
TANDEM_HD_STAGE IncidentLight<Real> environment_picture_light(const SceneView& scene, const Surface<Real>& surface,
                                                              const SurfacePoint<Real>& point,
                                                              const Vec3<Double<Real>>& to_viewer,
                                                              const SampleId<Real>& sample, const UInt<Real>& vertex,
                                                              const FollowedLobes<Real>& followed) {
    using D = Double<Real>;
    const D zero(0.0);
    const auto drawn =
        sample_environment<Real>(environment_picture(scene), sample.block_at_vertex(Dimension::environment, vertex));
    IncidentLight<Real> result = {black<Real>(), to_real<Real>(drawn.direction)};
    result.is_far = Mask<Real>(true);
    result.casts_shadows = Mask<Real>(scene.area_lights_cast_shadows != 0);
    const Mask<Real> seen = drawn.pdf > zero && dot(drawn.direction, surface.normal) > zero;
    if (!any(seen)) return result;
    const D pdf = select(seen, drawn.pdf, D(1.0));
    const Vec3<Real> value = light_by_sample<Effects>(scene, surface, black<Real>(), point, drawn.radiance,
                                                      drawn.direction, to_viewer, pdf, followed);
    result.reflected = select(seen, value, result.reflected);
    if (scene.area_lights_cast_shadows == 0) return result;
    // as for paths that go on; where none does, the gradient also lights what looks away (environment_light())
    const bool indirect = Effects::has(Effect::indirect) && scene.environment.indirect != 0;
    Mask<Real> shared(indirect);
    if (Effects::has(Effect::microfacets)) shared = shared || surface.has_microfacets;
    IncidentLight<Real> in_front = result;
    keep_in_front(surface, point, drawn.direction, in_front);
    result.reflected = select(shared, in_front.reflected, result.reflected);
    return result;
}

/// What a path sees that leaves the scene, less what the vertex before has sampled of it.
template <class Effects, class Real, bool bounces>
TANDEM_HD_STAGE Vec3<Real> seen_environment_picture(const SceneView& scene,
                                                    const PathState<Effects, Real, bounces>& path) {
    using D = Double<Real>;
    const auto sight = see_environment<Real>(environment_picture(scene), widen(path.ray.direction));
    if constexpr (bounces) {
        const bool scatters = Effects::has_any(Effect::indirect | Effect::microfacets);
        if (!scatters || !samples_environment_picture<Effects>(scene)) return sight.radiance;
        const D zero(0.0);
        const D own = select(path.pdf < zero, -path.pdf, path.pdf);  // of microfacets it is negative
        const D share = select(own > zero, power_heuristic(own, sight.pdf), D(1.0));
        return sight.radiance * to_real<Real>(share);
    } else {
        return sight.radiance;
    }
}

}  // namespace tandem
