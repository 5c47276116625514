/// One pixel: its samples, added in order.
#pragma once

#include "tandem/kernel/path.h"
#include "tandem/kernel/sampler/dimensions.h"
#include "tandem/kernel/sampler/pixel_filter.h"

namespace tandem {

/// The part of a RenderJob that kernels need.
struct PixelJob {
    CameraView camera;
    PhiloxKeys keys;  ///< of the seed
    JobSampler sampler{};
    std::uint32_t frame;
    std::uint32_t first_sample, samples;
    std::uint32_t width;  ///< pixels of a row of the window; the pixels (x, y) of kernels are counted in the window
    PathLimits limits;
    // the window in the film
    std::uint32_t film_width;
    std::uint32_t left, top;
    // last, so that nvcc reads the other members together, as without this one
    PixelFilter filter = PixelFilter::box;
    std::uint32_t sharing_threads = 1;  ///< of a GPU: how many share a pixel in a hierarchy

    /// The number that keys the random numbers of a pixel: in the film, so the bits of a pixel do not depend on the
    /// window; for sobol_blue on a Morton curve.
    template <class Word>
    [[nodiscard]] TANDEM_HD_INLINE Word number_of(const Word& x, const Word& y) const {
        if (sampler_of(sampler) == Sampler::sobol_blue) return morton(x + Word(left), y + Word(top));
        return (y + Word(top)) * Word(film_width) + (x + Word(left));
    }
};

/// Sample `number` of pixel (x, y) of the window.
template <class Real>
TANDEM_HD_INLINE SampleId<Real> sample_of(const PixelJob& job, const UInt<Real>& x, const UInt<Real>& y,
                                          const UInt<Real>& number) {
    return {&job.keys, job.frame, job.number_of(x, y), number, job.sampler};
}

template <class Real>
TANDEM_HD Mask<Real> is_finite(const Vec3<Real>& a) {
    const auto finite = [](const Real& x) { return absolute(x) <= Real(3.402823466e38F); };
    return finite(a.x) && finite(a.y) && finite(a.z);
}

template <class Real>
struct PixelSum {
    Vec3<Wide<Real>> sum = {Wide<Real>(0.0), Wide<Real>(0.0), Wide<Real>(0.0)};  ///< of all samples, in their order
    UInt<Real> invalid = UInt<Real>(0U);  ///< samples that were NaN or infinite: counted, not added
    PathTally<Real> tally;
};

template <class Real>
TANDEM_HD PixelRays<Real> rays_of_pixel(const PixelJob& job, const UInt<Real>& x, const UInt<Real>& y) {
    using D = Double<Real>;
    return rays_of_pixel<Real>(job.camera, from_uint<D>(x + UInt<Real>(job.left)),
                               from_uint<D>(y + UInt<Real>(job.top)));
}

/// The camera ray of a sample. `rays`: of its pixel; `Effects`: what is simulated (effects/effects.h).
template <class Effects, class Real>
TANDEM_HD Ray<Real> sample_ray(const PixelJob& job, const PixelRays<Real>& rays, const SampleId<Real>& id) {
    const auto random = id.block(Dimension::film);
    const Vec2<Real> offset =
        sample_filter<Real>(job.filter, to_unit_interval<Real>(random.word[0]), to_unit_interval<Real>(random.word[1]));
    const Ray<Real> ray = rays.at(offset.x, offset.y);
    if (!Effects::has(Effect::lens) || !job.camera.has_lens) return ray;
    const auto at = id.block(Dimension::lens);
    return through_lens(job.camera, ray, to_unit_interval<Real>(at.word[0]), to_unit_interval<Real>(at.word[1]));
}
template <class Effects, class Real>
TANDEM_HD Ray<Real> sample_ray(const PixelJob& job, const SampleId<Real>& id, const UInt<Real>& x,
                               const UInt<Real>& y) {
    return sample_ray<Effects>(job, rays_of_pixel<Real>(job, x, y), id);
}

/// What a sample adds to its pixel.
template <class Real>
struct Addend {
    Vec3<Real> radiance;   ///< of the sample; zero where that is NaN or infinite
    Mask<Real> is_number;  ///< where it is neither
};
template <class Real>
TANDEM_HD Addend<Real> addend_of(const Vec3<Real>& radiance) {
    const Real zero(0.0F);
    const Mask<Real> is_number = is_finite(radiance);
    return {select(is_number, radiance, Vec3<Real>{zero, zero, zero}), is_number};
}

/// Adds the radiance of a sample. A call on the host: inline, the sums would take registers from the whole loop over
/// samples (docs/performance/before-and-after.md).
template <class Real>
TANDEM_HD_CALL_ON(host)
void add(const Vec3<Real>& radiance, PixelSum<Real>& pixel) {
    using Word = UInt<Real>;
    const Addend<Real> addend = addend_of(radiance);
    pixel.sum = pixel.sum + to_wide(addend.radiance);
    pixel.invalid = pixel.invalid + select(addend.is_number, Word(0U), Word(1U));
}

/// The radiance of a sample, for paths that end at their first vertex, in the lanes of `active`.
template <class Effects, class Real, class Tracer, class Threads>
TANDEM_HD Vec3<Real> sample_radiance(const Tracer& tracer, const SceneView& scene, const PixelJob& job,
                                     const PixelRays<Real>& rays, const SampleId<Real>& id, const Mask<Real>& active,
                                     const Threads& threads, PathTally<Real>& tally) {
    const Real zero(0.0F);
    PathState<Effects, Real, can_bounce<Effects>()> path;
    path.begin(scene, sample_ray<Effects>(job, rays, id), active);
    Vec3<Real> radiance = {zero, zero, zero};
    const Closest<Real> hit = next_hit<Effects, Real>(tracer, path, tally);
    advance<Effects>(tracer, scene, Effects::limits(job.limits), id, UInt<Real>(0U), hit, threads, path, radiance,
                     tally);
    return radiance;
}

/// The sum over the samples of pixel (x, y), for paths that end at their first vertex. One thread adds them in double,
/// in their order: so films have equal bits. A Real of many lanes renders one pixel per lane, in the lanes of `active`.
/// `threads`: how they wait for each other (threads.h).
template <class Effects, class Real, class Tracer, class Threads = IndependentThreads>
TANDEM_HD PixelSum<Real> render_pixel(const Tracer& tracer, const SceneView& scene, const PixelJob& job,
                                      const UInt<Real>& x, const UInt<Real>& y, const Mask<Real>& active,
                                      const Threads& threads = {}) {
    SampleId<Real> id = sample_of<Real>(job, x, y, UInt<Real>(job.first_sample));
    const PixelRays<Real> rays = rays_of_pixel<Real>(job, x, y);
    PixelSum<Real> result;
    for (std::uint32_t sample = 0; sample < job.samples; ++sample) {
        id.sample = UInt<Real>(job.first_sample + sample);
        add(sample_radiance<Effects>(tracer, scene, job, rays, id, active, threads, result.tally), result);
    }
    return result;
}

}  // namespace tandem
