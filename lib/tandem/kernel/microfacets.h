/// Surfaces of microfacets in the path loop: from world space to the local frame of their lobes and back.
#pragma once

#include "tandem/kernel/bsdf/metallic_roughness.h"
#include "tandem/kernel/incident_light.h"
#include "tandem/kernel/sampler/mis.h"
#include "tandem/kernel/surface.h"
#include "tandem/math/frame.h"

namespace tandem {

/// The lobes of a surface in its shading frame, and the viewer there.
template <class Real>
struct FacetView {
    MetallicRoughnessLobes<Real> lobes;
    Frame<Double<Real>> frame;
    Vec3<Double<Real>> wo;  ///< to the viewer, local, unit
    Mask<Real> shows;       ///< not the back of a single-sided surface, which is black
};

/// Where interpolation or a normal map turns the shading normal away from a viewer who is in front of the surface, the
/// surface looks as from the same angle before it: else silhouettes would have black borders.
template <class Real>
TANDEM_HD FacetView<Real> view_facets(const Surface<Real>& surface, const SurfacePoint<Real>& point,
                                      const Vec3<Double<Real>>& to_viewer) {
    using D = Double<Real>;
    FacetView<Real> view;
    view.lobes = {{surface.f0, Ggx<Real>(surface.alpha, surface.alpha)}, {{surface.diffuse}, surface.border}};
    view.frame = frame_around(surface.normal);
    view.wo = to_frame(view.frame, to_viewer);
    const Mask<Real> behind = view.wo.z < D(0.0F);
    view.shows = surface.has_microfacets && !(behind && point.from_inside);
    view.wo.z = greater(absolute(view.wo.z), D(0x1p-30F));
    return view;
}

/// What the surface makes of light from one direction: pi f cos times `light`, so that a diffuse reflectance is as
/// bright as Phong's. `diffuse_share`: of the diffuse part that counts. The glossy part shares the light with paths
/// that follow its lobe, in the lanes of `followed`: the direction was sampled with density `pdf`.
template <class Real>
TANDEM_HD_STAGE Vec3<Real> facets_light(const Surface<Real>& surface, const SurfacePoint<Real>& point,
                                        const Vec3<Real>& light, const Vec3<Double<Real>>& to_light,
                                        const Vec3<Double<Real>>& to_viewer, const Real& diffuse_share,
                                        const Double<Real>& pdf, const FollowedLobes<Real>& followed) {
    using D = Double<Real>;
    const FacetView<Real> view = view_facets(surface, point, to_viewer);
    const Vec3<D> wi = to_frame(view.frame, to_light);
    Real glossy_share(1.0F);
    if (any(followed.glossy)) {
        const D other = view.lobes.specular.pdf(view.wo, wi) * widen(followed.glossy_chance);
        glossy_share = select(followed.glossy, to_real<Real>(power_heuristic(pdf, other)), glossy_share);
    }
    const Vec3<Real> f =
        view.lobes.specular.f(view.wo, wi) * glossy_share + view.lobes.diffuse.f(view.wo, wi) * diffuse_share;
    const Real cosine = to_real<Real>(greater(wi.z, D(0.0F)) * constant<D>(pi));
    return select(view.shows, f * cosine * light, black<Real>());
}

/// pi f of the diffuse lobe: its reflectance less what the border above it takes.
template <class Real>
TANDEM_HD_STAGE Vec3<Real> coated_reflectance(const Surface<Real>& surface, const SurfacePoint<Real>& point,
                                              const Vec3<Double<Real>>& to_light, const Vec3<Double<Real>>& to_viewer) {
    const FacetView<Real> view = view_facets(surface, point, to_viewer);
    return view.lobes.diffuse.f(view.wo, to_frame(view.frame, to_light)) * constant<Real>(pi);
}

}  // namespace tandem
