/// Converts a RenderJob to what kernels read.
#pragma once

#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/pixel.h"
#include "tandem/render/render_job.h"

namespace tandem {

[[nodiscard]] inline PixelJob make_pixel_job(const PreparedCamera& camera, const RenderJob& job) {
    const FilmWindow window = window_of(job);
    return {.camera = camera_view(camera, job.width, job.height, reach_of(job.filter)),
            .keys = philox_keys(job.seed),
            .sampler = make_job_sampler(job.sampler, job.seed, job.frame),
            .frame = job.frame,
            .first_sample = static_cast<std::uint32_t>(job.first_sample),
            .samples = static_cast<std::uint32_t>(job.samples),
            .width = static_cast<std::uint32_t>(window.width),
            .limits = job.limits,
            .film_width = static_cast<std::uint32_t>(job.width),
            .left = static_cast<std::uint32_t>(window.left),
            .top = static_cast<std::uint32_t>(window.top),
            .filter = job.filter};
}

/// The job for the planes of first hits: only the first sample if no plane is a mean.
[[nodiscard]] inline PixelJob first_hit_job(PixelJob job, PlaneMask planes) {
    if (!planes.has_any(planes_by(PlaneRule::mean))) job.samples = 1;
    return job;
}

}  // namespace tandem
