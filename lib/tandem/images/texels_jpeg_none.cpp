// For a build without libjpeg.
#include <fmt/format.h>

#include "tandem/base/error.h"
#include "tandem/images/texels.h"

namespace tandem {

namespace {

[[noreturn]] void fail(const std::string& name) {
    throw EnvironmentError(fmt::format(
        "'{}' is a JPEG, and this build of Tandem has no libjpeg; install libjpeg-dev and build again", name));
}

}  // namespace

TexelSize jpeg_texel_size(std::span<const std::byte>, const std::string& name) { fail(name); }

Texels decode_jpeg_texels(std::span<const std::byte>, const std::string& name, unsigned) { fail(name); }

}  // namespace tandem
