/// Arguments of the command line, parsed.
#pragma once

#include <cstdint>
#include <string>

namespace tandem {

struct FilmSize {
    int width = 0;
    int height = 0;
};

/// Width over height.
[[nodiscard]] inline double aspect_of(const FilmSize& size) { return static_cast<double>(size.width) / size.height; }

/// Parses "1000x900". Throws InputError that shows the format.
[[nodiscard]] FilmSize parse_size(const std::string& text);

/// First and last frame, both included.
struct FrameRange {
    std::int32_t first = 0;
    std::int32_t last = 0;

    [[nodiscard]] std::int32_t count() const { return last - first + 1; }
};

/// Parses "0-119" or "7". Throws InputError that shows the format.
[[nodiscard]] FrameRange parse_frames(const std::string& text);

/// The exposure of 8-bit images.
struct ExposureChoice {
    bool automatic = false;  ///< derived from the first frame
    double stops = 0;        ///< if not automatic

    bool operator==(const ExposureChoice&) const = default;
};

/// Parses "-2.5" or "auto". Throws InputError that shows the format.
[[nodiscard]] ExposureChoice parse_exposure(const std::string& text);

}  // namespace tandem
