/// The samples of a pixel, where a CertainView makes most of them cheap.
#pragma once

#include "tandem/kernel/certain_light.h"
#include "tandem/kernel/pixel.h"
#include "tandem/kernel/pixel_culling.h"
#include "tandem/math/over_root.h"

namespace tandem {

/// The sum over the samples of a pixel whose rays hit nothing. Needs: is_finite_sky. Several samples at once hide each
/// other's latency.
template <class Effects, class Real>
TANDEM_HD_INLINE PixelSum<Real> render_sky(const SceneView& scene, const PixelJob& job, std::uint32_t x,
                                           std::uint32_t y) {
    SampleId<Real> id = sample_of<Real>(job, x, y, job.first_sample);
    PixelRays<Real> rays = rays_of_pixel<Real>(job, x, y);
    rays.orthographic = false;  // no view of such a camera has a finite sky
    PixelSum<Real> result;
#if TANDEM_ON_DEVICE
#pragma unroll 4
#endif
    for (std::uint32_t sample = 0; sample < job.samples; ++sample) {
        id.sample = job.first_sample + sample;
        const Ray<Real> ray = sample_ray<Effects>(job, rays, id);
        const Real height = over_root(ray.direction.y, dot(ray.direction, ray.direction));
        result.sum = result.sum + to_wide(gradient(scene.environment, height));
    }
    return result;
}

/// One sample by the general code, out of line.
template <class Effects, class Tracer>
TANDEM_HD_COLD Vec3f careful_radiance(const Tracer* tracer, const SceneView* scene, const PixelJob* job,
                                      std::uint32_t x, std::uint32_t y, std::uint32_t sample) {
    const SampleId<float> id = sample_of<float>(*job, x, y, sample);
    PathTally<float> tally;
    return sample_radiance<Effects>(*tracer, *scene, *job, rays_of_pixel<float>(*job, x, y), id, true,
                                    IndependentThreads(), tally);
}

/// render_pixel() for a valid view, without effects: the same bits. `slots`: the solids that its rays may hit.
template <class Effects, class Tracer>
TANDEM_HD_INLINE PixelSum<float> render_certain_pixel(const Tracer& tracer, const CertainView& view,
                                                      const SceneView& scene, const PixelJob& job, std::uint32_t x,
                                                      std::uint32_t y, std::uint32_t slots) {
    SampleId<float> id = sample_of<float>(job, x, y, job.first_sample);
    PixelRays<float> rays = rays_of_pixel<float>(job, x, y);
    rays.orthographic = false;  // or the view is not valid
    PixelSum<float> result;
    TANDEM_KEEP_LOOP
    for (std::uint32_t sample = 0; sample < job.samples; ++sample) {
        id.sample = job.first_sample + sample;
        const Ray<float> ray = sample_ray<Effects>(job, rays, id);
        const CertainHit hit = certain_hit(view, ray.direction, slots);
        Vec3f radiance;
        bool certain = true;
        if (hit.slot == CertainHit::none) {
            radiance = background(scene.environment, ray.direction);
        } else {
            certain = hit.slot != CertainHit::unsure && certain_light(view, ray.direction, hit, radiance);
        }
        if (certain) {
            result.sum = result.sum + to_wide(radiance);  // a view is valid only if its light is finite
        } else {
            add(careful_radiance<Effects>(&tracer, &scene, &job, x, y, id.sample), result);
        }
    }
    return result;
}

}  // namespace tandem
