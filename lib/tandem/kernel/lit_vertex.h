/// A path vertex for light sampling, and the light that it reflects from one direction.
#pragma once

#include "tandem/kernel/sampler/dimensions.h"
#include "tandem/kernel/sampler/mis.h"
#include "tandem/kernel/shading_frame.h"

namespace tandem {

/// The lobes along which a path may continue from a vertex, and so hit lights by itself.
template <class Real>
struct FollowedLobes {
    Mask<Real> diffuse = Mask<Real>(false);
    Mask<Real> glossy = Mask<Real>(false);
    /// The probability that the path follows each glossy lobe, by glossy_number().
    Real chance[glossy_lobe_count];
};

/// A vertex at which lights are sampled.
template <class Real>
struct LitVertex {
    const Surface<Real>& surface;
    const SurfacePoint<Real>& point;
    const Vec3<Double<Real>>& position;   ///< the point before rounding, on the ray
    const Vec3<Double<Real>>& to_viewer;  ///< unit
    const FollowedLobes<Real>& followed;
    const SampleId<Real>& sample;
    const UInt<Real>& number;  ///< of the vertex on its path
};

/// Whether diffuse surfaces receive light from other surfaces.
template <class Effects>
TANDEM_HD bool has_indirect_light(const SceneView& scene) {
    return Effects::has(Effect::indirect) && scene.indirect_light != 0;
}

/// The lobes that reflect a light.
enum class LobesShown {
    all,
    of_paths,  ///< only those along which paths may continue
};

/// The factor from radiance to the units of reflect_light(), for a direction that was sampled with density `pdf`.
template <class Real>
TANDEM_HD Real light_scale(const Double<Real>& pdf) {
    return to_real<Real>(constant<Double<Real>>(inverse_pi) / pdf);
}

/// Replaces the density for light that no path can find by itself.
struct OnlyDirection {};

namespace lit_vertex_detail {

/// The MIS weight of a light's sample against paths that follow `lobe`, which find the light with the density
/// pdf_of(lobe). The density of a glossy lobe includes the choice of the lobe. That of a diffuse lobe does not, here
/// and in share_of_found() (found_light.h).
template <class Effects, int place, class Lobe, class Real, class Density, class PdfOf>
TANDEM_HD Real share_of_sample(const SceneView& scene, const FollowedLobes<Real>& followed, const Lobe& lobe,
                               const Density& pdf, PdfOf pdf_of) {
    const Real whole(1.0F);
    if constexpr (std::is_same_v<Density, OnlyDirection> || !can_follow<Effects, place>()) {
        return whole;
    } else if constexpr (has(Lobe::flags, LobeFlags::diffuse)) {
        if (!has_indirect_light<Effects>(scene)) return whole;
        return select(followed.diffuse, to_real<Real>(power_heuristic(pdf, pdf_of(lobe))), whole);
    } else {
        if (!any(followed.glossy)) return whole;
        const auto other = pdf_of(lobe) * widen(followed.chance[glossy_number<place>]);
        return select(followed.glossy, to_real<Real>(power_heuristic(pdf, other)), whole);
    }
}

/// The sum over the lobes that work in the local frame.
template <class Effects, class Real, class Density>
TANDEM_HD_CALL_ON(host)
Vec3<Real> reflect_in_frame(const SceneView& scene, const LitVertex<Real>& at, const Vec3<Real>& light,
                            const Vec3<Double<Real>>& to_light, const Density& pdf) {
    using D = Double<Real>;
    const LocalView<Real> view = local_view<Effects>(at.surface, at.point, at.to_viewer);
    const Vec3<D> wi = to_frame(view.frame, to_light);
    LobeSum<Vec3<Real>> f(black<Real>());
    for_each_lobe<Effects>(at.surface.reflectance.lobes, [&](const auto& lobe, auto place) {
        using L = std::decay_t<decltype(lobe)>;
        if constexpr (is_local<L, Real>) {
            const Real share = share_of_sample<Effects, decltype(place)::value>(
                scene, at.followed, lobe, pdf, [&](const auto& of) { return of.pdf(view.wo, wi); });
            f.add(lobe.f(view.wo, wi) * share);
        }
    });
    const Real cosine = to_real<Real>(greater(wi.z, D(0.0F)) * constant<D>(pi));
    return select(view.hidden, black<Real>(), f.value() * cosine * light);
}

}  // namespace lit_vertex_detail

/// The light from one direction that the surface at a vertex reflects: pi f |cos| times `light`, summed over its lobes.
/// In these units, those of Phong's model, a diffuse surface reflects reflectance * cos. `light` is the intensity id =
/// is of a punctual light, or radiance / (pi `pdf`) for a direction that was sampled with density `pdf`. In the second
/// case the sum is weighted, since paths that follow a lobe find the rest by themselves.
///
/// `to_light`: unit, world space.
/// Source: B. T. Phong, "Illumination for Computer Generated Pictures", CACM 18(6), 1975; docs/paper.md row 3; for the
///         weights E. Veach, L. Guibas, 1995 (kernel/sampler/mis.h).
template <class Effects, LobesShown shown = LobesShown::all, class Real, class Density>
TANDEM_HD Vec3<Real> reflect_light(const SceneView& scene, const LitVertex<Real>& at, const Vec3<Real>& light,
                                   const Vec3<Double<Real>>& to_light, const Density& pdf) {
    LobeSum<Vec3<Real>> sum(black<Real>());
    Mask<Real> in_frame(false);
    for_each_lobe<Effects>(at.surface.reflectance.lobes, [&](const auto& lobe, auto place) {
        using L = std::decay_t<decltype(lobe)>;
        constexpr int number = decltype(place)::value;
        if constexpr (has(L::flags, LobeFlags::specular) ||
                      (shown == LobesShown::of_paths && !is_ever_followed<number>)) {
            return;
        } else if constexpr (ReflectsInWorld<L, Real>) {
            const Real share = lit_vertex_detail::share_of_sample<Effects, number>(
                scene, at.followed, lobe, pdf,
                [&](const auto& of) { return of.pdf_about(at.surface.normal, to_light); });
            sum.add(lobe.reflected_about(share, at.surface.normal, to_light, at.to_viewer));
        } else {
            in_frame = in_frame || lobe.scatters();
        }
    });
    const Vec3<Real> reflected = sum.value() * light;
    if constexpr (Effects::most.has_any(effects_of_local_lobes)) {
        if (any(in_frame)) {
            return reflected + lit_vertex_detail::reflect_in_frame<Effects>(scene, at, light, to_light, pdf);
        }
    }
    return reflected;
}

/// pi f of the diffuse lobes.
template <class Effects, class Real>
TANDEM_HD Vec3<Real> diffuse_reflectance(const LitVertex<Real>& at, const Vec3<Double<Real>>& to_light) {
    LobeSum<Vec3<Real>> sum(black<Real>());
    for_each_lobe<Effects>(at.surface.reflectance.lobes, [&](const auto& lobe, auto) {
        using L = std::decay_t<decltype(lobe)>;
        if constexpr (!has(L::flags, LobeFlags::diffuse)) {
            return;
        } else if constexpr (ReflectsInWorld<L, Real>) {
            sum.add(lobe.albedo(to_light));  // the direction does not matter
        } else if (any(lobe.scatters())) {
            const LocalView<Real> view = local_view<Effects>(at.surface, at.point, at.to_viewer);
            sum.add(lobe.f(view.wo, to_frame(view.frame, to_light)) * constant<Real>(pi));
        }
    });
    return sum.value();
}

}  // namespace tandem
