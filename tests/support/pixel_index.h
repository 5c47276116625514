/// Where a pixel is in an image whose rows follow each other.
#pragma once

#include <cstddef>

namespace tandem::test {

/// The index of pixel (x, y) in an image of `width` pixels. All at least 0.
constexpr std::size_t pixel_index(int x, int y, int width) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

}  // namespace tandem::test
