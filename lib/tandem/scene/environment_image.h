/// An authored environment picture.
#pragma once

#include <cstddef>

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

struct Scene;

/// Lights a scene by a picture instead of its background and its ambient light.
void light_by(Scene& scene, EnvironmentImage image);

}  // namespace tandem
