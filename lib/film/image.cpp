#include "tandem/film/image.h"

namespace tandem {

namespace {

std::size_t area(int width, int height) { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

}  // namespace

std::size_t pixel_count(const FloatImage& image) { return area(image.width, image.height); }
std::size_t pixel_count(const ByteImage& image) { return area(image.width, image.height); }

FloatImage film_to_image(const Film& film) {
    FloatImage image{film.width(), film.height(), {}};
    image.pixels.resize(film.pixel_count());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = film.mean(i);
    return image;
}

FloatImage to_float(const ByteImage& image) {
    FloatImage result{image.width, image.height, {}};
    result.pixels.resize(pixel_count(image));
    const auto level = [&](std::size_t i) { return static_cast<float>(image.values[i]) / 255.0F; };
    for (std::size_t i = 0; i < result.pixels.size(); ++i) {
        result.pixels[i] = {level(3 * i), level(3 * i + 1), level(3 * i + 2)};
    }
    return result;
}

}  // namespace tandem
