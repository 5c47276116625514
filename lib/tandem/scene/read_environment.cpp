#include "tandem/scene/read_environment.h"

#include <fmt/format.h>

#include "tandem/base/error.h"
#include "tandem/images/image_io.h"

namespace tandem {

EnvironmentFile read_environment(const std::string& path) {
    DecodedImage decoded = read_image(path);
    if (!holds_floats(decoded.format)) {
        throw InputError(fmt::format(
            "the environment '{}' has 8 bits per channel, too few for radiance; use .hdr, .exr or .pfm", path));
    }
    EnvironmentFile result = {std::move(decoded.image)};
    FloatImage& picture = result.picture;
    if (picture.pixels.size() > most_environment_texels) {
        throw InputError(fmt::format("the environment '{}' has {} x {} texels, more than 2^27; make it smaller", path,
                                     picture.width, picture.height));
    }
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        Vec3f& texel = picture.pixels[i];
        bool is_negative = false;
        for (int c = 0; c < 3; ++c) {
            if (!(texel[c] <= brightest_environment && texel[c] >= -brightest_environment)) {
                const auto width = static_cast<std::size_t>(picture.width);
                throw InputError(fmt::format(
                    "the environment '{}' has the value {} in column {} of row {}; values must be from 0 to "
                    "1.2e30, so repair the file",
                    path, texel[c], i % width, i / width));
            }
            is_negative = is_negative || texel[c] < 0;
            texel[c] = texel[c] > 0 ? texel[c] : 0;  // no negative zero either
        }
        if (is_negative) ++result.negative_texels;
    }
    return result;
}

}  // namespace tandem
