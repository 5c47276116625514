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
    UInt<Real> rays = UInt<Real>(0U);        ///< see PathResult

    /// Begins anew, in the lanes of `active`.
    TANDEM_HD void clear(const Mask<Real>& active) {
        using W = Wide<Real>;
        const UInt<Real> none(0U);
        const W zero(0.0);
        sum = select(active, Vec3<W>{zero, zero, zero}, sum);
        invalid = select(active, none, invalid);
        lost_media = select(active, none, lost_media);
        rays = select(active, none, rays);
    }
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
    pixel.rays = pixel.rays + select(ended, path.rays, Word(0U));
}

/// The samples of a pixel whose paths go on from vertex to vertex, one vertex at a time, summed as render_pixel() does;
/// of many pixels, a Real of many lanes. Has no pixel at first. A lane, or a thread, goes on with its next sample as
/// soon as a path ends, and waits for the others at each vertex, not at each sample (docs/performance.md).
template <class Effects, class Real>
class PixelWalk {
  public:
    /// Takes pixel (x, y), in the lanes of `active`.
    TANDEM_HD void take(const PixelJob& job, const UInt<Real>& x, const UInt<Real>& y, const Mask<Real>& active) {
        using Word = UInt<Real>;
        x_ = select(active, x, x_);
        y_ = select(active, y, y_);
        id_.seed = job.seed;
        id_.frame = job.frame;
        id_.pixel = y_ * Word(job.width) + x_;
        id_.sample = select(active, Word(job.first_sample), id_.sample);
        sum_.clear(active);
        working_ = working_ || active;
        begins_ = begins_ || active;
    }

    /// Which pixels have samples left?
    [[nodiscard]] TANDEM_HD const Mask<Real>& working() const { return working_; }
    [[nodiscard]] TANDEM_HD const PixelSum<Real>& sum() const { return sum_; }
    [[nodiscard]] TANDEM_HD const UInt<Real>& pixel() const { return id_.pixel; }

    /// To the next vertex of each path.
    template <class Tracer>
    TANDEM_HD void step(const Tracer& tracer, const SceneView& scene, const PixelJob& job) {
        using Word = UInt<Real>;
        if (any(begins_)) begin_path(scene, job);
        advance<Effects>(tracer, scene, Effects::limits(job.limits), id_, vertex_, path_, brought_);
        vertex_ = vertex_ + Word(1U);
        begins_ = working_ && !path_.alive;
        if (!any(begins_)) return;
        add(brought_, begins_, sum_);
        id_.sample = id_.sample + select(begins_, Word(1U), Word(0U));
        working_ = working_ && id_.sample < Word(job.first_sample + job.samples);
        begins_ = begins_ && working_;
    }

  private:
    TANDEM_HD void begin_path(const SceneView& scene, const PixelJob& job) {
        using Word = UInt<Real>;
        const Real zero(0.0F);
        path_.begin(scene, sample_ray<Effects, Real>(job, id_, x_, y_), begins_);
        brought_.radiance = select(begins_, Vec3<Real>{zero, zero, zero}, brought_.radiance);
        brought_.lost_media = select(begins_, Word(0U), brought_.lost_media);
        brought_.rays = select(begins_, Word(0U), brought_.rays);
        vertex_ = select(begins_, Word(0U), vertex_);
    }

    UInt<Real> x_ = UInt<Real>(0U), y_ = UInt<Real>(0U);
    SampleId<Real> id_ = {0, 0, UInt<Real>(0U), UInt<Real>(0U)};
    UInt<Real> vertex_ = UInt<Real>(0U);
    PathState<Effects, Real> path_;
    PathResult<Real> brought_ = {{Real(0.0F), Real(0.0F), Real(0.0F)}};
    PixelSum<Real> sum_;
    Mask<Real> working_ = Mask<Real>(false);
    Mask<Real> begins_ = Mask<Real>(false);
};

/// The sum over the samples of pixel (x, y), for paths that end at their first vertex: in double, in the order of the
/// samples, by one owner; this order is what makes films equal. A Real of many lanes renders one pixel per lane, in the
/// lanes of `active`.
template <class Effects, class Real, class Tracer>
TANDEM_HD PixelSum<Real> render_pixel(const Tracer& tracer, const SceneView& scene, const PixelJob& job,
                                      const UInt<Real>& x, const UInt<Real>& y, const Mask<Real>& active) {
    const Real zero(0.0F);
    SampleId<Real> id = {job.seed, job.frame, y * UInt<Real>(job.width) + x, UInt<Real>(job.first_sample)};
    PixelSum<Real> result;
    for (std::uint32_t sample = 0; sample < job.samples; ++sample) {
        id.sample = UInt<Real>(job.first_sample + sample);
        PathState<Effects, Real, can_bounce<Effects>()> path;
        path.begin(scene, sample_ray<Effects, Real>(job, id, x, y), active);
        PathResult<Real> brought = {{zero, zero, zero}};
        advance<Effects>(tracer, scene, Effects::limits(job.limits), id, UInt<Real>(0U), path, brought);
        add(brought, Mask<Real>(true), result);
    }
    return result;
}

}  // namespace tandem
