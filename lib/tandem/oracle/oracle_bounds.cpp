#include "tandem/oracle/oracle_bounds.h"

#include "tandem/math/lengths.h"

namespace tandem::oracle {

namespace {

constexpr double allowance = 0x1p-44;    // for rounding
constexpr double enlargement = 0x1p-20;  // of a ball, to find hits beyond bounds that are too small

Vec3d rounded(const Vector& a) {
    return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

}  // namespace

std::vector<Ball> balls_around(const SceneView& scene) {
    std::vector<Ball> balls(primitive_count(scene));
    for (std::uint32_t id = 0; id < balls.size(); ++id) {
        const Aabb box = primitive_bounds(scene, id);
        const Vec3d lower = widen(box.lower), upper = widen(box.upper);
        const Vec3d centre = (lower + upper) * 0.5;
        const double radius = length(upper - centre);
        balls[id] = {centre, radius * (1 + enlargement) + allowance * length(centre)};
    }
    return balls;
}

RoughLine::RoughLine(const Line& line)
    : origin(rounded(line.origin)),
      direction(rounded(line.direction)),
      length2(dot(direction, direction)),
      margin(allowance * length(origin)) {}

}  // namespace tandem::oracle
