#include "tandem/oracle/oracle.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "tandem/base/error.h"
#include "tandem/base/seconds.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/first_hit.h"
#include "tandem/math/fp_environment.h"
#include "tandem/oracle/oracle_path.h"
#include "tandem/render/complete_planes.h"
#include "tandem/render/pixel_job.h"
#include "tandem/render/ready_frame.h"
#include "tandem/render/traced_job.h"

namespace tandem {

namespace {

using oracle::BoundedView;
using oracle::Line;
using oracle::nearest_surface;
using oracle::NearestSurface;
using oracle::Real;
using oracle::Vector;

/// `T`: float or double.
template <class T>
Line line_of(const Ray<T>& ray) {
    return {oracle::to_vector(ray.origin), oracle::to_vector(ray.direction)};
}

/// Whether it has a finite float.
bool is_float(Real a) { return std::isfinite(static_cast<float>(a)); }

class OracleScene final : public ResidentScene {
  public:
    OracleScene(const PreparedScene& scene, Tier tier)
        : ResidentScene(tier),
          prepared(without_copies(scene)),
          copies(scene.copies),
          balls_(oracle::balls_around(view(prepared))) {}
    [[nodiscard]] PhaseTimes load_times() const override { return {}; }
    [[nodiscard]] BoundedView bounded() const { return {view(prepared), balls_.data()}; }
    PreparedScene prepared;
    std::vector<PrimitiveCopy> copies;  ///< removed from the scene

  private:
    std::vector<oracle::Ball> balls_;
};

class OracleBackend final : public Backend {
  public:
    explicit OracleBackend(const BackendOptions& options) : threads_(options.threads) {
        if (threads_ < 0) throw InputError("the number of threads must be 0 (one per core) or more");
        if (threads_ == 0) threads_ = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    }

    [[nodiscard]] std::string name() const override { return "oracle"; }
    [[nodiscard]] Capabilities capabilities() const override {
        return {.device = fmt::format("{} threads", threads_),
                .description = "brute force, 64-bit significands",
                .exact = false};
    }
    [[nodiscard]] std::shared_ptr<ResidentScene> load(const PreparedScene& scene, Tier tier) override {
        if (!scene.instances.empty()) return load(written_out(scene, only_cuda_keeps_instances), tier);
        return std::make_shared<OracleScene>(scene, tier);
    }

    double trace(ResidentScene& scene, const TraceJob& job) override {
        const DefaultFpEnvironment guard;
        check(job);
        const auto& resident = dynamic_cast<const OracleScene&>(scene);
        return trace_without_copies(resident.copies, job,
                                    [&](const TraceJob& traced) { return trace(resident.bounded(), traced); });
    }

    [[nodiscard]] std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                       const RenderJob& job) override {
        const DefaultFpEnvironment guard;
        check(job, scene->tier());
        const auto& resident = dynamic_cast<const OracleScene&>(*scene);
        const PreparedScene& prepared = resident.prepared;
        const PixelJob pixel_job = make_pixel_job(prepared.camera, job);
        const BoundedView scene_view = resident.bounded();
        RenderResult result;
        const FilmWindow window = window_of(job);
        result.film = Film(window.width, window.height, job.samples, job.planes);
        std::atomic<std::uint64_t> invalid = 0;
        const Stopwatch watch;
        for_each_block(result.film.pixel_count(), 64, [&](std::size_t pixel) {
            const auto number = static_cast<std::uint32_t>(pixel);
            if (job.tier == Tier::precise) {
                render<double>(scene_view, pixel_job, number, result.film, invalid);
            } else {
                render<float>(scene_view, pixel_job, number, result.film, invalid);
            }
        });
        complete_planes(result.film, resident.copies);
        result.stats.seconds.render = watch.seconds();
        result.stats.rays = result.film.pixel_count() * pixel_job.samples;
        result.stats.effects = prepared.effects;
        result.stats.counters.invalid_samples = invalid;
        result.stats.counters.dropped_primitives = prepared.dropped_primitives;
        result.stats.counters.dropped_lights = prepared.dropped_lights;
        result.stats.variant = "brute force";
        return std::make_unique<ReadyFrame>(std::move(result));
    }

  private:
    [[nodiscard]] double trace(const BoundedView& scene, const TraceJob& job) const {
        const Stopwatch watch;
        std::atomic<std::uint64_t> rejected = 0;
        for_each_block(job.rays.size(), 256, [&](std::size_t i) {
            const RaySource source = job.sources.empty() ? RaySource{} : job.sources[i];
            const std::uint32_t except = job.ends.empty() ? no_primitive : job.ends[i].light;
            NearestSurface nearest;
            if (is_traceable(job.rays[i])) {
                nearest = nearest_surface(scene, line_of(job.rays[i]), source, except);
            } else {
                ++rejected;
            }
            const Real t = nearest.surface.t;
            if (!job.ends.empty()) {
                const bool occluded = nearest.primitive != no_primitive && t < Real{job.ends[i].t};
                job.hits[i] = {0, occluded ? some_primitive : no_primitive};
            } else {
                job.hits[i] = {static_cast<float>(t), nearest.primitive};
            }
            if (!job.wide_t.empty()) job.wide_t[i] = job.ends.empty() ? static_cast<double>(t) : 0;
        });
        if (job.counters != nullptr) job.counters->rejected_rays += rejected;
        return watch.seconds();
    }

    /// `T`: the type of the tier's camera rays.
    template <class T>
    static void render(const BoundedView& scene, const PixelJob& job, std::uint32_t pixel, Film& film,
                       std::atomic<std::uint64_t>& invalid) {
        const FilmPlanes planes = film.planes();
        const bool looks = film.plane_mask().has_any(first_hit_planes);
        Vector sum{0, 0, 0}, squares{0, 0, 0};
        const std::uint32_t x = pixel % job.width, y = pixel / job.width;
        for (std::uint32_t sample = 0; sample < job.samples; ++sample) {
            const SampleId<float> id = sample_of<float>(job, x, y, job.first_sample + sample);
            const auto random = id.block(Dimension::film);
            const Vec2<T> offset =
                sample_filter<T>(job.filter, to_unit_interval<T>(random.word[0]), to_unit_interval<T>(random.word[1]));
            Ray<T> ray = camera_ray<T>(job.camera, x + job.left, y + job.top, offset.x, offset.y);
            if (job.camera.has_lens) {
                const auto at = id.block(Dimension::lens);
                ray =
                    through_lens<T>(job.camera, ray, to_unit_interval<T>(at.word[0]), to_unit_interval<T>(at.word[1]));
            }
            const Vector value = oracle::trace_path(scene, job.limits, id, line_of(ray));
            if (is_float(value.x) && is_float(value.y) && is_float(value.z)) {
                sum = sum + value;
                squares = squares + oracle::times(value, value);
            } else {
                ++invalid;
            }
            if (looks) oracle::add_first_hit(scene, job.camera, line_of(ray), sample == 0, pixel, planes);
        }
        film.sums()[pixel] = narrowed(sum);
        if (planes.variance != nullptr) planes.variance[pixel] = narrowed(squares);
    }

    static Vec3d narrowed(const Vector& a) {
        return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
    }

    /// Calls f(i) for every i below count, in blocks distributed to the threads.
    template <class F>
    void for_each_block(std::size_t count, std::size_t block, F f) const {
        std::atomic<std::size_t> next = 0;
        const auto work = [&] {
            for (std::size_t first; (first = next.fetch_add(block)) < count;) {
                for (std::size_t i = first; i < std::min(first + block, count); ++i) f(i);
            }
        };
        std::vector<std::jthread> threads;
        for (int i = 1; i < threads_; ++i) threads.emplace_back(work);
        work();
    }

    int threads_;
};

}  // namespace

OracleHit oracle_trace(const PreparedScene& scene, const Ray<float>& ray, const RaySource& source) {
    if (!is_traceable(ray)) return {0, no_primitive};
    const NearestSurface nearest = nearest_surface({view(scene)}, line_of(ray), source);
    return {nearest.surface.t, nearest.primitive};
}

std::unique_ptr<Backend> make_oracle_backend(const BackendOptions& options) {
    return std::make_unique<OracleBackend>(options);
}

}  // namespace tandem
