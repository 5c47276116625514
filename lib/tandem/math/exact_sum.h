/// A sum of products of three floats, or of three doubles, without rounding.
///
/// The sum is an integer, in units of the cube of the smallest positive number, and long enough for all products of
/// numbers within coordinate_limit: subnormals and cancellation lose nothing. A product takes some hundred
/// instructions, so this is for the few decisions that double cannot make. Source: U. Kulisch, "Very fast and exact
/// accumulation of products", Computing 91, 2011.
#pragma once

#include <initializer_list>
#include <limits>

#include "tandem/math/vec.h"

namespace tandem {

/// mantissa * 2^exponent.
struct ScaledPair {
    Pair<double> mantissa;
    int exponent;
};

namespace exact_sum_detail {

/// `words`: two's complement, least significant first.
template <int word_count>
TANDEM_HD_INLINE bool is_negative(const std::uint32_t (&words)[word_count]) {
    return (words[word_count - 1] >> 31) != 0;
}

/// The integer in units of 2^least, within 2^-100 of itself.
template <int word_count>
TANDEM_HD_CALL ScaledPair leading(const std::uint32_t (&words)[word_count], int least) {
    constexpr int taken = 5;  // words, for a hundred bits at least
    const bool negative = is_negative(words);
    const std::uint32_t flip = negative ? 0xFFFFFFFFU : 0U;  // of -x, without the carry: an error of one ulp
    int top = word_count - 1;
    TANDEM_KEEP_LOOP
    while (top > 0 && (words[top] ^ flip) == 0) --top;
    ScaledPair result = {{0.0, 0.0}, 32 * top + least};
    std::uint64_t carry = negative ? 1 : 0;
    std::uint32_t magnitude[taken] = {};
    TANDEM_KEEP_LOOP
    for (int word = 0; word <= top; ++word) {
        carry += words[word] ^ flip;
        if (top - word < taken) magnitude[top - word] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
    }
    // a carry out of the top: all bits below are zero
    if (carry != 0) result.mantissa.high = 0x1p32;
    double weight = 1.0;
    TANDEM_KEEP_LOOP
    for (const std::uint32_t word : magnitude) {
        result.mantissa = result.mantissa + Pair<double>{word * weight, 0.0};
        weight *= 0x1p-32;
    }
    if (negative) result.mantissa = -result.mantissa;
    return result;
}

}  // namespace exact_sum_detail

/// `T` is float or double. Up to 64 products of numbers of magnitude 2^60 at most.
template <class T>
class ExactSum {
  public:
    /// Adds or subtracts a * b * c.
    TANDEM_HD_INLINE void add(const T& a, const T& b, const T& c, bool take_away = false) {
        const Decoded factors[3] = {decode(a), decode(b), decode(c)};
        std::uint32_t product[3 * limbs] = {1};
        int used = 1;
        int shift = 0;
        bool negative = take_away;
        TANDEM_KEEP_LOOP
        for (const Decoded& factor : factors) {
            used = multiply(product, used, factor);
            shift += factor.shift;
            negative = negative != factor.negative;
        }
        add_shifted(product, used, shift, negative);
    }

    /// -1, 0 or 1.
    [[nodiscard]] TANDEM_HD_INLINE int sign() const {
        if (is_negative()) return -1;
        TANDEM_KEEP_LOOP
        for (const std::uint32_t word : words_) {
            if (word != 0) return 1;
        }
        return 0;
    }

    /// The sum, within 2^-100 of itself.
    [[nodiscard]] TANDEM_HD_INLINE ScaledPair leading() const { return exact_sum_detail::leading(words_, 3 * least); }

  private:
    static constexpr int digits = std::numeric_limits<T>::digits;
    static constexpr int least = std::numeric_limits<T>::min_exponent - digits;  ///< 2^least is the smallest number
    static constexpr int limbs = (digits + 31) / 32;
    static constexpr int word_count = (3 * (60 - least) + 8 + 31) / 32;

    /// |value| = mantissa * 2^(shift + least).
    struct Decoded {
        std::uint64_t mantissa;
        int shift;
        bool negative;
    };

    TANDEM_HD_INLINE static Decoded decode(const T& value) {
        const auto bits = bits_of(value);
        const auto fraction = bits & ((decltype(bits){1} << (digits - 1)) - 1);
        const auto biased = static_cast<int>((bits >> (digits - 1)) & ((1U << (8 * sizeof(T) - digits)) - 1U));
        const bool negative = (bits >> (8 * sizeof(T) - 1)) != 0;
        if (biased == 0) return {fraction, 0, negative};
        return {fraction | decltype(bits){1} << (digits - 1), biased - 1, negative};
    }

    /// product *= factor; returns the number of words in use.
    TANDEM_HD_INLINE static int multiply(std::uint32_t (&product)[3 * limbs], int used, const Decoded& factor) {
        std::uint32_t result[3 * limbs] = {};
        for (int j = 0; j < limbs; ++j) {
            const std::uint64_t limb = (factor.mantissa >> (32 * j)) & 0xFFFFFFFFU;
            std::uint64_t carry = 0;
            for (int i = 0; i < used && i + j < 3 * limbs; ++i) {
                carry += limb * product[i] + result[i + j];
                result[i + j] = static_cast<std::uint32_t>(carry);
                carry >>= 32;
            }
            if (used + j < 3 * limbs) result[used + j] = static_cast<std::uint32_t>(carry);
        }
        for (int i = 0; i < 3 * limbs; ++i) product[i] = result[i];
        return used + limbs < 3 * limbs ? used + limbs : 3 * limbs;
    }

    TANDEM_HD_INLINE void add_shifted(const std::uint32_t (&product)[3 * limbs], int used, int shift, bool negative) {
        const int bits = shift % 32;
        std::uint64_t carry = negative ? 1 : 0;  // -x is ~x + 1
        std::uint32_t below = 0;
        TANDEM_KEEP_LOOP
        for (int i = 0, at = shift / 32; at < word_count; ++i, ++at) {
            const std::uint32_t limb = i < used ? product[i] : 0;
            const auto piece = static_cast<std::uint32_t>((std::uint64_t{limb} << 32 | below) >> (32 - bits));
            below = limb;
            carry += std::uint64_t{words_[at]} + (negative ? ~piece : piece);
            words_[at] = static_cast<std::uint32_t>(carry);
            carry >>= 32;
            // nothing left to add: ~0 + 1 passes the carry on
            if (i > used && carry == (negative ? 1U : 0U)) return;
        }
    }

    [[nodiscard]] TANDEM_HD_INLINE bool is_negative() const { return exact_sum_detail::is_negative(words_); }

    std::uint32_t words_[word_count] = {};  ///< two's complement, least significant first
};

/// Adds or subtracts det(a, b, c) = a . (b x c).
template <class T>
TANDEM_HD_CALL void add_determinant(ExactSum<T>& sum, Vec3<T> a, Vec3<T> b, Vec3<T> c, bool take_away = false) {
    const T p[3] = {a.x, a.y, a.z};
    const T q[3] = {b.x, b.y, b.z};
    const T r[3] = {c.x, c.y, c.z};
    TANDEM_KEEP_LOOP
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        sum.add(p[i], q[j], r[k], take_away);
        sum.add(p[i], q[k], r[j], !take_away);
    }
}

/// a / b, rounded to nearest as quotient() does; b is not 0.
TANDEM_HD_INLINE double quotient(const ScaledPair& a, const ScaledPair& b) {
    const auto power_of_two = [](int exponent) {
        const int within = exponent < -1022 ? -1022 : exponent > 1023 ? 1023 : exponent;
        return double_of(static_cast<std::uint64_t>(within + 1023) << 52);
    };
    const int exponent = a.exponent - b.exponent;
    // in two steps, each of which a double can hold
    return quotient(a.mantissa, b.mantissa) * power_of_two(exponent / 2) * power_of_two(exponent - exponent / 2);
}

}  // namespace tandem
