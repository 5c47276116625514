/// The state of a path between vertices: no more than its effects need.
#pragma once

#include <tuple>

#include "tandem/kernel/media/media.h"
#include "tandem/kernel/path_limits.h"
#include "tandem/kernel/sampler/dimensions.h"
#include "tandem/kernel/shapes/ray_source.h"

namespace tandem {

/// The state of a path that ends at its first vertex.
template <class Effects, class Real, bool bounces = can_bounce<Effects>()>
struct PathState {
    Ray<Real> ray;
    Mask<Real> alive;

    TANDEM_HD void begin(const SceneView&, const Ray<Real>& camera_ray, const Mask<Real>& active) {
        ray = camera_ray;
        alive = active;
    }
};

/// The state of a path that can continue.
template <class Effects, class Real>
struct PathState<Effects, Real, true> {
    using Media = std::conditional_t<Effects::most.has(Effect::nested_media), MediumStack<Real>, NoMediumStack<Real>>;

    Ray<Real> ray{};
    Mask<Real> alive;
    PathSource<Real> source{};
    Vec3<Real> throughput = {Real(1.0F), Real(1.0F), Real(1.0F)};
    UInt<Real> reflections = UInt<Real>(0U);
    UInt<Real> refractions = UInt<Real>(0U);
    UInt<Real> scatterings = UInt<Real>(0U);  ///< by diffuse surfaces
    UInt<Real> masked_hits = UInt<Real>(0U);
    /// The density of `ray`'s direction, 1/sr, if a diffuse lobe sampled it; minus the density for a glossy lobe; else
    /// 0.
    Double<Real> pdf = Double<Real>(0.0);
    Vec3<Real> sampled_from{};  ///< the point for which `pdf` holds; `ray` may start slightly above it
    Media media;

    /// No path yet.
    TANDEM_HD PathState() : alive(false) {}

    /// Starts a new path with a camera ray, in the lanes of `active`.
    TANDEM_HD void begin(const SceneView& scene, const Ray<Real>& camera_ray, const Mask<Real>& active) {
        using Word = UInt<Real>;
        const Word none(0U);
        const Real one(1.0F);
        ray.origin = select(active, camera_ray.origin, ray.origin);
        ray.direction = select(active, camera_ray.direction, ray.direction);
        alive = alive || active;
        source.primitive = select(active, Word(no_primitive), source.primitive);
        source.inside = source.inside && !active;
        forget_masked_hits(scene, active);
        throughput = select(active, Vec3<Real>{one, one, one}, throughput);
        reflections = select(active, none, reflections);
        refractions = select(active, none, refractions);
        scatterings = select(active, none, scatterings);
        masked_hits = select(active, none, masked_hits);
        pdf = select(active, Double<Real>(0.0), pdf);
        media = select(active, media_at_camera<Effects>(scene, Media()), media);
    }

    /// Of a new ray, in the lanes of `active`.
    TANDEM_HD void forget_masked_hits(const SceneView& scene, const Mask<Real>& active) {
        if (!Effects::has(Effect::cutouts) || has_no_masks(scene)) return;
        source.last_masked.t = select(active, Double<Real>(0.0), source.last_masked.t);
        source.last_masked.primitive = select(active, UInt<Real>(no_primitive), source.last_masked.primitive);
    }

    /// References to all values per lane, except those that only some scenes need.
    TANDEM_HD auto per_lane() {
        auto& [origin, direction] = ray;
        return std::tuple_cat(std::tie(origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, alive,
                                       source.primitive, source.inside, throughput.x, throughput.y, throughput.z,
                                       reflections, refractions, scatterings, masked_hits, pdf),
                              media.per_lane());
    }
    /// The others: for scenes with cutouts, and for scenes that combine paths and area lights.
    TANDEM_HD auto per_lane_of_masks() { return std::tie(source.last_masked.t, source.last_masked.primitive); }
    TANDEM_HD auto per_lane_of_lights() { return std::tie(sampled_from.x, sampled_from.y, sampled_from.z); }

    /// Applies the absorption along `ray` from the last masked hit to t, in the lanes of `active`. `own`: the current
    /// medium if solids are disjoint.
    TANDEM_HD void absorb(const SceneView& scene, const Double<Real>& t, const UInt<Real>& own,
                          const Mask<Real>& active) {
        using D = Double<Real>;
        if (!Effects::has(Effect::absorption)) return;
        const UInt<Real> medium = current_medium<Effects>(scene, media, own);
        if (!any(active && medium != UInt<Real>(no_medium))) return;
        const Vec3<D> direction = widen(ray.direction);
        const D segment = Effects::has(Effect::cutouts) ? t - source.last_masked.t : t;
        const D distance = segment * square_root(dot(direction, direction));
        throughput = throughput * transmittance<Real>(scene, medium, distance, active);
    }
};

}  // namespace tandem
