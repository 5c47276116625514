/// What a path carries from vertex to vertex: no more than its effects need.
#pragma once

#include "tandem/geometry/ray_source.h"
#include "tandem/integrator/media.h"
#include "tandem/integrator/path_limits.h"
#include "tandem/sampler/dimensions.h"

namespace tandem {

/// Of a path that ends at its first vertex.
template <class Effects, class Real, bool bounces = can_bounce<Effects>()>
struct PathState {
    Ray<Real> ray;
    Mask<Real> alive;

    TANDEM_HD PathState(const SceneView&, const Ray<Real>& camera_ray, const Mask<Real>& active)
        : ray(camera_ray), alive(active) {}
};

/// Of a path that goes on.
template <class Effects, class Real>
struct PathState<Effects, Real, true> {
    using Media = std::conditional_t<Effects::most.has(Effect::nested_media), MediumStack<Real>, NoMediumStack<Real>>;

    Ray<Real> ray;
    Mask<Real> alive;
    Source<Real> source{};
    Vec3<Real> throughput = {Real(1.0F), Real(1.0F), Real(1.0F)};
    UInt<Real> reflections = UInt<Real>(0U);
    UInt<Real> refractions = UInt<Real>(0U);
    UInt<Real> scatterings = UInt<Real>(0U);  ///< by matt surfaces
    UInt<Real> holes = UInt<Real>(0U);
    Double<Real> pdf = Double<Real>(0.0);  ///< of `ray`'s direction, 1/sr, if a matt surface chose it; else 0
    Media media;

    /// `a` in the lanes of `mask`, else `b`.
    TANDEM_HD friend PathState select(const Mask<Real>& mask, const PathState& a, const PathState& b) {
        PathState result = b;
        result.ray.origin = select(mask, a.ray.origin, b.ray.origin);
        result.ray.direction = select(mask, a.ray.direction, b.ray.direction);
        result.alive = select(mask, a.alive, b.alive);
        result.source.primitive = select(mask, a.source.primitive, b.source.primitive);
        result.source.inside = select(mask, a.source.inside, b.source.inside);
        result.throughput = select(mask, a.throughput, b.throughput);
        result.reflections = select(mask, a.reflections, b.reflections);
        result.refractions = select(mask, a.refractions, b.refractions);
        result.scatterings = select(mask, a.scatterings, b.scatterings);
        result.holes = select(mask, a.holes, b.holes);
        result.pdf = select(mask, a.pdf, b.pdf);
        result.media = select(mask, a.media, b.media);
        return result;
    }

    TANDEM_HD PathState(const SceneView& scene, const Ray<Real>& camera_ray, const Mask<Real>& active)
        : ray(camera_ray), alive(active), media(media_at_camera<Effects>(scene, Media())) {}

    /// Over the segment of `ray` that ends at t, in the lanes of `active`. `own`: the medium that the path is in if
    /// bodies lie apart.
    TANDEM_HD void absorb(const SceneView& scene, const Double<Real>& t, const UInt<Real>& own,
                          const Mask<Real>& active) {
        using D = Double<Real>;
        if (!Effects::has(Effect::absorption)) return;
        const UInt<Real> medium = current_medium<Effects>(scene, media, own);
        if (!any(active && medium != UInt<Real>(no_medium))) return;
        const Vec3<D> direction = widen(ray.direction);
        const D distance = t * square_root(dot(direction, direction));
        throughput = throughput * transmittance<Real>(scene, medium, distance, active);
    }
};

}  // namespace tandem
