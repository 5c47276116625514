/// Probabilities with which a path follows the lobes of a surface.
#pragma once

#include "tandem/kernel/lit_vertex.h"
#include "tandem/kernel/path_limits.h"

namespace tandem {

/// The approximate albedo of each lobe, by LobePlace: a path follows lobes with probabilities in proportion. Set only
/// for lobes that the kernel's paths follow.
template <class Real>
struct LobeWeights {
    Real of[LobePlace::count];
};

namespace lobe_choice_detail {

template <class Real>
TANDEM_HD Real largest(const Vec3<Real>& a) {
    return greater(greater(a.x, a.y), a.z);
}

}  // namespace lobe_choice_detail

/// The weights of the lobes that work in the local frame, in the lanes of `active`.
template <class Effects, class Real>
TANDEM_HD void weigh_local_lobes(const SceneView& scene, const Surface<Real>& surface, const SurfacePoint<Real>& point,
                                 const ShadingFrame<Real>& shading, const Mask<Real>& active,
                                 LobeWeights<Real>& weights) {
    using lobe_choice_detail::largest;
    if constexpr (Effects::most.has_any(effects_of_local_lobes)) {
        const Real zero(0.0F);
        Mask<Real> any_scatters(false);
        for_each_followed_lobe<Effects>(surface.reflectance.lobes, [&](const auto& lobe, auto place) {
            if constexpr (is_local<std::decay_t<decltype(lobe)>, Real>) {
                weights.of[decltype(place)::value] = zero;
                any_scatters = any_scatters || (active && lobe.scatters());
            }
        });
        if (!any(any_scatters)) return;
        const LocalView<Real> view = local_view<Effects>(surface, point, shading.to_viewer);
        for_each_followed_lobe<Effects>(surface.reflectance.lobes, [&](const auto& lobe, auto place) {
            using Lobe = std::decay_t<decltype(lobe)>;
            if constexpr (is_local<Lobe, Real>) {
                constexpr bool is_diffuse = has(Lobe::flags, LobeFlags::diffuse);
                if (is_diffuse && !has_indirect_light<Effects>(scene)) return;
                const Mask<Real> shows = is_diffuse ? shading.is_front : !view.hidden;
                weights.of[decltype(place)::value] = select(shows, largest(lobe.albedo(view.wo)), zero);
            }
        });
    }
}

/// The weights of the other lobes.
template <class Effects, class Real>
TANDEM_HD void weigh_other_lobes(const SceneView& scene, const Surface<Real>& surface,
                                 const ShadingFrame<Real>& shading, LobeWeights<Real>& weights) {
    using lobe_choice_detail::largest;
    const Real zero(0.0F);
    for_each_followed_lobe<Effects>(surface.reflectance.lobes, [&](const auto& lobe, auto place) {
        using Lobe = std::decay_t<decltype(lobe)>;
        if constexpr (!is_local<Lobe, Real>) {
            Real& weight = weights.of[decltype(place)::value];
            weight = zero;
            if constexpr (!has(Lobe::flags, LobeFlags::diffuse)) {
                weight = largest(lobe.albedo(shading.to_viewer));  // the direction does not matter
            } else if (has_indirect_light<Effects>(scene)) {
                weight = select(shading.is_front, largest(lobe.albedo(shading.to_viewer)), zero);
            }
        }
    });
}

/// The sum of the weights, in the order of the lobes.
template <class Effects, class Real>
TANDEM_HD Real total_weight(const Surface<Real>& surface, const LobeWeights<Real>& weights) {
    LobeSum<Real> sum(Real(0.0F));
    for_each_followed_lobe<Effects>(surface.reflectance.lobes,
                                    [&](const auto&, auto place) { sum.add(weights.of[decltype(place)::value]); });
    return sum.value();
}

/// The lanes whose path continues by chance: along one of several lobes, or along a specular lobe that needs random
/// numbers. For a single ray, whether the kernel has paths that do: the compiler knows it, and the threads of a GPU do
/// not wait for each other.
template <class Effects, class Real>
TANDEM_HD Mask<Real> has_choice(const Surface<Real>& surface, const LobeWeights<Real>& weights) {
    constexpr bool is_packet = RealTraits<Real>::lanes > 1;
    Mask<Real> one(false), several(false);
    for_each_followed_lobe<Effects>(surface.reflectance.lobes, [&](const auto& lobe, auto place) {
        using Lobe = std::decay_t<decltype(lobe)>;
        Mask<Real> shows(true);
        if constexpr (is_packet) shows = weights.of[decltype(place)::value] > Real(0.0F);
        several = several || (one && shows);
        one = one || shows;
        if constexpr (has(Lobe::flags, LobeFlags::specular) && Lobe::numbers > 0) several = several || shows;
    });
    return several;
}

/// The lobes along which the path may still continue at a vertex, so that light sampling must be weighted.
/// `scatterings`, `reflections`: of the path so far. `weights`: those of the local lobes.
template <class Effects, class Real>
TANDEM_HD FollowedLobes<Real> followed_lobes(const SceneView& scene, const PathLimits& limits,
                                             const Surface<Real>& surface, const ShadingFrame<Real>& shading,
                                             const UInt<Real>& scatterings, const UInt<Real>& reflections,
                                             LobeWeights<Real> weights) {
    FollowedLobes<Real> followed;
    followed.diffuse = shading.is_front && scatterings < UInt<Real>(limits.diffuse);
    if constexpr (Effects::most.has_any(effects_of_local_lobes)) {
        if (!Effects::has_any(effects_of_local_lobes)) return followed;
        followed.glossy = reflections < UInt<Real>(limits.reflection);
        weigh_other_lobes<Effects>(scene, surface, shading, weights);
        const Real total = total_weight<Effects>(surface, weights);
        for_each_followed_lobe<Effects>(surface.reflectance.lobes, [&](const auto& lobe, auto place) {
            constexpr int at = decltype(place)::value;
            if constexpr (has(std::decay_t<decltype(lobe)>::flags, LobeFlags::glossy)) {
                const Real& weight = weights.of[at];
                followed.chance[glossy_number<at>] = select(weight > Real(0.0F), weight / total, Real(1.0F));
            }
        });
    }
    return followed;
}

}  // namespace tandem
