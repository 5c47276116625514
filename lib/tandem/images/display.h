/// How linear radiance becomes the picture that a person looks at: exposure and transfer function of 8-bit files.
#pragma once

#include <string>

namespace tandem {

/// From light to the values of a file, both from 0 to 1. srgb: IEC 61966-2-1, what screens and viewers take a file for.
/// linear: the values are the light, as the paper wrote its pictures; a screen shows them darker than they are.
enum class TransferFunction { srgb, linear };

[[nodiscard]] const char* to_string(TransferFunction transfer);

/// The inverse. Throws InputError that lists the names.
[[nodiscard]] TransferFunction parse_transfer(const std::string& text);

/// Films do not depend on it, and files of floats neither.
struct Display {
    TransferFunction transfer = TransferFunction::srgb;
    double exposure_stops = 0;  ///< radiance is multiplied by 2 to this power first; within most_exposure_stops of 0

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
