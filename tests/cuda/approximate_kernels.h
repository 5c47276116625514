/// What the GPU's approximate functions give, against its correctly rounded ones.
#pragma once

#include <cstdint>

namespace tandem::test {

/// How many of the quotients y / sqrt(d) differ from the correctly rounded quotient by the correctly rounded root, and
/// one that does.
struct WrongQuotients {
    unsigned long long count = 0;
    float y = 0, d = 0;
};

/// Tries over_root() on every mantissa of d in [1, 4), times a random power of four, with `tries` values of y each.
/// Throws std::runtime_error if the GPU fails.
[[nodiscard]] WrongQuotients wrong_quotients(std::uint32_t seed, std::uint32_t tries);

/// The largest relative error of each function of rough.h.
struct RelativeErrors {
    double rough_reciprocal = 0, rough_inverse_square_root = 0, close_reciprocal = 0, close_inverse_square_root = 0;
};

/// Tries every mantissa of a float and as many random ones of a double, each with a random exponent of the stated
/// range. Throws std::runtime_error if the GPU fails.
[[nodiscard]] RelativeErrors relative_errors(std::uint32_t seed);

}  // namespace tandem::test
