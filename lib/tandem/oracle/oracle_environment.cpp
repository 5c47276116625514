#include "tandem/oracle/oracle_environment.h"

#include <algorithm>
#include <cmath>

namespace tandem::oracle {

namespace {

/// Interpolated linearly in azimuth between the centres of columns, and in height between those of rows.
Vector picture_towards(const SceneView& scene, const Vector& d) {
    const EnvironmentPicture& picture = scene.environment_picture;
    const auto width = static_cast<long>(picture.width), height = static_cast<long>(picture.height);
    const Real azimuth = std::atan2(d.x, -d.z) / (2 * pi) + Real{picture.turn};
    const Real u = (azimuth - std::floor(azimuth) + Real(0.5)) * static_cast<Real>(width) - Real(0.5);
    const Real from_pole = std::atan2(std::hypot(d.x, d.z), d.y) / pi * static_cast<Real>(height) - Real(0.5);
    const auto column = static_cast<long>(std::floor(u)), row = static_cast<long>(std::floor(from_pole));
    // 1 - cos without cancellation
    const auto depth = [&](long i) {
        const Real sine = std::sin((static_cast<Real>(i) + Real(0.5)) * pi / static_cast<Real>(2 * height));
        return 2 * sine * sine;
    };
    const Real here = std::atan2(std::hypot(d.x, d.z), d.y) / 2;
    const Real y = row < 0 || row >= height - 1
                       ? 0
                       : (2 * std::sin(here) * std::sin(here) - depth(row)) / (depth(row + 1) - depth(row));
    const Real x = u - static_cast<Real>(column);
    const auto texel = [&](long i, long j) {
        const long wrapped = ((i % width) + width) % width, clamped = std::clamp(j, 0L, height - 1);
        return to_vector(scene.environment_texels[clamped * width + wrapped]);
    };
    const auto along = [&](long j) { return texel(column, j) * (1 - x) + texel(column + 1, j) * x; };
    return (along(row) * (1 - y) + along(row + 1) * y) * Real{picture.intensity};
}

}  // namespace

Vector background_towards(const SceneView& scene, const Vector& direction) {
    if (is_there(scene.environment_picture)) return picture_towards(scene, direction);
    const Real m = (unit(direction).y + 1) / 2;
    return to_vector(scene.environment.bottom) * (1 - m) + to_vector(scene.environment.top) * m;
}

}  // namespace tandem::oracle
