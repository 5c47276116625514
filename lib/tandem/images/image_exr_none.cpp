/// Replaces image_exr.cpp in a build without OpenEXR.
#include "tandem/base/error.h"
#include "tandem/images/image_codecs.h"

namespace tandem {

void check_exr_support() {
    throw EnvironmentError(
        "this build does not support EXR images; install OpenEXR (on Debian and Ubuntu: libopenexr-dev) and build "
        "again, or use "
        ".pfm, which holds the same floats");
}

Bytes encode_exr(const FloatImage&, const ImageMetadata&, std::span<const PlaneImage>) {
    check_exr_support();
    return {};
}

DecodedImage decode_exr(std::span<const std::byte>, const std::string&) {
    check_exr_support();
    return {};
}

}  // namespace tandem
