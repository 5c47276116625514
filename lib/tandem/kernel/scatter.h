/// How a path continues from a vertex.
#pragma once

#include "tandem/kernel/lobe_choice.h"
#include "tandem/kernel/path_state.h"
#include "tandem/kernel/roulette.h"
#include "tandem/kernel/spawn_ray.h"

namespace tandem {

/// Continues the path along its ray, through the alpha-masked surface that it has hit, in the lanes of `masked`.
template <class Effects, class Real>
TANDEM_HD void continue_through_mask(const Closest<Real>& hit, const Mask<Real>& masked,
                                     PathState<Effects, Real, true>& path) {
    using Word = UInt<Real>;
    path.source.last_masked.t = select(masked, hit.t, path.source.last_masked.t);
    path.source.last_masked.primitive = select(masked, hit.primitive, path.source.last_masked.primitive);
    path.masked_hits = path.masked_hits + select(masked, Word(1U), Word(0U));
    path.alive = path.alive || (masked && path.masked_hits <= Word(max_masked_hits));
}

namespace scatter_detail {

/// The random numbers of a lobe. A path follows one lobe per vertex, so lobes of one kind may share them.
template <class Lobe, class Real>
TANDEM_HD Vec3<Double<Real>> lobe_numbers(const SampleId<Real>& sample, const UInt<Real>& vertex,
                                          const PhiloxBlock<UInt<Real>>& random) {
    using D = Double<Real>;
    if constexpr (has(Lobe::flags, LobeFlags::specular)) {
        return {widen(to_unit_interval<Real>(random.word[1])), D(0.0F), D(0.0F)};
    } else {
        constexpr Dimension dimension =
            has(Lobe::flags, LobeFlags::diffuse) ? Dimension::hemisphere : Dimension::microfacets;
        const auto at = sample.block_at_vertex(dimension, vertex);
        return {widen(to_unit_interval<Real>(at.word[0])), widen(to_unit_interval<Real>(at.word[1])),
                widen(to_unit_interval<Real>(at.word[2]))};
    }
}

/// A direction sampled from `lobe`, world space.
template <class Lobe, class Real>
TANDEM_HD LobeSample<Real> sample_in_world(const Lobe& lobe, const ShadingFrame<Real>& shading,
                                           const Vec3<Double<Real>>& u) {
    return lobe.sample_about(shading.normals, shading.to_viewer, u);
}
template <class Effects, class Lobe, class Real>
TANDEM_HD_CALL_ON(host)
LobeSample<Real> sample_in_frame(const Lobe& lobe, const Surface<Real>& surface, const SurfacePoint<Real>& point,
                                 const ShadingFrame<Real>& shading, const Vec3<Double<Real>>& u) {
    const LocalView<Real> view = local_view<Effects>(surface, point, shading.to_viewer);
    LobeSample<Real> drawn = lobe.sample(view.wo, u);
    drawn.wi = from_frame(view.frame, drawn.wi.x, drawn.wi.y, drawn.wi.z);
    return drawn;
}

}  // namespace scatter_detail

/// Samples a lobe of the surface, with a probability in proportion to its weight, and continues the path along it.
/// `weights`: those of the local lobes. Lanes whose path ends are cleared in path.alive; lanes not in it stay as they
/// are. Returns the lanes with a mismatch of media (Interface::lost).
///
/// Paths carry L / n^2, which interfaces leave unchanged; a camera in air sees L.
/// Source: J. Kajiya, "The Rendering Equation", SIGGRAPH 1986; one ray at an interface after E. Veach's thesis, 1997,
/// 5.2.
template <class Effects, class Real>
TANDEM_HD_CALL_ON(host)
Mask<Real> scatter(const SceneView& scene, const PathLimits& limits, const SampleId<Real>& sample,
                   const UInt<Real>& vertex, const Surface<Real>& surface, const SurfacePoint<Real>& point,
                   const ShadingFrame<Real>& shading, LobeWeights<Real> weights, PathState<Effects, Real, true>& path) {
    using D = Double<Real>;
    using Word = UInt<Real>;
    const Real zero(0.0F);
    const Word one(1U);
    const Word none(0U);
    Mask<Real> lost(false);
    weigh_other_lobes<Effects>(scene, surface, shading, weights);
    const Real total = total_weight<Effects>(surface, weights);
    path.alive = path.alive && total > zero;
    const Mask<Real> active = path.alive;
    if (!any(active)) return lost;
    if (Effects::has_any(effects_of_scattering_lobes)) {
        path.pdf = select(active, D(0.0), path.pdf);
        if (Effects::has(Effect::area_lights) && scene.area_light_count > 0) {
            path.sampled_from = select(active, point.position, path.sampled_from);
        }
    }

    // Sample a lobe and a direction
    const Mask<Real> plays =
        Mask<Real>(Effects::has(Effect::roulette)) && active && Word(scene.roulette_from) <= vertex;
    PhiloxBlock<Word> random{};
    if (any(plays || (active && has_choice<Effects>(surface, weights)))) {
        random = sample.block_at_vertex(Dimension::scatter, vertex);
    }
    const Real place_in_total = to_unit_interval<Real>(random.word[0]) * total;
    LobeSum<Real> reached(zero);
    Mask<Real> chosen(false);
    Mask<Real> goes_through(false);
    Vec3<D> direction = -shading.to_viewer;
    for_each_followed_lobe<Effects>(surface.reflectance.lobes, [&](const auto& lobe, auto place) {
        using Lobe = std::decay_t<decltype(lobe)>;
        constexpr int at = decltype(place)::value;
        const Real& weight = weights.of[at];
        reached.add(weight);
        const Mask<Real> takes = active && !chosen && weight > zero && place_in_total < reached.value();
        if (!any(takes)) return;
        chosen = chosen || takes;
        const Vec3<D> u = scatter_detail::lobe_numbers<Lobe>(sample, vertex, random);
        LobeSample<Real> drawn;
        if constexpr (has(Lobe::flags, LobeFlags::transmission)) {
            auto media = path.media;
            const auto sides = cross_interface<Effects>(scene, media, surface.material, shading.from_inside, takes);
            lost = lost || sides.lost;
            auto interface = lobe;
            interface.eta =
                refractive_index<Real>(scene, sides.before, takes) / refractive_index<Real>(scene, sides.behind, takes);
            drawn = scatter_detail::sample_in_world(interface, shading, u);
            const Mask<Real> through = takes && drawn.transmits;
            goes_through = goes_through || through;
            path.media = select(through, media, path.media);
            path.refractions = path.refractions + select(through, one, none);
        } else if constexpr (SampledInWorld<Lobe, Real>) {
            drawn = scatter_detail::sample_in_world(lobe, shading, u);
        } else {
            drawn = scatter_detail::sample_in_frame<Effects>(lobe, surface, point, shading, u);
        }
        direction = select(takes, drawn.wi, direction);
        const Real chance = weight / total;
        const Vec3<Real> brought = {drawn.weight.x / chance, drawn.weight.y / chance, drawn.weight.z / chance};
        path.throughput = select(takes, path.throughput * brought, path.throughput);

        // Specular lobes have no density; that of glossy ones is negative and includes the choice (PathState::pdf)
        if constexpr (has(Lobe::flags, LobeFlags::diffuse)) {
            path.pdf = select(takes, drawn.pdf, path.pdf);
            path.scatterings = path.scatterings + select(takes, one, none);
        } else {
            path.reflections = path.reflections + select(takes && !drawn.transmits, one, none);
        }
        if constexpr (has(Lobe::flags, LobeFlags::glossy)) {
            path.pdf = select(takes, -(drawn.pdf * widen(chance)), path.pdf);
        }
        // no light where the shading normal leads through the surface
        if constexpr (!has(Lobe::flags, LobeFlags::specular)) {
            const Mask<Real> above = drawn.valid && dot(direction, shading.normals.geometric) > D(0.0);
            path.alive = path.alive && (!takes || above);
        }
    });

    // Length limits and Russian roulette
    path.alive = path.alive && chosen && path.reflections <= Word(limits.reflection) &&
                 path.refractions <= Word(limits.refraction) && path.scatterings <= Word(limits.diffuse);
    if (any(plays)) {
        const Real least(0.05F);
        const Real chance_to_live = select(plays, survival_probability(path.throughput, least), Real(1.0F));
        path.alive = path.alive && survives<Real>(widen(chance_to_live), widen(to_unit_interval<Real>(random.word[2])));
        path.throughput = {path.throughput.x / chance_to_live, path.throughput.y / chance_to_live,
                           path.throughput.z / chance_to_live};
    }

    // The new ray. Its side follows from the choice, since rounding could change the side of a grazing direction.
    const Mask<Real> inside = select(goes_through, !shading.from_inside, shading.from_inside);
    path.ray.origin = select(active, departure(point, inside), path.ray.origin);
    path.ray.direction = select(active, to_real<Real>(direction), path.ray.direction);
    path.source.primitive = select(active, point.primitive, path.source.primitive);
    path.source.inside = select(active, inside, path.source.inside);
    path.forget_masked_hits(scene, active);
    // in the tier fast a ray may overflow
    if (is_fast<Real>) path.alive = path.alive && is_traceable(path.ray);
    return lost && path.alive;
}

}  // namespace tandem
