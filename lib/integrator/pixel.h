/// One pixel: its samples, added in order.
#pragma once

#include "tandem/integrator/radiance.h"
#include "tandem/sampler/dimensions.h"

namespace tandem {

/// What a kernel needs of a RenderJob.
struct PixelJob {
    CameraView camera;
    std::uint64_t seed;
    std::uint32_t frame;
    std::uint32_t samples;
    std::uint32_t width;  ///< pixels; a pixel's number is y * width + x
};

template <class Real>
TANDEM_HD Mask<Real> is_finite(const Vec3<Real>& a) {
    const auto finite = [](const Real& x) { return absolute(x) <= Real(3.402823466e38F); };
    return finite(a.x) && finite(a.y) && finite(a.z);
}

template <class Real>
struct PixelSum {
    Vec3<Double<Real>> sum;  ///< over all samples, in their order
    UInt<Real> invalid;      ///< samples that were NaN or infinite: counted, not added
};

/// The sum over the samples of pixel (x, y): in double, in the order of the samples, by one owner; this order is
/// what makes films equal. A Real of many lanes renders one pixel per lane.
template <class Real, class Tracer>
TANDEM_HD PixelSum<Real> render_pixel(const Tracer& tracer, const SceneView& scene, const PixelJob& job,
                                      const UInt<Real>& x, const UInt<Real>& y, const Mask<Real>& active) {
    using D = Double<Real>;
    const UInt<Real> pixel = y * UInt<Real>(job.width) + x;
    const D pixel_x = widen(to_float(x));
    const D pixel_y = widen(to_float(y));
    PixelSum<Real> result = {{D(0.0), D(0.0), D(0.0)}, UInt<Real>(0U)};
    for (std::uint32_t sample = 0; sample < job.samples; ++sample) {
        const auto random = random_block<Real>(job.seed, job.frame, pixel, sample, Dimension::film);
        const Real offset_x = to_unit_interval<Real>(random.word[0]);
        const Real offset_y = to_unit_interval<Real>(random.word[1]);
        const Ray<Real> ray = camera_ray(job.camera, pixel_x, pixel_y, offset_x, offset_y);
        const Vec3<Real> value = radiance(tracer, scene, ray, active);
        const Mask<Real> valid = is_finite(value);
        const Vec3<D> addend = widen(value);
        const D zero(0.0);
        result.sum = result.sum + select(valid, addend, Vec3<D>{zero, zero, zero});
        result.invalid = result.invalid + select(valid, UInt<Real>(0U), UInt<Real>(1U));
    }
    return result;
}

}  // namespace tandem
