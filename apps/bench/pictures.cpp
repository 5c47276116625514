#include "pictures.h"

#include <utility>

#include "tandem/images/image_io.h"
#include "tandem/render/frame_metadata.h"

namespace tandem::bench {

namespace {

/// Each pixel becomes the mean of step * step pixels; incomplete blocks at the right and the bottom are cut off.
FloatImage shrunk(const FloatImage& image, int step) {
    FloatImage small{image.width / step, image.height / step, {}};
    small.pixels.reserve(pixel_count(small));
    for (int y = 0; y < small.height; ++y) {
        for (int x = 0; x < small.width; ++x) {
            Vec3d sum{0, 0, 0};
            for (int i = 0; i < step * step; ++i) {
                const int at = (y * step + i / step) * image.width + x * step + i % step;
                sum = sum + widen(image.pixels[static_cast<std::size_t>(at)]);
            }
            small.pixels.push_back(narrow(sum / static_cast<double>(step * step)));
        }
    }
    return small;
}

}  // namespace

ImageMetadata describe_picture(const RenderJob& job, const std::string& backend) { return describe(job, {}, backend); }

void write_picture(const std::string& path, Film film, const ImageMetadata& metadata, const Display& display) {
    write_image(path, std::move(film), metadata,
                {.ppm_text = true, .durability = Durability::written, .display = display});
}

Film film_of(std::span<const float> rgb, int width, int height) {
    Film film(width, height, 1);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        film.sums()[i] = widen(Vec3f{rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]});
    }
    return film;
}

Picture small_picture(const FloatImage& image, int most_width, const std::string& caption, const Display& display) {
    const FloatImage small = shrunk(image, (image.width + most_width - 1) / most_width);
    const EncodedImage png = encode_image(small, ImageFormat::png, {}, {.png_level = 9, .display = display});
    return {caption, {reinterpret_cast<const char*>(png.bytes.data()), png.bytes.size()}};
}

}  // namespace tandem::bench
