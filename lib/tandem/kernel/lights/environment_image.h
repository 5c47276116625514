/// An authored environment picture.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "tandem/images/image.h"

namespace tandem {

/// Rays that leave the scene see it instead of the gradient of Environment. It lights surfaces if
/// Environment::illuminates is set. Equirectangular; kernel/lights/environment_picture.h defines its orientation.
struct EnvironmentImage {
    FloatImage picture;   ///< linear, each value from 0 to brightest_environment; at most 65536 texels a side
    double rotation = 0;  ///< radians about the vertical axis, counter-clockwise as seen from above
    float intensity = 1;  ///< multiplies the texels; from 0 to most_environment_intensity
};

/// The limits of an environment picture: brightest texel, number of texels, longest side, largest intensity.
inline constexpr float brightest_environment = 0x1p100F;
inline constexpr std::size_t most_environment_texels = std::size_t{1} << 27;
inline constexpr int widest_environment = 65536;
inline constexpr float most_environment_intensity = 0x1p20F;

/// "a picture with 8 x 4 texels".
[[nodiscard]] inline std::string in_words(const EnvironmentImage& image) {
    return "a picture with " + std::to_string(image.picture.width) + " x " + std::to_string(image.picture.height) +
           " texels";
}

/// Calls require(condition, where, problem) for each condition of a valid picture.
template <class Require>
void check(const EnvironmentImage& image, const Require& require) {
    const FloatImage& picture = image.picture;
    const std::string where = "the environment's picture";
    const auto is_side = [](int texels) { return texels >= 1 && texels <= widest_environment; };
    require(is_side(picture.width) && is_side(picture.height) && picture.pixels.size() == pixel_count(picture) &&
                picture.pixels.size() <= most_environment_texels,
            where,
            "has " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                " texels; from 1 x 1 to 2^27 are possible, of at most 65536 a side, so make it smaller");
    const auto is_light = [](float x) { return x >= 0 && x <= brightest_environment; };
    require(std::all_of(picture.pixels.begin(), picture.pixels.end(),
                        [&](const Vec3f& a) { return is_light(a.x) && is_light(a.y) && is_light(a.z); }),
            where, "has values outside [0, 1.2e30]");
    require(image.intensity >= 0 && image.intensity <= most_environment_intensity, where,
            "has an intensity outside [0, 1.04858e+06]");
    require(std::abs(image.rotation) <= 1e6, where, "has a rotation outside [-1e6, 1e6] radians");
}

}  // namespace tandem
