/// Follows paths from vertex to vertex, and renders the samples of a pixel one after the other, or those that it is
/// given.
#pragma once

#include <tuple>

#include "tandem/kernel/pixel.h"

namespace tandem {

/// A path in each lane, one vertex at a time. A lane has no pixel before take(), and none after the last sample of its
/// pixel. A lane or thread starts its next sample as soon as its path ends: it waits for the others at each vertex, not
/// at each sample (docs/performance/paths.md). The caller sums the radiance of the paths.
template <class Effects, class Real>
class PathWalk {
  public:
    /// Starts pixel (x, y), in the lanes of `active`.
    TANDEM_HD void take(const PixelJob& job, const UInt<Real>& x, const UInt<Real>& y, const Mask<Real>& active) {
        x_ = select(active, x, x_);
        y_ = select(active, y, y_);
        sample_ = select(active, UInt<Real>(job.first_sample), sample_);
        working_ = working_ || active;
    }

    /// Starts one sample of pixel (x, y), in the lanes of `active`, until stop().
    TANDEM_HD void take_sample(const UInt<Real>& x, const UInt<Real>& y, const UInt<Real>& sample,
                               const Mask<Real>& active) {
        x_ = select(active, x, x_);
        y_ = select(active, y, y_);
        sample_ = select(active, sample, sample_);
        working_ = working_ || active;
    }
    /// The same for a walk without a path. It also begins the path, so find_next() follows. It sets the state of all
    /// lanes, so that most of it is known to the compiler.
    TANDEM_HD void begin_sample(const SceneView& scene, const PixelJob& job, const UInt<Real>& x, const UInt<Real>& y,
                                const UInt<Real>& sample, const Mask<Real>& active) {
        x_ = x;
        y_ = y;
        sample_ = sample;
        begin(scene, sample_ray<Effects, Real>(job, id(job), x, y), Mask<Real>(true));
        working_ = path_.alive = active;
    }
    TANDEM_HD void stop(const Mask<Real>& ended) { working_ = working_ && !ended; }

    /// The lanes that have a pixel with samples left.
    [[nodiscard]] TANDEM_HD const Mask<Real>& working() const { return working_; }
    /// Its place in the window.
    [[nodiscard]] TANDEM_HD UInt<Real> pixel(const PixelJob& job) const { return y_ * UInt<Real>(job.width) + x_; }
    /// The lanes whose ray starts on a surface, not at the camera.
    [[nodiscard]] TANDEM_HD Mask<Real> leaves_surface() const { return path_.alive && vertex_ > UInt<Real>(0U); }
    /// The radiance of the path so far, RGB, linear; complete when leave() says that it has ended.
    [[nodiscard]] TANDEM_HD const Vec3<Real>& radiance() const { return radiance_; }

    /// The first half of a step: the next hit of each path. Where a path has ended, it starts that of the next sample.
    template <class Tracer>
    TANDEM_HD Closest<Real> find(const Tracer& tracer, const SceneView& scene, const PixelJob& job,
                                 PathTally<Real>& tally) {
        begin_next(scene, job);
        return find_next(tracer, tally);
    }
    /// The first part of find(): begins the next paths.
    TANDEM_HD void begin_next(const SceneView& scene, const PixelJob& job) {
        const Mask<Real> begins = working_ && !path_.alive;
        if (any(begins)) begin(scene, sample_ray<Effects, Real>(job, id(job), x_, y_), begins);
    }
    /// The second part: the next hit of each path that has begun.
    template <class Tracer>
    TANDEM_HD Closest<Real> find_next(const Tracer& tracer, PathTally<Real>& tally) {
        return next_hit<Effects, Real>(tracer, path_, tally);
    }

    /// The second half: the vertex at `hit`. Returns which paths have ended. `threads`: how they wait for each other
    /// (threads.h).
    template <class Tracer, class Threads = IndependentThreads>
    TANDEM_HD Mask<Real> leave(const Tracer& tracer, const SceneView& scene, const PixelJob& job,
                               const Closest<Real>& hit, PathTally<Real>& tally, const Threads& threads = {}) {
        using Word = UInt<Real>;
        advance<Effects>(tracer, scene, Effects::limits(job.limits), id(job), vertex_, hit, threads, path_, radiance_,
                         tally);
        vertex_ = vertex_ + Word(1U);
        const Mask<Real> ended = working_ && !path_.alive;
        sample_ = sample_ + select(ended, Word(1U), Word(0U));
        working_ = working_ && sample_ < Word(job.first_sample + job.samples);
        return ended;
    }

    /// References to all values per lane, except those that only some scenes need.
    TANDEM_HD auto per_lane() {
        auto& [r, g, b] = radiance_;
        return std::tuple_cat(std::tie(x_, y_, sample_, vertex_, working_, r, g, b), path_.per_lane());
    }
    TANDEM_HD auto per_lane_of_masks() { return path_.per_lane_of_masks(); }
    TANDEM_HD auto per_lane_of_lights() { return path_.per_lane_of_lights(); }

  private:
    [[nodiscard]] TANDEM_HD SampleId<Real> id(const PixelJob& job) const {
        return sample_of<Real>(job, x_, y_, sample_);
    }

    TANDEM_HD void begin(const SceneView& scene, const Ray<Real>& ray, const Mask<Real>& begins) {
        const Real zero(0.0F);
        path_.begin(scene, ray, begins);
        radiance_ = select(begins, Vec3<Real>{zero, zero, zero}, radiance_);
        vertex_ = select(begins, UInt<Real>(0U), vertex_);
    }

    UInt<Real> x_ = UInt<Real>(0U), y_ = UInt<Real>(0U);
    UInt<Real> sample_ = UInt<Real>(0U);
    UInt<Real> vertex_ = UInt<Real>(0U);
    Mask<Real> working_ = Mask<Real>(false);
    Vec3<Real> radiance_ = {Real(0.0F), Real(0.0F), Real(0.0F)};
    PathState<Effects, Real> path_;
};

}  // namespace tandem
