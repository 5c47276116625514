/// The environment as a light at a vertex of a path: one of the kinds of lights.def, or the gradient.
#pragma once

#include <concepts>
#include <type_traits>

#include "tandem/kernel/incident_light.h"
#include "tandem/kernel/sampler/warp.h"

namespace tandem {

/// Whether a simulated kind of environment takes the place of the gradient.
template <class Effects>
TANDEM_HD bool shows_environment(const SceneView& scene) {
    bool has = false;
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) \
    has = has || (Effects::has(needs) && is_there(scene.name));
#include "tandem/kernel/lights/lights.def"
    return has;
}

/// Whether the environment lights surfaces.
template <class Effects>
TANDEM_HD bool has_environment_light(const SceneView& scene) {
    return Effects::has(Effect::environment_light) && scene.environment.illuminates != 0;
}

/// The data that kernels read of each kind of environment is a plain struct without undefined bytes, because
/// scene_hash() reads all of them. Value-initialised, it means that the scene has no such environment. It has
///
/// is_there(kind)         whether the scene has it
/// view_of(kind, scene)   the same with the arrays that it reads: a view, which has
///
/// sample_environment<Real>(view, random)   an EnvironmentSample by the four words of a Philox block
/// see_environment<Real>(view, direction)   an EnvironmentSight along a direction whose length is within [1e-15, 1e15]
///
/// The density that both give is that of the samples, so that samples and paths share the light without bias.
template <class Kind>
concept EnvironmentKind = std::is_trivially_copyable_v<Kind> && requires(const Kind& kind, const SceneView& scene) {
    { is_there(kind) } -> std::convertible_to<bool>;
    {
        sample_environment<float>(view_of(kind, scene), PhiloxBlock<std::uint32_t>{})
        } -> std::same_as<EnvironmentSample<float>>;
    { see_environment<float>(view_of(kind, scene), Vec3<double>{}) } -> std::same_as<EnvironmentSight<float>>;
};

#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) static_assert(EnvironmentKind<Type>);
#include "tandem/kernel/lights/lights.def"

/// A direction sampled by the environment `view`, weighted against paths that follow a lobe. Phong highlights show
/// neither the environment nor the gradient.
template <class Effects, class Real, class View>
TANDEM_HD_CALL_ON(host)
IncidentLight<Real> sample_environment_light(const SceneView& scene, const View& view, const LitVertex<Real>& at) {
    using D = Double<Real>;
    const D zero(0.0);
    const auto drawn = sample_environment<Real>(view, at.sample.block_at_vertex(Dimension::environment, at.number));
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

/// A kind of environment as a family of lights; `kind` is the member of SceneView.
template <auto kind>
struct EnvironmentLight {
    template <class Effects>
    TANDEM_HD static std::uint32_t count(const SceneView& scene) {
        return is_there(scene.*kind) && has_environment_light<Effects>(scene) ? 1 : 0;
    }

    template <class Effects, class Real>
    TANDEM_HD static IncidentLight<Real> sample(const SceneView& scene, std::uint32_t, const LitVertex<Real>& at,
                                                const Mask<Real>&) {
        return sample_environment_light<Effects>(scene, view_of(scene.*kind, scene), at);
    }
};

/// The gradient, by one direction around the normal, whichever side is visible, so that the walls of a closed solid are
/// not black from inside. Only diffuse lobes show it. For scenes without indirect light: with it, the continued path
/// adds the background. Paths that microfacets reflect find the gradient by themselves.
template <class Effects, class Real>
TANDEM_HD_CALL_ON(host)
IncidentLight<Real> sample_environment_gradient(const SceneView& scene, const LitVertex<Real>& at) {
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
        return samples && !shows_environment<Effects>(scene) ? 1 : 0;
    }

    template <class Effects, class Real>
    TANDEM_HD static IncidentLight<Real> sample(const SceneView& scene, std::uint32_t, const LitVertex<Real>& at,
                                                const Mask<Real>&) {
        return sample_environment_gradient<Effects>(scene, at);
    }
};

}  // namespace tandem
