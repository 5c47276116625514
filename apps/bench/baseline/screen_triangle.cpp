#include "baseline/screen_triangle.h"

#include <cmath>
#include <utility>

namespace tandem::bench {

namespace {

constexpr int plane_count = 5;
constexpr double margin = 0.5;  ///< of the film's edges, on each side

}  // namespace

Projection::Projection(const RasterScene& scene, int width, int height)
    : scene_(scene), width_(width), height_(height) {
    // A camera ray is o + t (d + x dx + y dy), or o + x dx + y dy + t d: solved for (t, t x, t y), or (t, x, y)
    const CameraView& camera = scene.camera;
    const Vec3d& dx = camera.orthographic ? camera.origin_dx : camera.direction_dx;
    const Vec3d& dy = camera.orthographic ? camera.origin_dy : camera.direction_dy;
    screen_from_offset_ = inverse(transpose({{camera.direction, dx, dy}}));
}

Projection::Point Projection::project(const Vec3f& point, const Vec3d& weights) const {
    const Vec3d at = screen_from_offset_ * (widen(point) - scene_.camera.origin);
    return {at.x, at.y, at.z, scene_.camera.orthographic ? 1.0 : at.x, weights};
}

bool Projection::shows_back(const RasterTriangle& triangle) const {
    const CameraView& camera = scene_.camera;
    const Vec3d corner = widen(triangle.corners[0]);
    const Vec3d normal = cross(widen(triangle.corners[1]) - corner, widen(triangle.corners[2]) - corner);
    return dot(normal, camera.orthographic ? camera.direction : corner - camera.origin) > 0;
}

/// How far a point is on the inner side of a plane: the near one, then left, right, top and bottom.
double Projection::distance_inside(const Point& point, int plane) const {
    switch (plane) {
        case 0:
            return point.depth - (scene_.camera.orthographic ? 0 : scene_.near);
        case 1:
            return point.x + margin * width_ * point.w;
        case 2:
            return (1 + margin) * width_ * point.w - point.x;
        case 3:
            return point.y + margin * height_ * point.w;
        default:
            return (1 + margin) * height_ * point.w - point.y;
    }
}

/// Source: I. Sutherland, G. Hodgman, "Reentrant Polygon Clipping", CACM 17(1), 1974. A crossing is computed from the
/// inner corner to the outer one, whichever of two neighbours has the edge, so that both get the same point.
std::vector<Projection::Point> Projection::clip(std::vector<Point> polygon) const {
    for (int plane = 0; plane < plane_count && !polygon.empty(); ++plane) {
        std::vector<Point> kept;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Point& a = polygon[i];
            const Point& b = polygon[(i + 1) % polygon.size()];
            const double of_a = distance_inside(a, plane), of_b = distance_inside(b, plane);
            if (of_a >= 0) kept.push_back(a);
            if ((of_a >= 0) == (of_b >= 0)) continue;
            const Point& in = of_a >= 0 ? a : b;
            const Point& out = of_a >= 0 ? b : a;
            const double share = std::abs(of_a >= 0 ? of_a : of_b) / (std::abs(of_a) + std::abs(of_b));
            kept.push_back({in.depth + (out.depth - in.depth) * share, in.x + (out.x - in.x) * share,
                            in.y + (out.y - in.y) * share, in.w + (out.w - in.w) * share,
                            in.weights + (out.weights - in.weights) * share});
        }
        polygon = std::move(kept);
    }
    return polygon;
}

ScreenCorner Projection::to_corner(const Point& point) const {
    constexpr auto scale = static_cast<double>(subpixels);
    const double inverse_w = 1 / point.w;
    return {std::llround(point.x * inverse_w * scale), std::llround(point.y * inverse_w * scale), inverse_w,
            scene_.camera.orthographic ? -point.depth : inverse_w, point.weights};
}

void Projection::add(const RasterTriangle& triangle, std::uint32_t index, std::vector<ScreenTriangle>& result) const {
    if (triangle.sides == FaceSides::culled && shows_back(triangle)) return;
    const std::vector<Point> polygon =
        clip({project(triangle.corners[0], {1, 0, 0}), project(triangle.corners[1], {0, 1, 0}),
              project(triangle.corners[2], {0, 0, 1})});
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        ScreenTriangle part{{to_corner(polygon[0]), to_corner(polygon[i - 1]), to_corner(polygon[i])}, 0, index};
        part.area = doubled_area(part.corners[0], part.corners[1], part.corners[2]);
        if (part.area == 0) continue;
        if (part.area < 0) {
            std::swap(part.corners[1], part.corners[2]);
            part.area = -part.area;
        }
        result.push_back(part);
    }
}

}  // namespace tandem::bench
