/// What a path carries from vertex to vertex: no more than its effects need.
#pragma once

#include "tandem/geometry/ray_source.h"
#include "tandem/integrator/media.h"
#include "tandem/integrator/path_limits.h"
#include "tandem/sampler/dimensions.h"

namespace tandem {

/// Of a path that ends at its first vertex.
template <class Effects, class Real, bool bounces = has_bounces<Effects>()>
struct PathState {
    Ray<Real> ray;
    Mask<Real> alive;

    TANDEM_HD PathState(const SceneView&, const Ray<Real>& camera_ray, const Mask<Real>& active)
        : ray(camera_ray), alive(active) {}
};

/// Of a path that goes on.
template <class Effects, class Real>
struct PathState<Effects, Real, true> {
    using Media = std::conditional_t<Effects::has(Effect::nested_media), MediumStack<Real>, NoMediumStack<Real>>;

    Ray<Real> ray;
    Mask<Real> alive;
    Source<Real> source{};
    Vec3<Real> throughput = {Real(1.0F), Real(1.0F), Real(1.0F)};
    UInt<Real> reflections = UInt<Real>(0U);
    UInt<Real> refractions = UInt<Real>(0U);
    Media media;

    TANDEM_HD PathState(const SceneView& scene, const Ray<Real>& camera_ray, const Mask<Real>& active)
        : ray(camera_ray), alive(active), media(media_at_camera(scene, Media())) {}

    /// Over the segment of `ray` that ends at t, in the lanes of `active`. `own`: the medium that the path is in if
    /// bodies lie apart.
    TANDEM_HD void absorb(const SceneView& scene, const Double<Real>& t, const UInt<Real>& own,
                          const Mask<Real>& active) {
        using D = Double<Real>;
        if (!Effects::has(Effect::absorption)) return;
        const UInt<Real> medium = current_medium(scene, media, own);
        if (!any(active && medium != UInt<Real>(no_medium))) return;
        const Vec3<D> direction = widen(ray.direction);
        const D distance = t * square_root(dot(direction, direction));
        throughput = throughput * transmittance<Real>(scene, medium, distance, active);
    }
};

}  // namespace tandem
