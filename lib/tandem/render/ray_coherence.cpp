#include "tandem/render/ray_coherence.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tandem/math/lengths.h"

namespace tandem {

namespace {

constexpr std::size_t group_size = 32;  ///< a warp
constexpr std::size_t most_groups = 64;
constexpr std::size_t packet_size = 16;

/// Calls visit(group) for up to `most_groups` groups of `size` consecutive rays, at equal steps through the batch.
/// Returns their number.
template <class Visit>
std::size_t for_some_groups(std::span<const Ray<float>> rays, std::size_t size, const Visit& visit) {
    const std::size_t groups = rays.size() / size, tried = std::min(groups, most_groups);
    for (std::size_t i = 0; i < tried; ++i) visit(rays.subspan(groups * i / tried * size, size));
    return tried;
}

Vec3d unit(const Vec3f& v) {
    const Vec3d d = widen(v);
    return d * (1 / square_root(dot(d, d)));
}

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

constexpr std::size_t least_row = 16, most_row = 65536, least_rows = 8;
constexpr std::size_t row_step = 8;  ///< the width of a tile
constexpr std::size_t row_samples = 32;

/// Of origins, relative to the size of the scene, and of unit directions.
double distance(const Ray<float>& a, const Ray<float>& b, float reach) {
    const Vec3d turn = unit(a.direction) - unit(b.direction);
    return (norm1(widen(a.origin) - widen(b.origin)) / widen(reach)) + norm1(turn);
}

/// How much farther a ray is from the one `step` places on than from the next one, from 0 (not at all) to 1; the mean
/// over some places.
double unlikeness(std::span<const Ray<float>> rays, float reach, std::size_t step) {
    double sum = 0;
    for (std::size_t i = 0; i < row_samples; ++i) {
        // places that do not depend on the length of rows: multiples of the golden ratio, modulo 1
        const double place = static_cast<double>(i) * 0.6180339887498949;
        const auto at =
            static_cast<std::size_t>((place - std::floor(place)) * static_cast<double>(rays.size() - step - 1));
        const double next = distance(rays[at], rays[at + 1], reach), other = distance(rays[at], rays[at + step], reach);
        const double share = other / (next + other);
        sum += share >= 0 ? share : 0.5;  // NaN: rays that cannot be traced, or that are equal
    }
    return sum / row_samples;
}

}  // namespace

bool are_coherent(std::span<const Ray<float>> rays, float reach) {
    std::size_t coherent = 0;
    const std::size_t tried = for_some_groups(rays, group_size, [&](std::span<const Ray<float>> group) {
        if (is_coherent_group(group, reach)) ++coherent;
    });
    return tried == 0 || 2 * coherent > tried;
}

double packet_width(std::span<const Ray<float>> rays, const Aabb& bounds) {
    const Vec3d lower = widen(bounds.lower), upper = widen(bounds.upper);
    const Vec3d middle = (lower + upper) * 0.5, half = (upper - lower) * 0.5;
    std::vector<double> widths;
    for_some_groups(rays, packet_size, [&](std::span<const Ray<float>> packet) {
        const Vec3d first = widen(packet.front().origin), last = widen(packet.back().origin);
        const double away = greater(length(middle - first), length(half));
        const double width =
            length(last - first) + away * length(unit(packet.back().direction) - unit(packet.front().direction));
        widths.push_back(width >= 0 ? width : 0);  // NaN: rays that cannot be traced
    });
    if (widths.empty()) return 0;
    const auto median = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
    std::nth_element(widths.begin(), median, widths.end());
    return *median;
}

std::uint32_t row_length(std::span<const Ray<float>> rays, float reach) {
    const std::size_t count = rays.size();
    if (count < least_rows * least_row) return 0;
    // rays far apart in the batch: if the next ones are no more alike than those, the rays have no order
    if (unlikeness(rays, reach, count / 2 + count / 7) < 0.75) return 0;
    std::size_t best = 0;
    double least = 0.63;
    for (std::size_t row = least_row; row <= most_row && least_rows * row <= count; row += row_step) {
        if (count % row != 0) continue;
        const double found = unlikeness(rays, reach, row);
        if (found < 0.95 * least) {
            least = found;
            best = row;
        }
    }
    return static_cast<std::uint32_t>(best);
}

}  // namespace tandem
