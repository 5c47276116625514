/// The conversion of linear radiance to 8-bit images: exposure and transfer function.
#pragma once

#include <string>

namespace tandem {

/// Maps radiance to the values of a file, both from 0 to 1. srgb: IEC 61966-2-1, which screens and viewers assume.
/// linear: no conversion, as in the paper; screens show such images too dark.
enum class TransferFunction { srgb, linear };

[[nodiscard]] const char* to_string(TransferFunction transfer);

/// Parses a name. Throws InputError that lists the names.
[[nodiscard]] TransferFunction parse_transfer(const std::string& text);

/// Neither films nor float files depend on it.
struct Display {
    TransferFunction transfer = TransferFunction::srgb;
    double exposure_stops = 0;  ///< radiance is multiplied by 2^exposure_stops first; at most most_exposure_stops, +-

    bool operator==(const Display&) const = default;
};

inline constexpr double most_exposure_stops = 100;

/// "sRGB, exposed by -1.5 stops".
[[nodiscard]] std::string in_words(const Display& display);

/// False for a NaN.
[[nodiscard]] inline bool is_exposure(double stops) {
    return stops >= -most_exposure_stops && stops <= most_exposure_stops;
}

/// 2^exposure_stops: exact for whole stops, and the same bits on every machine.
[[nodiscard]] double exposure_factor(const Display& display);

}  // namespace tandem
