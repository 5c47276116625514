/// What users write on the command line, as values.
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

/// "1000x900". Throws InputError that shows the form.
[[nodiscard]] FilmSize parse_size(const std::string& text);

/// First and last frame, both included.
struct FrameRange {
    std::int32_t first = 0;
    std::int32_t last = 0;

    [[nodiscard]] std::int32_t count() const { return last - first + 1; }
};

/// "0-119" or "7". Throws InputError that shows the form.
[[nodiscard]] FrameRange parse_frames(const std::string& text);

/// How 8-bit pictures are exposed.
struct ExposureChoice {
    bool automatic = false;  ///< as the first frame calls for
    double stops = 0;        ///< if not

    bool operator==(const ExposureChoice&) const = default;
};

/// "-2.5" or "auto". Throws InputError that shows the form.
[[nodiscard]] ExposureChoice parse_exposure(const std::string& text);

}  // namespace tandem
