/// One pixel: its samples, added in order.
#pragma once

#include "tandem/integrator/path.h"
#include "tandem/sampler/dimensions.h"

namespace tandem {

/// What a kernel needs of a RenderJob.
struct PixelJob {
    CameraView camera;
    std::uint64_t seed;
    std::uint32_t frame;
    std::uint32_t first_sample, samples;
    std::uint32_t width;  ///< pixels; a pixel's number is y * width + x
    PathLimits limits;
};

template <class Real>
TANDEM_HD Mask<Real> is_finite(const Vec3<Real>& a) {
    const auto finite = [](const Real& x) { return absolute(x) <= Real(3.402823466e38F); };
    return finite(a.x) && finite(a.y) && finite(a.z);
}

template <class Real>
struct PixelSum {
    Vec3<Wide<Real>> sum = {Wide<Real>(0.0), Wide<Real>(0.0), Wide<Real>(0.0)};  ///< over all samples, in their order
    UInt<Real> invalid = UInt<Real>(0U);     ///< samples that were NaN or infinite: counted, not added
    UInt<Real> lost_media = UInt<Real>(0U);  ///< see PathResult
};

/// The camera ray of a sample. `Effects`: what is simulated (effects/effects.h).
template <class Effects, class Real>
TANDEM_HD Ray<Real> sample_ray(const PixelJob& job, const SampleId<Real>& id, const UInt<Real>& x,
                               const UInt<Real>& y) {
    using D = Double<Real>;
    const auto random = id.block(Dimension::film);
    const Ray<Real> ray = camera_ray(job.camera, from_uint<D>(x), from_uint<D>(y),
                                     to_unit_interval<Real>(random.word[0]), to_unit_interval<Real>(random.word[1]));
    if (!Effects::has(Effect::lens) || !job.camera.has_lens) return ray;
    const auto at = id.block(Dimension::lens);
    return through_lens(job.camera, ray, to_unit_interval<Real>(at.word[0]), to_unit_interval<Real>(at.word[1]));
}

/// Adds what paths have brought, in the lanes of `ended`.
template <class Real>
TANDEM_HD void add(const PathResult<Real>& path, const Mask<Real>& ended, PixelSum<Real>& pixel) {
    using W = Wide<Real>;
    using Word = UInt<Real>;
    const W zero(0.0);
    const Mask<Real> valid = is_finite(path.radiance);
    const Vec3<W> addend = to_wide(path.radiance);
    pixel.sum = pixel.sum + select(ended && valid, addend, Vec3<W>{zero, zero, zero});
    pixel.invalid = pixel.invalid + select(ended && !valid, Word(1U), Word(0U));
    pixel.lost_media = pixel.lost_media + select(ended, path.lost_media, Word(0U));
}

/// The sum over the samples of pixel (x, y): in double, in the order of the samples, by one owner; this order is
/// what makes films equal. A Real of many lanes renders one pixel per lane, in the lanes of `active`. Where paths
/// bounce, a lane of a packet and a thread of a warp go on with their next sample as soon as a path ends, and wait for
/// the others at each vertex, not at each sample (docs/performance.md).
template <class Effects, class Real, class Tracer>
TANDEM_HD PixelSum<Real> render_pixel(const Tracer& tracer, const SceneView& scene, const PixelJob& job,
                                      const UInt<Real>& x, const UInt<Real>& y, const Mask<Real>& active) {
    using Word = UInt<Real>;
    const Real zero(0.0F);
    const PathResult<Real> nothing = {{zero, zero, zero}};
    const PathLimits limits = Effects::limits(job.limits);
    SampleId<Real> id = {job.seed, job.frame, y * Word(job.width) + x, Word(job.first_sample)};
    PixelSum<Real> result;
    if constexpr (!can_bounce<Effects>()) {
        for (std::uint32_t sample = 0; sample < job.samples; ++sample) {
            id.sample = Word(job.first_sample + sample);
            PathState<Effects, Real> path(scene, sample_ray<Effects, Real>(job, id, x, y), active);
            PathResult<Real> brought = nothing;
            advance<Effects>(tracer, scene, limits, id, Word(0U), path, brought);
            add(brought, Mask<Real>(true), result);
        }
        return result;
    } else {
        const Word end(job.first_sample + job.samples);
        PathState<Effects, Real> path(scene, sample_ray<Effects, Real>(job, id, x, y), active);
        PathResult<Real> brought = nothing;
        Mask<Real> working = active;
        Word vertex(0U);
        while (true) {
            advance<Effects>(tracer, scene, limits, id, vertex, path, brought);
            vertex = vertex + Word(1U);
            const Mask<Real> ended = working && !path.alive;
            if (!any(ended)) continue;
            add(brought, ended, result);
            id.sample = id.sample + select(ended, Word(1U), Word(0U));
            working = working && id.sample < end;
            if (!any(working)) return result;
            const Mask<Real> begins = ended && working;
            const PathState<Effects, Real> fresh(scene, sample_ray<Effects, Real>(job, id, x, y), begins);
            path = select(begins, fresh, path);
            brought.radiance = select(begins, nothing.radiance, brought.radiance);
            brought.lost_media = select(begins, nothing.lost_media, brought.lost_media);
            vertex = select(begins, Word(0U), vertex);
        }
    }
}

}  // namespace tandem
