#include "tandem/film/decode_checks.h"

#include <fmt/format.h>

#include "tandem/error/error.h"

namespace tandem {

void fail_decoding(const std::string& name, const char* format, const std::string& reason) {
    throw InputError(fmt::format("'{}' is not a readable {} image: {}", name, format, reason));
}

void check_size(const std::string& name, const char* format, std::uint64_t width, std::uint64_t height) {
    constexpr std::uint64_t most_edge = 65536, most_pixels = std::uint64_t{1} << 30;
    const auto good_edge = [](std::uint64_t edge) { return edge >= 1 && edge <= most_edge; };
    if (good_edge(width) && good_edge(height) && width * height <= most_pixels) return;
    fail_decoding(name, format, fmt::format("it claims {} x {} pixels", width, height));
}

void check_data(const std::string& name, const char* format, std::size_t available, std::size_t needed) {
    if (available >= needed) return;
    fail_decoding(name, format,
                  fmt::format("the pixels need at least {} bytes, and {} are there; the file is cut off or its header "
                              "is wrong",
                              needed, available));
}

}  // namespace tandem
