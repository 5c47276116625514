#include "tandem/render/foreground.h"

#include <algorithm>

#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

/// A range of colours.
struct ColourRange {
    Vec3f low, high;

    void add(const Vec3f& c) {
        low = {std::min(low.x, c.x), std::min(low.y, c.y), std::min(low.z, c.z)};
        high = {std::max(high.x, c.x), std::max(high.y, c.y), std::max(high.z, c.z)};
    }
    /// Whether a colour is in the range, with a tolerance of a hundredth.
    [[nodiscard]] bool has(const Vec3f& c) const {
        const auto within = [](float value, float from, float to) {
            return value >= 0.99F * from && value <= 1.01F * to;
        };
        return within(c.x, low.x, high.x) && within(c.y, low.y, high.y) && within(c.z, low.z, high.z);
    }
};

}  // namespace

Backdrop::Backdrop(const PreparedScene& scene, int width, int height, PixelFilter filter)
    : camera_(camera_view(scene.camera, width, height)),
      environment_(scene.environment),
      reach_(static_cast<float>(reach_of(filter))),
      is_gradient_(!has_environment(view(scene))) {}

FloatImage Backdrop::foreground(const Film& film) const {
    const DefaultFpEnvironment guard;
    FloatImage image = film_to_image(film);
    if (!is_gradient_) return image;
    std::size_t i = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x, ++i) {
            const auto behind = [&](float across, float down) {
                return background(environment_, camera_ray<float>(camera_, x, y, across, down).direction);
            };
            const float low = -reach_, high = 1 + reach_;
            const Vec3f corner = behind(low, low);
            ColourRange range{corner, corner};
            for (const Vec3f& other : {behind(high, low), behind(low, high), behind(high, high)}) range.add(other);
            if (range.has(image.pixels[i])) image.pixels[i] = {0, 0, 0};
        }
    }
    return image;
}

}  // namespace tandem
