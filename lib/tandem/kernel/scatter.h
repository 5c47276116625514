/// How a path continues from a vertex.
#pragma once

#include "tandem/kernel/bsdf/fresnel.h"
#include "tandem/kernel/bsdf/reflect.h"
#include "tandem/kernel/microfacets.h"
#include "tandem/kernel/path_state.h"
#include "tandem/kernel/roulette.h"
#include "tandem/kernel/sampler/warp.h"
#include "tandem/kernel/spawn_ray.h"
#include "tandem/kernel/surface.h"

namespace tandem {

/// The shading frame at a hit.
template <class Real>
struct ShadingFrame {
    Vec3<Double<Real>> direction;  ///< of the ray, unit
    Vec3<Double<Real>> normal;     ///< shading normal, on the ray's side
    Vec3<Double<Real>> facing;     ///< geometric normal, on the ray's side
    Mask<Real> from_inside;        ///< against the outward normal
    Mask<Real> is_front;           ///< the unturned shading normal is on the ray's side: there light is scattered
};

/// Can a path continue in more than one way?
template <class Effects>
TANDEM_HD constexpr bool has_choice() {
    return Effects::has(Effect::reflection) + Effects::has(Effect::refraction) + Effects::has(Effect::indirect) +
               Effects::has(Effect::microfacets) >
           1;
}

template <class Real>
TANDEM_HD ShadingFrame<Real> make_shading_frame(const Surface<Real>& surface, const SurfacePoint<Real>& point,
                                                const Vec3<Double<Real>>& to_viewer) {
    using D = Double<Real>;
    ShadingFrame<Real> shading;
    shading.direction = -to_viewer;
    shading.from_inside = point.from_inside;
    shading.facing = select(shading.from_inside, -point.normal, point.normal);
    const Mask<Real> away = dot(shading.direction, surface.normal) > D(0.0);
    shading.normal = select(away, -surface.normal, surface.normal);
    shading.is_front = !away;
    return shading;
}

/// Reduces Phong's terms by the fraction that the dielectric takes of the light, and removes highlights on the inside
/// of solids.
template <class Effects, class Real>
TANDEM_HD void reduce_by_transmission(Surface<Real>& surface, const ShadingFrame<Real>& shading) {
    if (!Effects::has(Effect::refraction)) return;
    const Real zero(0.0F);
    if (!any(surface.transmission > zero)) return;
    const Real scattered = Real(1.0F) - surface.transmission;
    surface.ambient = surface.ambient * scattered;
    surface.diffuse = surface.diffuse * scattered;
    const Mask<Real> within = shading.from_inside && surface.transmission > zero;
    surface.specular = select(within, Vec3<Real>{zero, zero, zero}, surface.specular);
}

namespace scatter_detail {

template <class Real>
TANDEM_HD Real largest(const Vec3<Real>& a) {
    return greater(greater(a.x, a.y), a.z);
}

/// Mirrored at the shading normal; at the geometric one where that would lead through the surface.
template <class Real>
TANDEM_HD Vec3<Double<Real>> mirrored(const ShadingFrame<Real>& shading) {
    const Vec3<Double<Real>> direction = reflect(shading.direction, shading.normal);
    const Mask<Real> through = !(dot(direction, shading.facing) > Double<Real>(0.0));
    if (!any(through)) return direction;
    return select(through, reflect(shading.direction, shading.facing), direction);
}

/// As refract(), at the shading normal; at the geometric one where that would not lead through the surface.
template <class Real>
TANDEM_HD Refraction<Real> refracted(const ShadingFrame<Real>& shading, const Double<Real>& eta) {
    Refraction<Real> result = refract<Real>(shading.direction, shading.normal, eta);
    const Mask<Real> back = result.transmits && !(dot(result.direction, shading.facing) < Double<Real>(0.0));
    if (!any(back)) return result;
    const Refraction<Real> other = refract<Real>(shading.direction, shading.facing, eta);
    result.transmits = select(back, other.transmits, result.transmits);
    result.direction = select(back, other.direction, result.direction);
    result.cosine_in = select(back, other.cosine_in, result.cosine_in);
    result.cosine_out = select(back, other.cosine_out, result.cosine_out);
    return result;
}

}  // namespace scatter_detail

/// Continues the path along its ray, through the alpha-masked surface that it has hit, in the lanes of `holes`.
template <class Effects, class Real>
TANDEM_HD void continue_through_mask(const Closest<Real>& hole, const Mask<Real>& holes,
                                     PathState<Effects, Real, true>& path) {
    using Word = UInt<Real>;
    path.source.passed.t = select(holes, hole.t, path.source.passed.t);
    path.source.passed.primitive = select(holes, hole.primitive, path.source.passed.primitive);
    path.holes = path.holes + select(holes, Word(1U), Word(0U));
    path.alive = path.alive || (holes && path.holes <= Word(most_holes));
}

/// A direction in which microfacets reflect a path, world space.
template <class Real>
TANDEM_HD_STAGE LobeSample<Real> sample_facets(const Surface<Real>& surface, const SurfacePoint<Real>& point,
                                               const ShadingFrame<Real>& shading, const SampleId<Real>& sample,
                                               const UInt<Real>& vertex) {
    using D = Double<Real>;
    const FacetView<Real> view = view_facets(surface, point, -shading.direction);
    const auto random = sample.block_at_vertex(Dimension::microfacets, vertex);
    LobeSample<Real> drawn = view.lobes.specular.sample(
        view.wo,
        {widen(to_unit_interval<Real>(random.word[0])), widen(to_unit_interval<Real>(random.word[1])), D(0.0F)});
    drawn.wi = from_frame(view.frame, drawn.wi.x, drawn.wi.y, drawn.wi.z);
    return drawn;
}

/// How much of the light each lobe of a vertex reflects or transmits, about: a path follows each with a chance in
/// proportion.
template <class Real>
struct LobeWeights {
    Real mirror, glass, glossy, diffuse;

    /// A surface of one kind is chosen with the probability 1, exactly.
    [[nodiscard]] TANDEM_HD Real total() const { return ((mirror + glass) + glossy) + diffuse; }
};

/// That of the microfacets, in the lanes of `active`.
template <class Effects, class Real>
TANDEM_HD Real glossy_weight(const Surface<Real>& surface, const SurfacePoint<Real>& point,
                             const ShadingFrame<Real>& shading, const Mask<Real>& active) {
    const Real zero(0.0F);
    if (!Effects::has(Effect::microfacets) || !any(active && surface.has_microfacets)) return zero;
    const FacetView<Real> view = view_facets(surface, point, -shading.direction);
    return select(view.shows, scatter_detail::largest(view.lobes.specular.albedo(view.wo)), zero);
}

template <class Effects, class Real>
TANDEM_HD LobeWeights<Real> lobe_weights(const SceneView& scene, const Surface<Real>& surface,
                                         const ShadingFrame<Real>& shading, const Real& glossy) {
    using scatter_detail::largest;
    const Real zero(0.0F);
    LobeWeights<Real> weights = {zero, zero, glossy, zero};
    if (Effects::has(Effect::reflection)) weights.mirror = largest(surface.mirror);
    if (Effects::has(Effect::refraction)) weights.glass = surface.transmission;
    if (Effects::has(Effect::indirect) && scene.environment.indirect != 0) {
        weights.diffuse = select(shading.is_front, largest(surface.diffuse), zero);
    }
    return weights;
}

/// Chooses how a path continues: by mirror reflection, by a dielectric, by reflection from microfacets or, with
/// indirect light, by diffuse scattering. The probability of each is proportional to its share of the light, so for a
/// surface of one kind only the Fresnel reflectance is random. `glossy`: the glossy_weight(). Lanes that do not
/// continue leave path.alive; lanes not in it stay as they are. Returns the lanes whose media are lost (Interface).
///
/// Paths carry L / n^2, which interfaces leave unchanged; a camera in air sees L.
/// Source: J. Kajiya, "The Rendering Equation", SIGGRAPH 1986; one ray at a border after E. Veach's thesis, 1997, 5.2.
template <class Effects, class Real>
TANDEM_HD_STAGE Mask<Real> scatter(const SceneView& scene, const PathLimits& limits, const SampleId<Real>& sample,
                                   const UInt<Real>& vertex, const Surface<Real>& surface,
                                   const SurfacePoint<Real>& point, const ShadingFrame<Real>& shading,
                                   const Real& glossy, PathState<Effects, Real, true>& path) {
    using D = Double<Real>;
    using Word = UInt<Real>;
    using namespace scatter_detail;
    const Real zero(0.0F);
    const Word one(1U);
    Mask<Real> lost(false);
    const LobeWeights<Real> weights = lobe_weights<Effects>(scene, surface, shading, glossy);
    const Real &mirror = weights.mirror, &glass = weights.glass, &diffuse = weights.diffuse;
    path.alive = path.alive && (mirror > zero || glass > zero || glossy > zero || diffuse > zero);
    const Mask<Real> active = path.alive;
    if (!any(active)) return lost;

    PhiloxBlock<Word> random;
    if (Effects::has_any(Effect::refraction | Effect::indirect | Effect::microfacets)) {
        random = sample.block_at_vertex(Dimension::scatter, vertex);
    }
    const Real total = weights.total();
    const Real place = has_choice<Effects>() ? to_unit_interval<Real>(random.word[0]) * total : zero;
    const Mask<Real> takes_mirror =
        path.alive && mirror > zero && (place < mirror || (glass == zero && glossy == zero && diffuse == zero));
    const Mask<Real> takes_glass =
        path.alive && !takes_mirror && glass > zero && (place < mirror + glass || (glossy == zero && diffuse == zero));
    const Mask<Real> takes_glossy = path.alive && !takes_mirror && !takes_glass && glossy > zero &&
                                    (place < (mirror + glass) + glossy || diffuse == zero);
    const Mask<Real> takes_diffuse = path.alive && !takes_mirror && !takes_glass && !takes_glossy;
    const Real share = select(takes_glass, glass, select(takes_glossy, glossy, diffuse));
    const Real chance = select(takes_mirror, mirror, share) / total;
    Mask<Real> goes_through(false);
    Vec3<D> direction = shading.direction;
    if (Effects::has(Effect::refraction) && any(takes_glass)) {
        auto media = path.media;
        const Interface<Real> border =
            cross_interface<Effects>(scene, media, surface.material, shading.from_inside, takes_glass);
        lost = border.lost;
        const D eta = refractive_index<Real>(scene, border.before, takes_glass) /
                      refractive_index<Real>(scene, border.behind, takes_glass);
        const Refraction<Real> refraction = refracted(shading, eta);
        const D reflectance = fresnel_dielectric(refraction, eta);
        goes_through = takes_glass && !(widen(to_unit_interval<Real>(random.word[1])) < reflectance);
        path.media = select(goes_through, media, path.media);
        direction = select(goes_through, refraction.direction, direction);
        path.throughput = select(takes_glass, path.throughput * (glass / chance), path.throughput);
        path.refractions = path.refractions + select(goes_through, one, Word(0U));
    }
    const Mask<Real> bounces_off = path.alive && !goes_through && !takes_diffuse;
    const Mask<Real> is_mirrored = bounces_off && !takes_glossy;
    if (any(is_mirrored)) direction = select(is_mirrored, mirrored(shading), direction);
    if (Effects::has(Effect::reflection) && any(takes_mirror)) {
        const Vec3<Real> weight = {surface.mirror.x / chance, surface.mirror.y / chance, surface.mirror.z / chance};
        path.throughput = select(takes_mirror, path.throughput * weight, path.throughput);
    }
    if (Effects::has_any(Effect::indirect | Effect::microfacets)) {
        path.pdf = select(active, D(0.0), path.pdf);
        if (Effects::has(Effect::area_lights) && scene.area_light_count > 0) {
            path.sampled_from = select(active, point.position, path.sampled_from);
        }
    }
    if (Effects::has(Effect::microfacets) && any(takes_glossy)) {
        const LobeSample<Real> drawn = sample_facets(surface, point, shading, sample, vertex);
        direction = select(takes_glossy, drawn.wi, direction);
        path.pdf = select(takes_glossy, -(drawn.pdf * widen(chance)), path.pdf);
        const Vec3<Real> weight = {drawn.weight.x / chance, drawn.weight.y / chance, drawn.weight.z / chance};
        path.throughput = select(takes_glossy, path.throughput * weight, path.throughput);
        const Mask<Real> below = takes_glossy && !(drawn.valid && dot(direction, shading.facing) > D(0.0));
        path.alive = path.alive && !below;
    }
    if (Effects::has(Effect::indirect)) {
        if (any(takes_diffuse)) {
            const auto at = sample.block_at_vertex(Dimension::hemisphere, vertex);
            const auto drawn = sample_cosine_hemisphere<Real>(shading.normal, widen(to_unit_interval<Real>(at.word[0])),
                                                              widen(to_unit_interval<Real>(at.word[1])));
            direction = select(takes_diffuse, drawn.direction, direction);
            path.pdf = select(takes_diffuse, drawn.pdf, path.pdf);
            // the cosine and Lambert's 1 / pi cancel with the density
            Vec3<Real> reflectance = surface.diffuse;
            if (Effects::has(Effect::microfacets) && any(takes_diffuse && surface.has_microfacets)) {
                const auto coated = coated_reflectance(surface, point, drawn.direction, -shading.direction);
                reflectance = select(surface.has_microfacets, coated, reflectance);
            }
            const Vec3<Real> weight = {reflectance.x / chance, reflectance.y / chance, reflectance.z / chance};
            path.throughput = select(takes_diffuse, path.throughput * weight, path.throughput);
            path.scatterings = path.scatterings + select(takes_diffuse, one, Word(0U));
            // where the shading normal leads through the surface there is no light
            const Mask<Real> below = takes_diffuse && !(dot(direction, shading.facing) > D(0.0));
            path.alive = path.alive && !below && path.scatterings <= Word(limits.diffuse);
        }
    }
    path.reflections = path.reflections + select(bounces_off, one, Word(0U));
    path.alive =
        path.alive && path.reflections <= Word(limits.reflection) && path.refractions <= Word(limits.refraction);
    const Mask<Real> plays = active && Word(scene.roulette_from) <= vertex;
    if (Effects::has(Effect::roulette) && any(plays)) {
        const Real least(0.05F);
        const Real chance_to_live = select(plays, survival_probability(path.throughput, least), Real(1.0F));
        path.alive = path.alive && survives<Real>(widen(chance_to_live), widen(to_unit_interval<Real>(random.word[2])));
        path.throughput = {path.throughput.x / chance_to_live, path.throughput.y / chance_to_live,
                           path.throughput.z / chance_to_live};
    }
    // The side follows from the choice: rounding could decide that of a direction close to the surface.
    const Mask<Real> inside = select(goes_through, !shading.from_inside, shading.from_inside);
    path.ray.origin = select(active, departure(point, inside), path.ray.origin);
    path.ray.direction = select(active, to_real<Real>(direction), path.ray.direction);
    path.source.primitive = select(active, point.primitive, path.source.primitive);
    path.source.inside = select(active, inside, path.source.inside);
    path.forget_holes(scene, active);
    // a ray of the tier fast may have left the range of float
    if (is_fast<Real>) path.alive = path.alive && is_traceable(path.ray);
    return lost && path.alive;
}

}  // namespace tandem
