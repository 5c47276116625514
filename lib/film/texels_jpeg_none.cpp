// JPEG in a build without libjpeg.
#include <fmt/format.h>

#include "tandem/error/error.h"
#include "tandem/film/texels.h"

namespace tandem {

Texels decode_jpeg_texels(std::span<const std::byte>, const std::string& name) {
    throw EnvironmentError(fmt::format(
        "'{}' is a JPEG, and this build of Tandem has no libjpeg; install libjpeg-dev and build again", name));
}

}  // namespace tandem
