#include "tandem/film/tone_curve.h"

namespace tandem {

ToneMapped tone_map(const FloatImage& image) {
    ToneMapped result{{image.width, image.height, {}}, 0};
    result.image.values.resize(3 * pixel_count(image));
    std::uint8_t* level = result.image.values.data();
    for (const Vec3f& pixel : image.pixels) {
        for (const float value : {pixel.x, pixel.y, pixel.z}) {
            *level++ = to_level(value);
            result.nan_values += value != value ? 1 : 0;
        }
    }
    return result;
}

}  // namespace tandem
