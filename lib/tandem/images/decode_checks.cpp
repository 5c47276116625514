#include "tandem/images/decode_checks.h"

#include <fmt/format.h>

#include "tandem/base/error.h"
#include "tandem/images/texels.h"

namespace tandem {

void fail_decoding(const std::string& name, const char* format, const std::string& reason) {
    throw InputError(fmt::format("'{}' is not a readable {} image: {}", name, format, reason));
}

namespace {

void check_edges(const std::string& name, const char* format, std::uint64_t width, std::uint64_t height,
                 std::uint64_t most_edge, std::uint64_t most_pixels) {
    const auto good_edge = [&](std::uint64_t edge) { return edge >= 1 && edge <= most_edge; };
    if (good_edge(width) && good_edge(height) && width * height <= most_pixels) return;
    fail_decoding(name, format, fmt::format("its header claims {} x {} pixels, which is too large", width, height));
}

}  // namespace

void check_size(const std::string& name, const char* format, std::uint64_t width, std::uint64_t height) {
    check_edges(name, format, width, height, 65536, std::uint64_t{1} << 30);
}

void check_texture_size(const std::string& name, const char* format, std::uint64_t width, std::uint64_t height) {
    check_edges(name, format, width, height, most_texture_edge, std::uint64_t{1} << 30);
}

void check_data(const std::string& name, const char* format, std::size_t available, std::size_t needed) {
    if (available >= needed) return;
    fail_decoding(name, format,
                  fmt::format("the pixels need at least {} bytes, but only {} exist; the file is cut off or its header "
                              "is wrong",
                              needed, available));
}

void check_work(const std::string& name, const char* format, std::size_t available, std::size_t work) {
    const std::size_t limit = decoding_limit(available);
    if (work <= limit) return;
    fail_decoding(name, format,
                  fmt::format("decoding it is the work of {} pixels, but a file of {} bytes may cause only {}", work,
                              available, limit));
}

}  // namespace tandem
