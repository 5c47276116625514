/// Images in memory: linear float RGB, and 8-bit RGB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tandem/film/film.h"
#include "tandem/math/vec.h"

namespace tandem {

/// Linear RGB radiance, row by row from the top left.
struct FloatImage {
    int width = 0;
    int height = 0;
    std::vector<Vec3f> pixels;  ///< width * height
};

/// 8-bit RGB for files and screens, row by row from the top left.
struct ByteImage {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> values;  ///< red, green, blue of each pixel: 3 * width * height
};

/// A ByteImage whose values are in memory that something else owns.
struct ByteImageView {
    ByteImageView() = default;
    ByteImageView(int columns, int rows, std::span<const std::uint8_t> levels)
        : width(columns), height(rows), values(levels) {}
    ByteImageView(const ByteImage& image) : ByteImageView(image.width, image.height, image.values) {}

    int width = 0;
    int height = 0;
    std::span<const std::uint8_t> values;  ///< red, green, blue of each pixel: 3 * width * height
};

/// width * height.
[[nodiscard]] std::size_t pixel_count(const FloatImage& image);
[[nodiscard]] std::size_t pixel_count(const ByteImageView& image);

/// An image of the means of all pixels (Film::mean()).
[[nodiscard]] FloatImage film_to_image(const Film& film);

}  // namespace tandem
