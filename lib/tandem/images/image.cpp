#include "tandem/images/image.h"

#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

std::size_t area(int width, int height) { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

}  // namespace

std::size_t pixel_count(const FloatImage& image) { return area(image.width, image.height); }
std::size_t pixel_count(const ByteImageView& image) { return area(image.width, image.height); }

FloatImage film_to_image(const Film& film) {
    const DefaultFpEnvironment guard;
    FloatImage image{film.width(), film.height(), {}};
    image.pixels.resize(film.pixel_count());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = film.mean(i);
    return image;
}

}  // namespace tandem
