/// Reads environment pictures from files.
#pragma once

#include <string>

#include "tandem/kernel/lights/environment_image.h"

namespace tandem {

struct EnvironmentFile {
    FloatImage picture;               ///< equirectangular (kernel/lights/environment_picture.h); finite, not negative
    std::size_t negative_texels = 0;  ///< texels with a negative channel, which became 0; resampling produces such
};

/// Reads linear radiance from a .hdr, .exr or .pfm file. Throws InputError with the path for a file that cannot be
/// read, for 8-bit formats, for texels that are not finite or above 2^100 (with their position), and for more than 2^27
/// texels; EnvironmentError for .exr in a build without OpenEXR.
[[nodiscard]] EnvironmentFile read_environment(const std::string& path);

}  // namespace tandem
