/// Which samples of a grid a triangle covers, for the rasteriser.
#pragma once

#include <algorithm>

#include "baseline/screen_triangle.h"

namespace tandem::bench {

/// One sample per pixel, at the same place in each: 0 to subpixels - 1 to the right of and below its corner.
struct SamplePlace {
    std::int64_t x = subpixels / 2, y = subpixels / 2;
};

/// Pixels [left, right) x [top, bottom).
struct PixelRange {
    int left = 0, right = 0, top = 0, bottom = 0;
};

/// The three edge functions at a point: twice the areas of the triangles that it forms with the edges opposite to the
/// corners. Their sum is ScreenTriangle::area.
struct EdgeValues {
    std::int64_t of[3];
};

[[nodiscard]] inline EdgeValues edges_at(const ScreenTriangle& triangle, std::int64_t x, std::int64_t y) {
    EdgeValues values{};
    const ScreenCorner point{x, y, 0, 0, {}};
    for (int i = 0; i < 3; ++i) {
        values.of[i] = doubled_area(triangle.corners[(i + 1) % 3], triangle.corners[(i + 2) % 3], point);
    }
    return values;
}

/// Calls visit(x, y, edge values) for the pixels of `range` whose sample is inside the triangle, or on an edge of it
/// that is a top or a left one: so every sample of a mesh is covered once, also on the edges between its triangles.
/// The arithmetic is exact, in integers.
/// Source: J. Pineda, "A Parallel Algorithm for Polygon Rasterization", SIGGRAPH 1988; the top-left rule of Direct3D.
template <class Visit>
void fill(const ScreenTriangle& triangle, const SamplePlace& place, const PixelRange& range, Visit visit) {
    const ScreenCorner* c = triangle.corners;
    const auto first = [](std::int64_t least, std::int64_t offset, int from) {
        const std::int64_t at = least - offset + subpixels - 1;  // rounded up
        return static_cast<int>(std::max<std::int64_t>(at >= 0 ? at / subpixels : 0, from));
    };
    const auto last = [](std::int64_t most, std::int64_t offset, int end) {
        const std::int64_t at = most - offset;
        return static_cast<int>(std::min<std::int64_t>(at >= 0 ? at / subpixels : -1, end - 1));
    };
    const int left = first(std::min({c[0].x, c[1].x, c[2].x}), place.x, range.left);
    const int right = last(std::max({c[0].x, c[1].x, c[2].x}), place.x, range.right);
    const int top = first(std::min({c[0].y, c[1].y, c[2].y}), place.y, range.top);
    const int bottom = last(std::max({c[0].y, c[1].y, c[2].y}), place.y, range.bottom);
    if (left > right || top > bottom) return;

    EdgeValues row = edges_at(triangle, left * subpixels + place.x, top * subpixels + place.y);
    std::int64_t right_step[3], down_step[3], least[3];
    for (int i = 0; i < 3; ++i) {
        const ScreenCorner& a = c[(i + 1) % 3];
        const ScreenCorner& b = c[(i + 2) % 3];
        right_step[i] = (a.y - b.y) * subpixels;
        down_step[i] = (b.x - a.x) * subpixels;
        const bool is_top_or_left = b.y < a.y || (b.y == a.y && b.x > a.x);
        least[i] = is_top_or_left ? 0 : 1;
    }
    for (int y = top; y <= bottom; ++y) {
        EdgeValues at = row;
        for (int x = left; x <= right; ++x) {
            if (at.of[0] >= least[0] && at.of[1] >= least[1] && at.of[2] >= least[2]) visit(x, y, at);
            for (int i = 0; i < 3; ++i) at.of[i] += right_step[i];
        }
        for (int i = 0; i < 3; ++i) row.of[i] += down_step[i];
    }
}

}  // namespace tandem::bench
