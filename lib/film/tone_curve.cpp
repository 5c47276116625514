#include "tandem/film/tone_curve.h"

#include <algorithm>
#include <cstring>

namespace tandem {

ToneMapped tone_map(const FloatImage& image) {
    ToneMapped result{{image.width, image.height, {}}, 0};
    result.image.values.resize(3 * pixel_count(image));
    std::uint8_t* level = result.image.values.data();
    // in blocks of plain floats, which compilers turn into vector instructions
    constexpr std::size_t block_pixels = 256;
    float values[3 * block_pixels];
    for (std::size_t first = 0; first < image.pixels.size(); first += block_pixels) {
        const std::size_t count = std::min(block_pixels, image.pixels.size() - first);
        std::memcpy(values, &image.pixels[first], count * sizeof(Vec3f));
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

}  // namespace tandem
