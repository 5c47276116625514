/// A float of the tier fast, for one ray (math/real.h). Files that use it are compiled so that the compiler may
/// contract a * b + c and use the processor's approximate division, square root, exponential and logarithm
/// (docs/tiers.md). It is a separate type because the tier strict works in float too, and its code must not be mixed
/// with this.
#pragma once

#include "tandem/math/real.h"

namespace tandem {

struct FastFloat {
    float v;

    FastFloat() = default;
    template <class Number>
    requires(std::is_arithmetic_v<Number>) TANDEM_HD_INLINE constexpr FastFloat(Number a) : v(static_cast<float>(a)) {}

    TANDEM_HD_INLINE friend FastFloat operator+(FastFloat a, FastFloat b) { return a.v + b.v; }
    TANDEM_HD_INLINE friend FastFloat operator-(FastFloat a, FastFloat b) { return a.v - b.v; }
    TANDEM_HD_INLINE friend FastFloat operator*(FastFloat a, FastFloat b) { return a.v * b.v; }
    TANDEM_HD_INLINE friend FastFloat operator/(FastFloat a, FastFloat b) { return a.v / b.v; }
    TANDEM_HD_INLINE FastFloat operator-() const { return -v; }
    TANDEM_HD_INLINE FastFloat& operator+=(FastFloat b) { return *this = *this + b; }
    TANDEM_HD_INLINE friend bool operator<(FastFloat a, FastFloat b) { return a.v < b.v; }
    TANDEM_HD_INLINE friend bool operator<=(FastFloat a, FastFloat b) { return a.v <= b.v; }
    TANDEM_HD_INLINE friend bool operator>(FastFloat a, FastFloat b) { return a.v > b.v; }
    TANDEM_HD_INLINE friend bool operator>=(FastFloat a, FastFloat b) { return a.v >= b.v; }
    TANDEM_HD_INLINE friend bool operator==(FastFloat a, FastFloat b) { return a.v == b.v; }
    TANDEM_HD_INLINE friend bool operator!=(FastFloat a, FastFloat b) { return a.v != b.v; }
};

template <>
struct RealTraits<FastFloat> : RealTraits<float> {
    using Float = FastFloat;
    using Double = FastFloat;
    static constexpr bool fast = true;
};

TANDEM_HD_INLINE FastFloat widen(FastFloat a) { return a; }
TANDEM_HD_INLINE FastFloat narrow(FastFloat a) { return a; }
TANDEM_HD_INLINE double to_wide(FastFloat a) { return static_cast<double>(a.v); }
TANDEM_HD_INLINE float to_plain(FastFloat a) { return a.v; }

TANDEM_HD_INLINE std::uint32_t bits_of(FastFloat a) { return bits_of(a.v); }

TANDEM_HD_INLINE FastFloat square_root(FastFloat a) { return sqrtf(a.v); }
TANDEM_HD_INLINE FastFloat absolute(FastFloat a) { return fabsf(a.v); }
TANDEM_HD_INLINE FastFloat loose_multiply_add(FastFloat a, FastFloat b, FastFloat c) {
    return loose_multiply_add(a.v, b.v, c.v);
}
TANDEM_HD_INLINE FastFloat lesser(FastFloat a, FastFloat b) { return fminf(a.v, b.v); }
TANDEM_HD_INLINE FastFloat greater(FastFloat a, FastFloat b) { return fmaxf(a.v, b.v); }

}  // namespace tandem
