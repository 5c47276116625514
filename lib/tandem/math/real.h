/// The arithmetic of kernels. A formula is written once, as a template over its `Real`, and uses only the operators and
/// the functions of this header. Real determines for how many rays at once and how accurately:
///
///   tier      one ray                        a packet (math/lanes.h)       decisions (Double<Real>)
///   strict    float                          Lanes<float, Isa>             in double
///   precise   double                         Lanes<double, Isa>            in double
///   fast      FastFloat (math/fast_float.h)  Lanes<float, Fast<Isa>>       in float
///
/// In strict and precise all operations are correctly rounded or exact, so that a formula gives the same bits on every
/// processor. The library's fminf and fmaxf are not used: they differ between CPU and GPU for NaN and signed zeros.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "tandem/math/host_device.h"

namespace tandem {

/// The types that belong to a Real: of comparisons, of decisions (Double), of bounds and filters (Float), of long sums
/// (Wide), and of integers; `Scalar` is the number in one lane.
template <class Real>
struct RealTraits;

template <>
struct RealTraits<float> {
    using Scalar = float;
    using Mask = bool;
    using Float = float;
    using Double = double;
    using Wide = double;
    using UInt = std::uint32_t;
    using UInt64 = std::uint64_t;
    static constexpr int lanes = 1;
    static constexpr bool fast = false;
};

template <>
struct RealTraits<double> : RealTraits<float> {
    using Scalar = double;
};

template <class Real>
using Scalar = typename RealTraits<Real>::Scalar;
template <class Real>
using Mask = typename RealTraits<Real>::Mask;
template <class Real>
using Double = typename RealTraits<Real>::Double;
template <class Real>
using Float = typename RealTraits<Real>::Float;
template <class Real>
using Wide = typename RealTraits<Real>::Wide;
template <class Real>
using UInt = typename RealTraits<Real>::UInt;
template <class Real>
using UInt64 = typename RealTraits<Real>::UInt64;

/// Whether Real is of the tier fast, whose operations may be approximate and may be contracted.
template <class Real>
inline constexpr bool is_fast = RealTraits<Real>::fast;

TANDEM_HD_INLINE bool any(bool mask) { return mask; }
TANDEM_HD_INLINE bool all(bool mask) { return mask; }

/// `mask ? a : b`, lane by lane.
template <class T>
TANDEM_HD_INLINE T select(bool mask, T a, T b) {
    return mask ? a : b;
}

template <class T>
TANDEM_HD_INLINE T lesser(T a, T b) {
    return select(b < a, b, a);
}

template <class T>
TANDEM_HD_INLINE T greater(T a, T b) {
    return select(a < b, b, a);
}

TANDEM_HD_INLINE double widen(float a) { return static_cast<double>(a); }
TANDEM_HD_INLINE double widen(double a) { return a; }
/// One rounding to nearest even.
TANDEM_HD_INLINE float narrow(double a) {
    auto rounded = static_cast<float>(a);
    TANDEM_KEEP_ROUNDING(rounded);
    return rounded;
}
TANDEM_HD_INLINE float narrow(float a) { return a; }
TANDEM_HD_INLINE double to_wide(float a) { return static_cast<double>(a); }
TANDEM_HD_INLINE double to_wide(double a) { return a; }
/// The number of a single ray, as callers see it.
TANDEM_HD_INLINE float to_plain(float a) { return a; }
TANDEM_HD_INLINE float to_plain(double a) { return narrow(a); }

/// Converts from the type of decisions to Real: one rounding in strict, none in precise and fast.
template <class Real>
TANDEM_HD_INLINE Real to_real(const Double<Real>& a) {
    if constexpr (std::is_same_v<Real, Double<Real>>) {
        return a;
    } else {
        return narrow(a);
    }
}

/// Converts to the type of decisions: one rounding in fast, none in strict and precise.
template <class Real>
TANDEM_HD_INLINE Double<Real> from_wide(const Wide<Real>& a) {
    if constexpr (is_fast<Real>) {
        return narrow(a);
    } else {
        return a;
    }
}

/// A constant of the host, rounded once to the precision of Real.
template <class Real>
TANDEM_HD_INLINE Real constant(double a) {
    return Real(static_cast<typename RealTraits<Real>::Scalar>(a));
}

TANDEM_HD_INLINE float square_root(float a) { return sqrtf(a); }
TANDEM_HD_INLINE double square_root(double a) { return sqrt(a); }
TANDEM_HD_INLINE double multiply_add(double a, double b, double c) { return ::fma(a, b, c); }
/// Nearest integer, ties to even.
TANDEM_HD_INLINE double round_to_int(double a) { return ::rint(a); }
TANDEM_HD_INLINE float absolute(float a) { return fabsf(a); }
TANDEM_HD_INLINE double absolute(double a) { return ::fabs(a); }

/// a * b + c for decisions that only affect speed and need not be equal everywhere (reject filters, boxes of a BVH):
/// one rounding if the processor fuses them, else two. With TANDEM_NO_LOOSE_FMA always two: tests/lint uses it to check
/// that the compiler fuses nothing by itself.
TANDEM_HD_INLINE float loose_multiply_add(float a, float b, float c) {
#if (TANDEM_ON_DEVICE || defined(__FMA__)) && !defined(TANDEM_NO_LOOSE_FMA)
    return fmaf(a, b, c);
#else
    return a * b + c;
#endif
}

/// Converts an integer to Real; exact below 2^31.
TANDEM_HD_INLINE float to_float(std::uint32_t a) { return static_cast<float>(static_cast<std::int32_t>(a)); }

/// The same for any Real.
template <class Real>
TANDEM_HD_INLINE Real from_uint(const UInt<Real>& a) {
    if constexpr (RealTraits<Real>::lanes == 1) {
        return Real(to_float(a));
    } else if constexpr (sizeof(typename RealTraits<Real>::Scalar) == sizeof(float)) {
        return to_float(a);
    } else {
        return widen(to_float(a));
    }
}

/// Converts a whole number from 0 to 2^31 - 1, in any lane, to an integer.
template <class Number>
TANDEM_HD_INLINE std::uint32_t to_word(const Number& a) {
    return static_cast<std::uint32_t>(to_wide(a));
}

/// Converts an integer to double.
TANDEM_HD_INLINE double to_wide(std::uint32_t a) { return static_cast<double>(a); }

/// The same bits as another type.
template <class To, class From>
TANDEM_HD_INLINE To bit_cast(const From& from) {
    static_assert(sizeof(To) == sizeof(From));
    To to;
    std::memcpy(&to, &from, sizeof(To));
    return to;
}

TANDEM_HD_INLINE std::uint64_t bits_of(double a) { return bit_cast<std::uint64_t>(a); }
TANDEM_HD_INLINE double double_of(std::uint64_t a) { return bit_cast<double>(a); }
TANDEM_HD_INLINE std::uint32_t bits_of(float a) { return bit_cast<std::uint32_t>(a); }
TANDEM_HD_INLINE float float_of(std::uint32_t a) { return bit_cast<float>(a); }

/// The high and the low word of a 32 x 32 bit product.
TANDEM_HD_INLINE void multiply_wide(std::uint32_t a, std::uint32_t b, std::uint32_t& high, std::uint32_t& low) {
    const std::uint64_t product = static_cast<std::uint64_t>(a) * b;
    high = static_cast<std::uint32_t>(product >> 32);
    low = static_cast<std::uint32_t>(product);
}

/// The bits in reverse order.
TANDEM_HD_INLINE std::uint32_t reversed_bits(std::uint32_t x) {
#if TANDEM_ON_DEVICE
    return __brev(x);
#else
    x = ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
    x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
    x = ((x >> 4) & 0x0F0F0F0FU) | ((x & 0x0F0F0F0FU) << 4);
    x = ((x >> 8) & 0x00FF00FFU) | ((x & 0x00FF00FFU) << 8);
    return (x >> 16) | (x << 16);
#endif
}

/// Reads or replaces the value of one lane. A scalar has one lane.
template <class T>
TANDEM_HD_INLINE T lane(const T& value, int) {
    return value;
}
template <class T>
TANDEM_HD_INLINE void set_lane(T& value, int, const T& lane_value) {
    value = lane_value;
}

/// Replaces the value of one lane by a constant of the host, rounded once to the precision of Real.
template <class Real>
TANDEM_HD_INLINE void set_lane_constant(Real& value, int i, double a) {
    if constexpr (RealTraits<Real>::lanes == 1) {
        value = constant<Real>(a);
    } else {
        set_lane(value, i, static_cast<typename RealTraits<Real>::Scalar>(a));
    }
}

/// Calls f(value, mask) once for each different value among the lanes of `active`.
template <class F>
TANDEM_HD_INLINE void for_each_unique_lane(std::uint32_t value, bool active, F f) {
    if (active) f(value, true);
}

/// The position of the lowest set bit; `bits` is not 0.
TANDEM_HD_INLINE int lowest_bit(std::uint32_t bits) {
#if TANDEM_ON_DEVICE
    return __ffs(static_cast<int>(bits)) - 1;
#else
    return __builtin_ctz(bits);
#endif
}

/// How many bits are set.
TANDEM_HD_INLINE int count_bits(std::uint32_t bits) {
#if TANDEM_ON_DEVICE
    return __popc(static_cast<int>(bits));
#else
    return __builtin_popcount(bits);
#endif
}

/// Unit roundoff of float, 2^-24: one correctly rounded operation errs by at most this, relative.
inline constexpr float float_roundoff = 0x1p-24F;

/// The largest float not above a finite `a`, and the smallest not below it.
TANDEM_HD_INLINE float round_down(double a) {
    const float nearest = static_cast<float>(a);
    if (static_cast<double>(nearest) <= a) return nearest;
    const std::uint32_t bits = bits_of(nearest);
    if (nearest == 0.0F) return float_of(0x80000001U);
    return float_of(nearest > 0.0F ? bits - 1 : bits + 1);
}
TANDEM_HD_INLINE float round_up(double a) { return -round_down(-a); }

}  // namespace tandem
