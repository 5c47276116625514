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
    std::uint32_t samples;
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
    Vec3<Wide<Real>> sum;   ///< over all samples, in their order
    UInt<Real> invalid;     ///< samples that were NaN or infinite: counted, not added
    UInt<Real> lost_media;  ///< see PathResult
};

/// The sum over the samples of pixel (x, y): in double, in the order of the samples, by one owner; this order is
/// what makes films equal. A Real of many lanes renders one pixel per lane. `Effects`: what is simulated
/// (effects/effects.h).
template <class Effects, class Real, class Tracer>
TANDEM_HD PixelSum<Real> render_pixel(const Tracer& tracer, const SceneView& scene, const PixelJob& job,
                                      const UInt<Real>& x, const UInt<Real>& y, const Mask<Real>& active) {
    using D = Double<Real>;
    const UInt<Real> pixel = y * UInt<Real>(job.width) + x;
    using W = Wide<Real>;
    const D pixel_x = from_uint<D>(x);
    const D pixel_y = from_uint<D>(y);
    const W zero(0.0);
    PixelSum<Real> result = {{zero, zero, zero}, UInt<Real>(0U), UInt<Real>(0U)};
    for (std::uint32_t sample = 0; sample < job.samples; ++sample) {
        const SampleId<Real> id = {job.seed, job.frame, pixel, sample};
        const auto random = id.block(Dimension::film);
        const Real offset_x = to_unit_interval<Real>(random.word[0]);
        const Real offset_y = to_unit_interval<Real>(random.word[1]);
        const Ray<Real> ray = camera_ray(job.camera, pixel_x, pixel_y, offset_x, offset_y);
        const PathResult<Real> path = trace_path<Effects>(tracer, scene, job.limits, id, ray, active);
        const Mask<Real> valid = is_finite(path.radiance);
        const Vec3<W> addend = to_wide(path.radiance);
        result.sum = result.sum + select(valid, addend, Vec3<W>{zero, zero, zero});
        result.invalid = result.invalid + select(valid, UInt<Real>(0U), UInt<Real>(1U));
        result.lost_media = result.lost_media + path.lost_media;
    }
    return result;
}

}  // namespace tandem
