#include "tandem/oracle/oracle.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "tandem/error/error.h"
#include "tandem/integrator/pixel_job.h"
#include "tandem/oracle/oracle_geometry.h"
#include "tandem/render/ready_frame.h"
#include "tandem/render/seconds.h"

namespace tandem {

namespace {

using oracle::Line;
using oracle::Real;
using oracle::SurfaceHit;
using oracle::Vector;

struct NearestSurface {
    SurfaceHit surface{};
    std::uint32_t primitive = no_primitive;
};

/// `T`: float or double.
template <class T>
Line line_of(const Ray<T>& ray) {
    return {oracle::to_vector(ray.origin), oracle::to_vector(ray.direction)};
}

NearestSurface nearest_surface(const SceneView& scene, const Line& line) {
    NearestSurface nearest;
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) {
        const auto hit = oracle::hit_primitive(scene, id, line);
        // ids ascend, so a tie keeps the lower one
        if (hit && (nearest.primitive == no_primitive || hit->t < nearest.surface.t)) nearest = {*hit, id};
    }
    return nearest;
}

Vector background_towards(const Environment& environment, const Vector& direction) {
    const Real m = (oracle::unit(direction).y + 1) / 2;
    return oracle::to_vector(environment.bottom) * (1 - m) + oracle::to_vector(environment.top) * m;
}

Vector times(const Vector& a, const Vector& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/// Phong's sum, written out once more from the paper's formula.
Vector shade(const SceneView& scene, const Line& line, const NearestSurface& nearest) {
    const PhongMaterial& material = scene.materials[scene.material_of[nearest.primitive]];
    const Vector point = line.origin + line.direction * nearest.surface.t;
    const Vector n = nearest.surface.normal;
    const Vector v = oracle::unit(line.direction) * -1;
    Vector sum = times(oracle::to_vector(material.ambient), oracle::to_vector(scene.environment.ambient));
    for (std::uint32_t i = 0; i < scene.light_count; ++i) {
        const Vector l = oracle::unit(oracle::to_vector(scene.lights[i].position) - point);
        const Vector r = n * (2 * oracle::inner(l, n)) - l;
        const Real diffuse = std::max<Real>(0, oracle::inner(l, n));
        const Real mirror = oracle::inner(r, v);
        const Real specular = mirror > 0 ? std::pow(std::min<Real>(1, mirror), Real{material.shininess}) : 0;
        sum =
            sum + times(oracle::to_vector(material.diffuse) * diffuse + oracle::to_vector(material.specular) * specular,
                        oracle::to_vector(scene.lights[i].intensity));
    }
    return sum;
}

class OracleScene final : public ResidentScene {
  public:
    OracleScene(const PreparedScene& scene, Tier tier) : ResidentScene(tier), prepared(scene) {}
    [[nodiscard]] PhaseTimes load_times() const override { return {}; }
    PreparedScene prepared;
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
        return std::make_shared<OracleScene>(scene, tier);
    }

    double trace(ResidentScene& scene, const TraceJob& job) override {
        check(job);
        const PreparedScene& prepared = dynamic_cast<const OracleScene&>(scene).prepared;
        const Stopwatch watch;
        for_each_block(job.rays.size(), 256, [&](std::size_t i) {
            const OracleHit hit = oracle_trace(prepared, job.rays[i]);
            job.hits[i] = {static_cast<float>(hit.t), hit.primitive};
            if (!job.wide_t.empty()) job.wide_t[i] = static_cast<double>(hit.t);
        });
        return watch.seconds();
    }

    [[nodiscard]] std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                       const RenderJob& job) override {
        check(job, scene->tier());
        const PreparedScene& prepared = dynamic_cast<const OracleScene&>(*scene).prepared;
        const PixelJob pixel_job = make_pixel_job(prepared, job);
        const SceneView scene_view = view(prepared);
        RenderResult result;
        result.film = Film(job.width, job.height, job.samples);
        const Stopwatch watch;
        for_each_block(result.film.pixel_count(), 64, [&](std::size_t pixel) {
            const auto number = static_cast<std::uint32_t>(pixel);
            result.film.sums()[pixel] = job.tier == Tier::precise ? render<double>(scene_view, pixel_job, number)
                                                                  : render<float>(scene_view, pixel_job, number);
        });
        result.stats.seconds.render = watch.seconds();
        result.stats.rays = result.film.pixel_count() * pixel_job.samples;
        result.stats.variant = "brute force";
        return std::make_unique<ReadyFrame>(std::move(result));
    }

  private:
    /// `T`: what the tier's camera rays are given in.
    template <class T>
    static Vec3d render(const SceneView& scene, const PixelJob& job, std::uint32_t pixel) {
        Vector sum{0, 0, 0};
        for (std::uint32_t sample = 0; sample < job.samples; ++sample) {
            const auto random = random_block<float>(job.seed, job.frame, pixel, sample, Dimension::film);
            const Line line =
                line_of(camera_ray<T>(job.camera, pixel % job.width, pixel / job.width,
                                      to_unit_interval<T>(random.word[0]), to_unit_interval<T>(random.word[1])));
            const NearestSurface nearest = nearest_surface(scene, line);
            sum = sum + (nearest.primitive == no_primitive ? background_towards(scene.environment, line.direction)
                                                           : shade(scene, line, nearest));
        }
        return {static_cast<double>(sum.x), static_cast<double>(sum.y), static_cast<double>(sum.z)};
    }

    /// Calls f(i) for every i below count, in blocks shared among the threads.
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

OracleHit oracle_trace(const PreparedScene& scene, const Ray<float>& ray) {
    if (!is_traceable(ray)) return {0, no_primitive};
    const NearestSurface nearest = nearest_surface(view(scene), line_of(ray));
    return {nearest.surface.t, nearest.primitive};
}

std::unique_ptr<Backend> make_oracle_backend(const BackendOptions& options) {
    return std::make_unique<OracleBackend>(options);
}

}  // namespace tandem
