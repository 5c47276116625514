#include "tandem/images/display.h"

#include <fmt/format.h>

#include <cmath>

#include "tandem/base/error.h"
#include "tandem/math/exact_math.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

const char* to_string(TransferFunction transfer) { return transfer == TransferFunction::srgb ? "srgb" : "linear"; }

TransferFunction parse_transfer(const std::string& text) {
    for (const TransferFunction transfer : {TransferFunction::srgb, TransferFunction::linear}) {
        if (text == to_string(transfer)) return transfer;
    }
    throw InputError(fmt::format("there is no transfer function '{}'; use srgb or linear", text));
}

std::string in_words(const Display& display) {
    const std::string exposure =
        display.exposure_stops == 0 ? "" : fmt::format(", exposed by {:+} stops", display.exposure_stops);
    return fmt::format("{}{}", display.transfer == TransferFunction::srgb ? "sRGB" : "linear", exposure);
}

double exposure_factor(const Display& display) {
    const DefaultFpEnvironment guard;
    const double whole = std::floor(display.exposure_stops);
    const double rest = display.exposure_stops - whole;
    return std::ldexp(rest == 0 ? 1 : power<float>(2.0, rest), static_cast<int>(whole));
}

}  // namespace tandem
