#include "tandem/render/ray_cost.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>

#include "tandem/base/parallel.h"
#include "tandem/kernel/shapes/box.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

constexpr int grid = 4;
constexpr std::uint64_t most_looked_at = 1U << 16;

std::array<Ray<double>, grid * grid> rays_over(const CameraView& camera, int width, int height) {
    std::array<Ray<double>, grid * grid> rays;
    for (int i = 0; i < grid * grid; ++i) {
        const double x = (i % grid + 0.5) * width / grid;
        const double y = (i / grid + 0.5) * height / grid;  // NOLINT(bugprone-integer-division): the row
        rays[static_cast<std::size_t>(i)] = camera_ray<double>(camera, x, y, 0.0, 0.0);
    }
    return rays;
}

}  // namespace

double bounds_per_ray(const PreparedScene& scene, int width, int height) {
    const DefaultFpEnvironment guard;
    const SceneView scene_view = view(scene);
    const std::uint64_t count = primitive_count(scene_view);
    const std::uint64_t looked_at = std::min(count, most_looked_at);
    if (looked_at == 0) return 0;
    const auto rays = rays_over(camera_view(scene.camera, width, height), width, height);
    std::atomic<std::uint64_t> crossings = 0;
    for_each_chunk(looked_at, 1U << 13, [&](const Chunk& chunk) {
        std::uint64_t of_chunk = 0;
        for (std::uint64_t i = chunk.begin; i < chunk.end; ++i) {
            // one of each range of ids, but not always the first: ids may follow a pattern
            const std::uint64_t first = i * count / looked_at;
            const std::uint64_t length = (i + 1) * count / looked_at - first;
            const Aabb box = primitive_bounds(scene_view, static_cast<std::uint32_t>(first + i * 40503 % length));
            for (const Ray<double>& ray : rays) {
                const auto crossing = cross_box(Box{box.lower, box.upper}, ray);
                of_chunk += crossing.crosses && crossing.t_far >= 0;
            }
        }
        crossings += of_chunk;
    });
    const double share = static_cast<double>(crossings.load()) / static_cast<double>(looked_at * rays.size());
    return share * static_cast<double>(count);
}

int affordable_samples(int samples, double bounds_per_ray) {
    if (!(bounds_per_ray > most_bounds_per_ray)) return samples;
    return std::max(1, static_cast<int>(samples * (most_bounds_per_ray / bounds_per_ray)));
}

PathLimits affordable_limits(const PathLimits& limits, int samples, double bounds_per_ray) {
    if (!(bounds_per_ray > samples * most_bounds_per_ray)) return limits;
    return {std::min(limits.reflection, 1U), std::min(limits.refraction, 1U), 0};
}

}  // namespace tandem
