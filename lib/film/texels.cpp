#include "tandem/film/texels.h"

#include <fmt/format.h>

#include <string_view>

#include "tandem/error/error.h"

namespace tandem {

Texels decode_texels(std::span<const std::byte> bytes, const std::string& name) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\x89PNG\r\n")) return decode_png_texels(bytes, name);
    if (text.starts_with("\xFF\xD8\xFF")) return decode_jpeg_texels(bytes, name);
    throw InputError(fmt::format("'{}' is not a picture that Tandem reads as a texture: PNG or JPEG", name));
}

Texels read_texels(const std::string& path) { return decode_texels(read_file(path), path); }

}  // namespace tandem
