/// The environment as a light at a vertex of a path: its picture or its gradient.
#pragma once

#include "tandem/kernel/incident_light.h"
#include "tandem/kernel/sampler/warp.h"

namespace tandem {

/// Whether a picture takes the place of the gradient.
template <class Effects>
TANDEM_HD bool has_environment_picture(const SceneView& scene) {
    return Effects::has(Effect::environment_picture) && scene.environment_picture.width != 0;
}

/// Whether the environment lights surfaces.
template <class Effects>
TANDEM_HD bool has_environment_light(const SceneView& scene) {
    return Effects::has(Effect::environment_light) && scene.environment.illuminates != 0;
}

/// A direction sampled in proportion to the brightness of the picture, weighted against paths that follow a lobe. Phong
/// highlights do not show the picture, nor the gradient.
/// Source: kernel/lights/environment_picture.h.
template <class Effects, class Real>
TANDEM_HD_STAGE IncidentLight<Real> sample_environment_picture(const SceneView& scene, const LitVertex<Real>& at) {
    using D = Double<Real>;
    const D zero(0.0);
    const auto drawn = sample_environment<Real>(environment_picture(scene),
                                                at.sample.block_at_vertex(Dimension::environment, at.number));
    IncidentLight<Real> result = {black<Real>(), to_real<Real>(drawn.direction)};
    result.is_far = Mask<Real>(true);
    result.casts_shadows = Mask<Real>(scene.area_lights_cast_shadows != 0);
    Mask<Real> seen = drawn.pdf > zero && dot(drawn.direction, at.surface.normal) > zero;
    if (scene.area_lights_cast_shadows != 0) {
        // a path could not leave to the other side; without paths, light from there is kept, as for the gradient
        const Mask<Real> shared =
            Mask<Real>(has_indirect_light<Effects>(scene)) || scatters_locally<Effects>(at.surface.reflectance.lobes);
        seen = seen && (!shared || is_in_front(at, drawn.direction));
    }
    if (!any(seen)) return result;
    const D pdf = select(seen, drawn.pdf, D(1.0));
    const Vec3<Real> light = drawn.radiance * light_scale<Real>(pdf);
    const Vec3<Real> value = reflect_light<Effects, LobesShown::of_paths>(scene, at, light, drawn.direction, pdf);
    result.reflected = select(seen, value, result.reflected);
    return result;
}

struct EnvironmentPictureLight {
    template <class Effects>
    TANDEM_HD static std::uint32_t count(const SceneView& scene) {
        return has_environment_picture<Effects>(scene) && has_environment_light<Effects>(scene) ? 1 : 0;
    }

    template <class Effects, class Real>
    TANDEM_HD static IncidentLight<Real> sample(const SceneView& scene, std::uint32_t, const LitVertex<Real>& at,
                                                const Mask<Real>&) {
        return sample_environment_picture<Effects>(scene, at);
    }
};

/// The gradient, by one direction around the normal, whichever side is visible, so that the walls of a closed solid are
/// not black from inside. Only diffuse lobes show it. For scenes without indirect light: with it, the continued path
/// adds the background. Paths that microfacets reflect find the gradient by themselves.
template <class Effects, class Real>
TANDEM_HD_STAGE IncidentLight<Real> sample_environment_gradient(const SceneView& scene, const LitVertex<Real>& at) {
    const auto random = at.sample.block_at_vertex(Dimension::environment, at.number);
    const auto drawn = sample_cosine_hemisphere<Real>(at.surface.normal, widen(to_unit_interval<Real>(random.word[0])),
                                                      widen(to_unit_interval<Real>(random.word[1])));
    IncidentLight<Real> result;
    result.position_or_direction = to_real<Real>(drawn.direction);
    // pdf = cos / pi cancels with the cosine and Lambert's 1 / pi
    result.reflected =
        diffuse_reflectance<Effects>(at, drawn.direction) * background(scene.environment, result.position_or_direction);
    result.is_far = Mask<Real>(true);
    result.casts_shadows = Mask<Real>(scene.area_lights_cast_shadows != 0);
    return result;
}

struct EnvironmentGradientLight {
    template <class Effects>
    TANDEM_HD static std::uint32_t count(const SceneView& scene) {
        const bool samples = has_environment_light<Effects>(scene) && !has_indirect_light<Effects>(scene);
        return samples && !has_environment_picture<Effects>(scene) ? 1 : 0;
    }

    template <class Effects, class Real>
    TANDEM_HD static IncidentLight<Real> sample(const SceneView& scene, std::uint32_t, const LitVertex<Real>& at,
                                                const Mask<Real>&) {
        return sample_environment_gradient<Effects>(scene, at);
    }
};

}  // namespace tandem
