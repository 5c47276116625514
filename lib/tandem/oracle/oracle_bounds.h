/// Balls around primitives, so that the oracle need not try each one in extended precision.
#pragma once

#include <vector>

#include "tandem/oracle/oracle_geometry.h"

namespace tandem::oracle {

/// Contains a primitive. Larger than its bounds by a millionth of the radius, so that the oracle also finds hits beyond
/// bounds that rounding has made too small, and by 2^-44 of the distance of its centre from the origin.
struct Ball {
    Vec3d centre;
    double radius;
};

/// A scene and the balls of its primitives.
struct BoundedView : SceneView {
    const Ball* balls = nullptr;  ///< of each primitive; null: every primitive is tried
};

/// The balls around the bounds of all primitives.
[[nodiscard]] std::vector<Ball> balls_around(const SceneView& scene);

/// A line in double, as balls are compared with it.
struct RoughLine {
    explicit RoughLine(const Line& line);
    Vec3d origin, direction;
    double length2;  ///< squared length of the direction
    double margin;   ///< for the rounding of the origin and of differences with it
};

/// Whether the line passes outside of the ball. True only where the exact line does: the distance of the centre from
/// the line, |(c - o) x d| / |d|, is computed with an error below 2^-49 (|c| + |o|), and radius and margin allow for
/// 2^-44 of both. False where a component is no number. Test: tests/agree/oracle_bounds_test.cpp.
[[nodiscard]] inline bool is_outside(const RoughLine& line, const Ball& ball) {
    const Vec3d moment = cross(ball.centre - line.origin, line.direction);
    const double reach = ball.radius + line.margin;
    return dot(moment, moment) > reach * reach * line.length2;
}

}  // namespace tandem::oracle
