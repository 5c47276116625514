#include "tandem/render/ray_coherence.h"

#include <algorithm>

namespace tandem {

namespace {

constexpr std::size_t group_size = 32;  ///< a warp
constexpr std::size_t most_groups = 64;

bool is_coherent_group(std::span<const Ray<float>> rays, float reach) {
    const Vec3d origin = widen(rays.front().origin), direction = widen(rays.front().direction);
    const double length2 = dot(direction, direction);
    return std::all_of(rays.begin(), rays.end(), [&](const Ray<float>& ray) {
        const Vec3d other = widen(ray.direction), offset = widen(ray.origin) - origin;
        const double along = dot(direction, other);
        const bool is_close = dot(offset, offset) <= 0x1p-8 * widen(reach) * widen(reach);
        return is_close && along > 0 && along * along >= 0.8 * length2 * dot(other, other);
    });
}

}  // namespace

bool are_coherent(std::span<const Ray<float>> rays, float reach) {
    const std::size_t groups = rays.size() / group_size;
    if (groups == 0) return true;
    const std::size_t tried = std::min(groups, most_groups);
    std::size_t coherent = 0;
    for (std::size_t i = 0; i < tried; ++i) {
        const std::size_t first = groups * i / tried * group_size;
        if (is_coherent_group(rays.subspan(first, group_size), reach)) ++coherent;
    }
    return 2 * coherent > tried;
}

}  // namespace tandem
