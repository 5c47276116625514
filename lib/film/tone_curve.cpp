#include "tandem/film/tone_curve.h"

#include <algorithm>
#include <cstring>

namespace tandem {

namespace {

/// `pixel` gives the linear colour of a pixel by its number.
template <class Pixel>
ToneMapped tone_map(int width, int height, const Pixel& pixel) {
    ToneMapped result{{width, height, {}}, 0};
    const std::size_t pixels = pixel_count(result.image);
    result.image.values.resize(3 * pixels);
    std::uint8_t* level = result.image.values.data();
    // in blocks of plain floats, which compilers turn into vector instructions
    constexpr std::size_t block_pixels = 256;
    float values[3 * block_pixels];
    for (std::size_t first = 0; first < pixels; first += block_pixels) {
        const std::size_t count = std::min(block_pixels, pixels - first);
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3f linear = pixel(first + i);
            std::memcpy(&values[3 * i], &linear, sizeof linear);
        }
        std::uint32_t nan_values = 0;
        for (std::size_t i = 0; i < 3 * count; ++i) {
            level[i] = to_level(values[i]);
            nan_values += values[i] != values[i] ? 1 : 0;
        }
        result.nan_values += nan_values;
        level += 3 * count;
    }
    return result;
}

}  // namespace

ToneMapped tone_map(const FloatImage& image) {
    return tone_map(image.width, image.height, [&](std::size_t i) { return image.pixels[i]; });
}

ToneMapped tone_map(const Film& film) {
    return tone_map(film.width(), film.height(), [&](std::size_t i) { return film.mean(i); });
}

}  // namespace tandem
