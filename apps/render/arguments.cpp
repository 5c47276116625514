#include "render/arguments.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <optional>

#include "tandem/error/error.h"

namespace tandem {

namespace {

/// Digits alone, up to the largest 32-bit signed number: what frames and sizes are counted in.
std::optional<std::int32_t> parse_count(std::string_view text) {
    std::int32_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || value < 0) return std::nullopt;
    return value;
}

struct Pair {
    std::optional<std::int32_t> first, second;
};

Pair parse_pair(std::string_view text, char separator) {
    const std::size_t at = text.find(separator);
    if (at == std::string_view::npos) return {};
    return {parse_count(text.substr(0, at)), parse_count(text.substr(at + 1))};
}

}  // namespace

FilmSize parse_size(std::string_view text) {
    const auto [width, height] = parse_pair(text, 'x');
    if (!width || !height) throw InputError(fmt::format("--size is '{}'; write width and height as in 1000x900", text));
    return {*width, *height};
}

FrameRange parse_frames(std::string_view text, const Scene& scene) {
    if (text == "all") return {0, static_cast<std::uint32_t>(frame_count(scene) - 1)};
    const auto single = parse_count(text);
    const auto [first, last] = single ? Pair{single, single} : parse_pair(text, '-');
    if (!first || !last || *last < *first) {
        throw InputError(fmt::format("--frames is '{}'; write a range as in 0-119, one frame, or all", text));
    }
    return {static_cast<std::uint32_t>(*first), static_cast<std::uint32_t>(*last)};
}

}  // namespace tandem
