#include "common/arguments.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string_view>

#include "tandem/base/error.h"
#include "tandem/images/display.h"

namespace tandem {

namespace {

/// A whole number from 0 to `most`, or nothing.
std::optional<int> parse_whole(std::string_view text, int most) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0 || value > most) return std::nullopt;
    return value;
}

}  // namespace

FilmSize parse_size(const std::string& text) {
    const std::size_t by = text.find('x');
    const auto width = parse_whole(std::string_view(text).substr(0, by), 65536);
    const auto height =
        by == std::string::npos ? std::nullopt : parse_whole(std::string_view(text).substr(by + 1), 65536);
    if (!width || !height || *width == 0 || *height == 0) {
        throw InputError(fmt::format("--size is '{}', but must look like 1000x900 (pixels, 1 to 65536)", text));
    }
    return {*width, *height};
}

FrameRange parse_frames(const std::string& text) {
    constexpr int most = 1 << 24;
    const std::size_t dash = text.find('-');
    const auto first = parse_whole(std::string_view(text).substr(0, dash), most);
    const auto last = dash == std::string::npos ? first : parse_whole(std::string_view(text).substr(dash + 1), most);
    if (!first || !last || *last < *first) {
        throw InputError(fmt::format("--frames is '{}', but must be a frame or a range, like 7 or 0-119", text));
    }
    return {*first, *last};
}

ExposureChoice parse_exposure(const std::string& text) {
    if (text == "auto") return {.automatic = true};
    double stops = 0;
    // from_chars() takes no plus sign
    const char* const start = text.data() + (text.starts_with('+') && !text.starts_with("+-") ? 1 : 0);
    const auto [end, error] = std::from_chars(start, text.data() + text.size(), stops);
    if (error != std::errc() || end != text.data() + text.size() || !is_exposure(stops)) {
        throw InputError(fmt::format("--exposure is '{}', but must be stops from {} to {}, like -2.5, or auto", text,
                                     -most_exposure_stops, most_exposure_stops));
    }
    return {.stops = stops};
}

}  // namespace tandem
