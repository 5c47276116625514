/// Triangles on the screen: projected by the camera and clipped, for the rasteriser.
#pragma once

#include <cstdint>
#include <vector>

#include "baseline/raster_scene.h"

namespace tandem::bench {

/// Positions on the screen are whole multiples of 1 / subpixels of a pixel, so that the rule of fill.h is exact.
inline constexpr std::int64_t subpixels = 4096;

struct ScreenCorner {
    std::int64_t x = 0, y = 0;  ///< from the top left, y down
    double inverse_w = 1;       ///< of the homogeneous coordinates: 1 / depth, or 1 for an orthographic camera
    /// Larger is nearer, and it is linear on the screen: 1 / depth, or -depth for an orthographic camera.
    double nearness = 0;
    Vec3d weights;  ///< barycentric coordinates in the triangle that it was cut from
};

struct ScreenTriangle {
    ScreenCorner corners[3];     ///< clockwise as seen on the screen
    std::int64_t area = 0;       ///< twice the area, above 0
    std::uint32_t triangle = 0;  ///< of RasterScene::triangles
};

/// Projects triangles, for a film of at most 65536 x 65536 pixels.
class Projection {
  public:
    Projection(const RasterScene& scene, int width, int height);

    /// Adds what is left of the triangle in front of the near plane: none, one or several triangles. What is farther
    /// than half a film beside the film is cut off too, so that positions stay small. Neighbours are cut at the same
    /// points of their common edge. Backs of culled faces are left out.
    void add(const RasterTriangle& triangle, std::uint32_t index, std::vector<ScreenTriangle>& result) const;

  private:
    /// Homogeneous: the position on the screen, in pixels, is (x / w, y / w).
    struct Point {
        double depth, x, y, w;
        Vec3d weights;
    };
    [[nodiscard]] Point project(const Vec3f& point, const Vec3d& weights) const;
    [[nodiscard]] bool shows_back(const RasterTriangle& triangle) const;
    [[nodiscard]] ScreenCorner to_corner(const Point& point) const;
    [[nodiscard]] double distance_inside(const Point& point, int plane) const;
    [[nodiscard]] std::vector<Point> clip(std::vector<Point> polygon) const;

    const RasterScene& scene_;
    double width_, height_;
    Matrix3 screen_from_offset_;  ///< (depth, x, y), homogeneous
};

/// The signed area that is positive for corners clockwise on the screen, doubled.
[[nodiscard]] inline std::int64_t doubled_area(const ScreenCorner& a, const ScreenCorner& b, const ScreenCorner& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace tandem::bench
