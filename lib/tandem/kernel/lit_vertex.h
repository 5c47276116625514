/// A vertex of a path as lights see it, and what it reflects of light from one direction.
#pragma once

#include "tandem/kernel/sampler/dimensions.h"
#include "tandem/kernel/sampler/mis.h"
#include "tandem/kernel/shading_frame.h"

namespace tandem {

/// The lobes that a path may follow at a vertex, and then hit lights by itself.
template <class Real>
struct FollowedLobes {
    Mask<Real> diffuse = Mask<Real>(false);
    Mask<Real> glossy = Mask<Real>(false);
    /// With which probability the path follows each glossy lobe, by glossy_number().
    Real chance[glossy_lobe_count];
};

/// A vertex that light is sampled for.
template <class Real>
struct LitVertex {
    const Surface<Real>& surface;
    const SurfacePoint<Real>& point;
    const Vec3<Double<Real>>& position;   ///< the same before rounding, on the ray
    const Vec3<Double<Real>>& to_viewer;  ///< unit
    const FollowedLobes<Real>& followed;
    const SampleId<Real>& sample;
    const UInt<Real>& number;  ///< of the vertex on its path
};

/// Do diffuse surfaces receive light from other surfaces?
template <class Effects>
TANDEM_HD bool has_indirect_light(const SceneView& scene) {
    return Effects::has(Effect::indirect) && scene.environment.indirect != 0;
}

/// Which lobes reflect a light?
enum class LobesShown {
    all,
    of_paths,  ///< those along which paths may continue: the others do not show what only paths see
};

/// What the radiance of a direction is multiplied by that was sampled with density `pdf`: see reflect_light().
template <class Real>
TANDEM_HD Real light_scale(const Double<Real>& pdf) {
    return to_real<Real>(constant<Double<Real>>(inverse_pi) / pdf);
}

/// Stands for the density of a direction that no path can find by itself.
struct OnlyDirection {};

namespace lit_vertex_detail {

/// The weight of a light's sample beside that of a path that follows `lobe`, and finds the light with the density
/// pdf_of(lobe). The density of a glossy lobe counts the choice of the lobe; that of a diffuse one does not, and
/// neither does share_of_found() (found_light.h).
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

/// The part of the lobes that work in the local frame.
template <class Effects, class Real, class Density>
TANDEM_HD_STAGE Vec3<Real> reflect_in_frame(const SceneView& scene, const LitVertex<Real>& at, const Vec3<Real>& light,
                                            const Vec3<Double<Real>>& to_light, const Density& pdf) {
    using D = Double<Real>;
    const LocalView<Real> view = local_view<Effects>(at.surface, at.point, at.to_viewer);
    const Vec3<D> wi = to_frame(view.frame, to_light);
    LobeSum<Vec3<Real>> f(black<Real>());
    for_each_lobe<Effects>(at.surface.reflectance.lobes, [&](const auto& lobe, auto place) TANDEM_INLINE_LAMBDA {
        using L = std::decay_t<decltype(lobe)>;
        if constexpr (is_local<L, Real>) {
            const Real share = share_of_sample<Effects, decltype(place)::value>(
                scene, at.followed, lobe, pdf,
                [&](const auto& of) TANDEM_INLINE_LAMBDA { return of.pdf(view.wo, wi); });
            f.add(lobe.f(view.wo, wi) * share);
        }
    });
    const Real cosine = to_real<Real>(greater(wi.z, D(0.0F)) * constant<D>(pi));
    return select(view.hidden, black<Real>(), f.value() * cosine * light);
}

}  // namespace lit_vertex_detail

/// What the surface at a vertex makes of light from one direction: pi f |cos| times `light`, summed over its lobes. In
/// these units of Phong's model a diffuse surface reflects reflectance * cos. So `light` is the intensity id = is of a
/// light without extent, or the radiance over pi `pdf`, the density that the direction was sampled with. Paths that
/// follow a lobe find a share of such a light by themselves.
///
/// `to_light`: unit, world space.
/// Source: B. T. Phong, "Illumination for Computer Generated Pictures", CACM 18(6), 1975; docs/paper.md row 3; for the
///         shares E. Veach, L. Guibas, 1995 (kernel/sampler/mis.h).
template <class Effects, LobesShown shown = LobesShown::all, class Real, class Density>
TANDEM_HD Vec3<Real> reflect_light(const SceneView& scene, const LitVertex<Real>& at, const Vec3<Real>& light,
                                   const Vec3<Double<Real>>& to_light, const Density& pdf) {
    LobeSum<Vec3<Real>> sum(black<Real>());
    Mask<Real> in_frame(false);
    for_each_lobe<Effects>(at.surface.reflectance.lobes, [&](const auto& lobe, auto place) TANDEM_INLINE_LAMBDA {
        using L = std::decay_t<decltype(lobe)>;
        constexpr int number = decltype(place)::value;
        if constexpr (has(L::flags, LobeFlags::specular) ||
                      (shown == LobesShown::of_paths && !is_ever_followed<number>)) {
            return;
        } else if constexpr (ReflectsInWorld<L, Real>) {
            const Real share = lit_vertex_detail::share_of_sample<Effects, number>(
                scene, at.followed, lobe, pdf,
                [&](const auto& of) TANDEM_INLINE_LAMBDA { return of.pdf_about(at.surface.normal, to_light); });
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
    for_each_lobe<Effects>(at.surface.reflectance.lobes, [&](const auto& lobe, auto) TANDEM_INLINE_LAMBDA {
        using L = std::decay_t<decltype(lobe)>;
        if constexpr (!has(L::flags, LobeFlags::diffuse)) {
            return;
        } else if constexpr (ReflectsInWorld<L, Real>) {
            sum.add(lobe.albedo(to_light));  // of any direction
        } else if (any(lobe.scatters())) {
            const LocalView<Real> view = local_view<Effects>(at.surface, at.point, at.to_viewer);
            sum.add(lobe.f(view.wo, to_frame(view.frame, to_light)) * constant<Real>(pi));
        }
    });
    return sum.value();
}

}  // namespace tandem
