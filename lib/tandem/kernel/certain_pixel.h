/// The samples of a pixel with the filter box, where a CertainView makes most of them cheap.
///
/// In strict and precise the bits are those of render_pixel(). In the tier fast they are not: there the light of a hit
/// is computed in float, and that of the background from the mean height of the rays.
#pragma once

#include "tandem/kernel/certain_light.h"
#include "tandem/kernel/pixel.h"
#include "tandem/kernel/pixel_culling.h"
#include "tandem/math/over_root.h"

namespace tandem {

/// The directions of a pixel's camera rays, as sample_ray() gives them. The steps are 2^-24 of those of PixelRays, and
/// offsets are whole numbers: neither rounds, because the steps of a view are 0 or far above the smallest floats. In
/// the tier fast, offsets are of 32 random bits instead of 24, rounded, which saves a shift. `is_level`: only x of the
/// direction changes along rows, and only y along columns. Then the other products are zeros, which change nothing but
/// the sign of a zero.
template <class Real, bool is_level>
struct PixelDirections {
    Vec3<Real> corner, dx, dy;

    TANDEM_HD_INLINE explicit PixelDirections(const PixelRays<Real>& rays)
        : corner(rays.direction), dx(rays.dx * Real(unit)), dy(rays.dy * Real(unit)) {}

    /// Of the sample `id`.
    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> of(const SampleId<Real>& id) const {
        const auto random = id.block(Dimension::film);
        const Real x = offset(random.word[0]), y = offset(random.word[1]);
        if constexpr (is_level) {
            return {corner.x + dx.x * x, corner.y + dy.y * y, corner.z};
        } else {
            return corner + (dx * x + dy * y);
        }
    }

  private:
    static constexpr float unit = is_fast<Real> ? 0x1p-32F : 0x1p-24F;
    [[nodiscard]] TANDEM_HD_INLINE static Real offset(const UInt<Real>& random) {
        if constexpr (is_fast<Real>) {
            return Real(static_cast<float>(random));
        } else {
            return from_uint<Real>(random >> 8);
        }
    }
};

/// Calls f with the directions of pixel (x, y), whose film is level or not.
template <class Real, class F>
TANDEM_HD_INLINE PixelSum<Real> with_directions(const PixelJob& job, std::uint32_t x, std::uint32_t y, const F& f) {
    PixelRays<Real> rays = rays_of_pixel<Real>(job, x, y);
    const Real zero(0.0F);
    if (rays.dx.y == zero && rays.dx.z == zero && rays.dy.x == zero && rays.dy.z == zero) {
        return f(PixelDirections<Real, true>(rays));
    }
    return f(PixelDirections<Real, false>(rays));
}

/// The y of a unit vector in a direction.
template <class Real>
TANDEM_HD_INLINE Real height_of(const Vec3<Real>& direction) {
    return over_root(direction.y, dot(direction, direction));
}

/// The sum over the samples of a pixel whose rays hit nothing. Needs: is_finite_sky. Several samples at once hide each
/// other's latency.
template <class Effects, class Real>
TANDEM_HD_INLINE PixelSum<Real> render_sky(const SceneView& scene, const PixelJob& job, std::uint32_t x,
                                           std::uint32_t y) {
    return with_directions<Real>(job, x, y, [&](const auto& directions) {
        SampleId<Real> id = sample_of<Real>(job, x, y, job.first_sample);
        PixelSum<Real> result;
        if constexpr (is_fast<Real>) {
            // the gradient is affine in the height, so that of the mean is the mean
            constexpr std::uint32_t group = 4;
            const auto heights_of = [&](std::uint32_t first, std::uint32_t count) {
                Real sum(0.0F);
#if TANDEM_ON_DEVICE
#pragma unroll
#endif
                for (std::uint32_t i = 0; i < count; ++i) {
                    id.sample = job.first_sample + first + i;
                    sum = sum + height_of(directions.of(id));
                }
                return to_wide(sum);
            };
            double sum = 0.0;
            std::uint32_t sample = 0;
            for (; sample + group <= job.samples; sample += group) sum = sum + heights_of(sample, group);
            for (; sample < job.samples; ++sample) sum = sum + heights_of(sample, 1);
            const double samples = job.samples;
            result.sum = gradient<double>(scene.environment, sum / samples) * samples;
        } else {
#if TANDEM_ON_DEVICE
#pragma unroll 4
#endif
            for (std::uint32_t sample = 0; sample < job.samples; ++sample) {
                id.sample = job.first_sample + sample;
                result.sum = result.sum + to_wide(gradient(scene.environment, height_of(directions.of(id))));
            }
        }
        return result;
    });
}

/// One sample by the general code, out of line.
template <class Effects, class Real = float, class Tracer>
TANDEM_HD_CALL Vec3<Real> careful_radiance(const Tracer* tracer, const SceneView* scene, const PixelJob* job,
                                           std::uint32_t x, std::uint32_t y, std::uint32_t sample) {
    const SampleId<Real> id = sample_of<Real>(*job, x, y, sample);
    PathTally<Real> tally;
    return sample_radiance<Effects>(*tracer, *scene, *job, rays_of_pixel<Real>(*job, x, y), id, true,
                                    IndependentThreads(), tally);
}

namespace certain_detail {

/// The threads of a warp that are at the same place now.
class Companions {
  public:
#if TANDEM_ON_DEVICE
    TANDEM_HD_INLINE Companions() : mask_(__activemask()) {}
    [[nodiscard]] TANDEM_HD_INLINE bool any(bool a) const { return __any_sync(mask_, a) != 0; }

  private:
    unsigned int mask_;
#else
    [[nodiscard]] TANDEM_HD_INLINE bool any(bool a) const { return a; }
#endif
};

}  // namespace certain_detail

/// render_certain_pixel() for slots that are few_slots or not.
template <class Effects, class Real, bool among_few, class Tracer>
TANDEM_HD_INLINE PixelSum<Real> render_among_slots(const Tracer& tracer, const CertainView& view,
                                                   const SceneView& scene, const PixelJob& job, std::uint32_t x,
                                                   std::uint32_t y, std::uint32_t slots) {
    using Light = std::conditional_t<is_fast<Real>, Real, double>;
    return with_directions<Real>(job, x, y, [&](const auto& directions) {
        SampleId<Real> id = sample_of<Real>(job, x, y, job.first_sample);
        PixelSum<Real> result;
        const certain_detail::Companions companions;
        std::uint32_t sample = 0;
        while (true) {
            Vec3<Real> radiance = broadcast<Real>(Vec3f{0, 0, 0});
            bool certain = true;
            TANDEM_KEEP_LOOP
            for (; sample < job.samples; ++sample) {
                id.sample = job.first_sample + sample;
                const Vec3<Real> direction = directions.of(id);
                const Vec3f plain = to_plain(direction);
                const CertainHit hit = certain_hit<among_few>(view, plain, slots);
                if (hit.slot == CertainHit::none) {
                    radiance = gradient(scene.environment, height_of(direction));
                } else {
                    certain = hit.slot != CertainHit::unsure && certain_light<Light>(view, plain, hit, radiance);
                }
                // All threads leave the loop when one of them is not certain: with the call in the loop, nvcc would
                // keep the loop's values in memory.
                if (companions.any(!certain)) break;
                result.sum = result.sum + to_wide(radiance);  // a view is valid only if its light is finite
            }
            if (sample == job.samples) return result;
            if (!certain) radiance = careful_radiance<Effects, Real>(&tracer, &scene, &job, x, y, id.sample);
            add(radiance, result);
            ++sample;
        }
    });
}

/// render_pixel() for a valid view, without effects. `slots`: the solids that its rays may hit.
template <class Effects, class Real = float, class Tracer>
TANDEM_HD_INLINE PixelSum<Real> render_certain_pixel(const Tracer& tracer, const CertainView& view,
                                                     const SceneView& scene, const PixelJob& job, std::uint32_t x,
                                                     std::uint32_t y, std::uint32_t slots) {
    if ((slots & view.slots & ~CertainView::few_slots) == 0) {
        return render_among_slots<Effects, Real, true>(tracer, view, scene, job, x, y, slots);
    }
    return render_among_slots<Effects, Real, false>(tracer, view, scene, job, x, y, slots);
}

}  // namespace tandem
