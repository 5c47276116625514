/// The planes of a film beside its colour: what the samples of a pixel hit first. A separate pass over the same camera
/// rays computes them, so that the path loop does not depend on them.
#pragma once

#include "tandem/film/film_planes.h"
#include "tandem/kernel/pixel.h"

namespace tandem {

/// The effects that change camera rays, what they pass through, or the surface that they hit.
using FirstHitEffects =
    EffectSet<(Effect::lens | Effect::cutouts | Effect::textures | Effect::normal_maps | effects_of_lobes).bits()>;

/// The planes that this pass fills.
inline constexpr PlaneMask first_hit_planes =
    FilmPlane::albedo | FilmPlane::normal | FilmPlane::depth | FilmPlane::primitive | FilmPlane::material;

/// A pixel's values, as in FilmPlanes.
template <class Real>
struct FirstHits {
    using Sum = Vec3<Wide<Real>>;
    Sum albedo = {Wide<Real>(0.0), Wide<Real>(0.0), Wide<Real>(0.0)};
    Sum normal = albedo;
    // of the first sample
    Double<Real> depth = Double<Real>(__builtin_huge_val());
    UInt<Real> primitive = UInt<Real>(no_primitive);
    UInt<Real> material = UInt<Real>(no_primitive);
};

/// The albedo of a surface: the sum of the colours of its lobes, at most 1.
template <class Real>
TANDEM_HD Vec3<Real> albedo_of(const Surface<Real>& surface) {
    LobeSum<Vec3<Real>> sum(black<Real>());
    for_each_lobe<FirstHitEffects>(surface.reflectance.lobes, [&](const auto& lobe, auto) { sum.add(lobe.colour()); });
    const Real one(1.0F);
    return {lesser(sum.value().x, one), lesser(sum.value().y, one), lesser(sum.value().z, one)};
}

/// Adds the first surface that a sample hit, in the lanes of `drawn`. `is_first`: it is the first sample. The depth is
/// t itself: camera rays have length 1 along the view axis (kernel/camera/camera.h), and lenses move their origins
/// across it.
template <class Real>
TANDEM_HD void add(const Surface<Real>& surface, const Closest<Real>& hit, const Mask<Real>& drawn, bool is_first,
                   FirstHits<Real>& hits) {
    const typename FirstHits<Real>::Sum none = {Wide<Real>(0.0), Wide<Real>(0.0), Wide<Real>(0.0)};
    hits.albedo = hits.albedo + select(drawn, to_wide(albedo_of(surface)), none);
    hits.normal = hits.normal + select(drawn, to_wide(surface.normal), none);
    if (!is_first) return;
    hits.depth = select(drawn, hit.t, hits.depth);
    hits.primitive = select(drawn, hit.primitive, hits.primitive);
    hits.material = select(drawn, surface.material, hits.material);
}

/// The values of pixel (x, y), over all samples in their order, in the lanes of `active`. The camera rays are those of
/// render_pixel().
template <class Real, class Tracer>
TANDEM_HD FirstHits<Real> find_first_hits(const Tracer& tracer, const SceneView& scene, const PixelJob& job,
                                          const UInt<Real>& x, const UInt<Real>& y, const Mask<Real>& active) {
    SampleId<Real> id = sample_of<Real>(job, x, y, UInt<Real>(job.first_sample));
    FirstHits<Real> hits;
    PathTally<Real> tally;
    for (std::uint32_t sample = 0; sample < job.samples; ++sample) {
        id.sample = UInt<Real>(job.first_sample + sample);
        PathState<FirstHitEffects, Real> path;
        path.begin(scene, sample_ray<FirstHitEffects, Real>(job, id, x, y), active);
        while (any(path.alive)) {
            const Closest<Real> hit = next_hit<FirstHitEffects>(tracer, path, tally);
            const Mask<Real> found = path.alive && hit.primitive != UInt<Real>(no_primitive);
            path.alive = Mask<Real>(false);
            if (!any(found)) break;
            Vertex<Real> vertex;
            step_to_vertex<FirstHitEffects, Tracer::kinds>(scene, path.ray, path.source, hit, found, vertex);
            add(vertex.surface, hit, found && vertex.surface.opaque, sample == 0, hits);
            continue_through_mask(hit, found && !vertex.surface.opaque, path);
        }
    }
    return hits;
}

/// Writes the values of lane i to the requested planes, at a pixel.
template <class Real>
TANDEM_HD void keep(const FirstHits<Real>& hits, int i, std::size_t pixel, const FilmPlanes& planes) {
    const auto of_lane = [i](const auto& sum) { return Vec3d{lane(sum.x, i), lane(sum.y, i), lane(sum.z, i)}; };
    if (planes.albedo != nullptr) planes.albedo[pixel] = of_lane(hits.albedo);
    if (planes.normal != nullptr) planes.normal[pixel] = of_lane(hits.normal);
    if (planes.depth != nullptr) planes.depth[pixel] = to_plain(lane(hits.depth, i));
    if (planes.primitive != nullptr) planes.primitive[pixel] = lane(hits.primitive, i);
    if (planes.material != nullptr) planes.material[pixel] = lane(hits.material, i);
}

}  // namespace tandem
