#include "tandem/images/texels.h"

#include <fmt/format.h>

#include <string_view>

#include "tandem/base/error.h"
#include "tandem/base/lfs_pointer.h"

namespace tandem {

namespace {

/// Calls `of_png` or `of_jpeg`, depending on the bytes.
template <class OfPng, class OfJpeg>
auto by_format(std::span<const std::byte> bytes, const std::string& name, OfPng of_png, OfJpeg of_jpeg) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\x89PNG\r\n")) return of_png();
    if (text.starts_with("\xFF\xD8\xFF")) return of_jpeg();
    if (is_lfs_pointer(bytes)) throw InputError(fmt::format("'{}' {}", name, lfs_advice));
    throw InputError(fmt::format("'{}' is not a PNG or JPEG image, the formats of textures", name));
}

}  // namespace

TexelSize texel_size(std::span<const std::byte> bytes, const std::string& name) {
    return by_format(
        bytes, name, [&] { return png_texel_size(bytes, name); }, [&] { return jpeg_texel_size(bytes, name); });
}

Texels decode_texels(std::span<const std::byte> bytes, const std::string& name, unsigned shift) {
    return by_format(
        bytes, name, [&] { return decode_png_texels(bytes, name, shift); },
        [&] { return decode_jpeg_texels(bytes, name, shift); });
}

Texels read_texels(const std::string& path) { return decode_texels(read_file(path), path); }

}  // namespace tandem
