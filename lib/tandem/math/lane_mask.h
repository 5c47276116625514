/// Masks: one truth value per lane of a packet (lanes.h).
#pragma once

#include "tandem/math/lane_registers.h"

/// Whether packets of AVX-512 are available.
#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define TANDEM_MASK_REGISTERS 1
#else
#define TANDEM_MASK_REGISTERS 0
#endif

namespace tandem {

/// All ones or all zeros per lane, in a register like those of the numbers.
template <class Isa>
struct LaneMask {
    using Vector = typename lanes_detail::Native<std::int32_t, Isa::bytes>::type;
    Vector v;

    LaneMask() = default;
    TANDEM_HD_INLINE explicit LaneMask(Vector lanes) : v(lanes) {}
    TANDEM_HD_INLINE explicit LaneMask(bool all) : v(Vector{} - static_cast<std::int32_t>(all)) {}

    TANDEM_HD_INLINE friend LaneMask operator&&(LaneMask a, LaneMask b) { return LaneMask(a.v & b.v); }
    TANDEM_HD_INLINE friend LaneMask operator||(LaneMask a, LaneMask b) { return LaneMask(a.v | b.v); }
    TANDEM_HD_INLINE friend LaneMask operator!=(LaneMask a, LaneMask b) { return LaneMask(a.v ^ b.v); }
    TANDEM_HD_INLINE LaneMask operator!() const { return LaneMask(~v); }

    /// Lane i as bit i.
    [[nodiscard]] TANDEM_HD_INLINE unsigned int bits() const {
        if constexpr (Isa::bytes == 16) {
            return static_cast<unsigned int>(_mm_movemask_ps(reinterpret_cast<__m128>(v)));
#if defined(__AVX__)
        } else {
            return static_cast<unsigned int>(_mm256_movemask_ps(reinterpret_cast<__m256>(v)));
#endif
        }
    }
    /// In the form of Embree's masks: -1 or 0 per lane.
    [[nodiscard]] TANDEM_HD_INLINE Vector vector() const { return v; }
    TANDEM_HD_INLINE bool operator[](int lane) const { return v[lane] != 0; }
};

#if TANDEM_MASK_REGISTERS
/// AVX-512 compares into mask registers with one bit per lane. Masks of all ones would need a conversion for each
/// comparison and each selection, and two of each for doubles.
template <class Isa>
requires(Isa::bytes == 64) struct LaneMask<Isa> {
    using Vector = typename lanes_detail::Native<std::int32_t, 64>::type;
    __mmask16 v;

    LaneMask() = default;
    TANDEM_HD_INLINE explicit LaneMask(Vector lanes) : v(_mm512_movepi32_mask(reinterpret_cast<__m512i>(lanes))) {}
    TANDEM_HD_INLINE explicit LaneMask(bool all) : v(static_cast<__mmask16>(all ? 0xFFFF : 0)) {}
    TANDEM_HD_INLINE explicit LaneMask(__mmask16 bits) : v(bits) {}

    TANDEM_HD_INLINE friend LaneMask operator&&(LaneMask a, LaneMask b) { return LaneMask(_kand_mask16(a.v, b.v)); }
    TANDEM_HD_INLINE friend LaneMask operator||(LaneMask a, LaneMask b) { return LaneMask(_kor_mask16(a.v, b.v)); }
    TANDEM_HD_INLINE friend LaneMask operator!=(LaneMask a, LaneMask b) { return LaneMask(_kxor_mask16(a.v, b.v)); }
    TANDEM_HD_INLINE LaneMask operator!() const { return LaneMask(_knot_mask16(v)); }

    [[nodiscard]] TANDEM_HD_INLINE unsigned int bits() const { return v; }
    [[nodiscard]] TANDEM_HD_INLINE Vector vector() const { return reinterpret_cast<Vector>(_mm512_movm_epi32(v)); }
    TANDEM_HD_INLINE bool operator[](int lane) const { return ((bits() >> lane) & 1U) != 0; }
};
#endif

template <class Isa>
TANDEM_HD_INLINE bool any(LaneMask<Isa> mask) {
    return mask.bits() != 0;
}

template <class Isa>
TANDEM_HD_INLINE bool all(LaneMask<Isa> mask) {
    return !any(!mask);
}

template <class I>
TANDEM_HD_INLINE LaneMask<I> select(const LaneMask<I>& mask, const LaneMask<I>& a, const LaneMask<I>& b) {
    return (mask && a) || (!mask && b);
}

/// Lane i is lane[i] of the mask packet[i] bytes after `base`. Reads four bytes there, even if the mask has two.
template <class I, class Words>
TANDEM_HD_INLINE LaneMask<I> gather_mask(const LaneMask<I>* base, const Words& packet, const Words& lane) {
#if TANDEM_MASK_REGISTERS
    if constexpr (I::bytes == 64) {
        const Words bits = Words::gather(base, packet);
        const auto bit = _mm512_sllv_epi32(_mm512_set1_epi32(1), reinterpret_cast<__m512i>(lane.part[0]));
        return LaneMask<I>(_mm512_test_epi32_mask(reinterpret_cast<__m512i>(bits.part[0]), bit));
    } else
#endif
    {
        return LaneMask<I>(
            reinterpret_cast<typename LaneMask<I>::Vector>(Words::gather(base, packet + (lane << 2)).part[0]));
    }
}

namespace lanes_detail {

enum class Comparison { less, less_equal, greater, greater_equal, equal, not_equal };

/// All ones where it holds.
template <Comparison comparison, class V>
TANDEM_HD_INLINE auto compare(V a, V b) {
    switch (comparison) {
        case Comparison::less:
            return a < b;
        case Comparison::less_equal:
            return a <= b;
        case Comparison::greater:
            return a > b;
        case Comparison::greater_equal:
            return a >= b;
        case Comparison::equal:
            return a == b;
        default:
            return a != b;
    }
}

#if TANDEM_MASK_REGISTERS
/// A bit per element. The predicates are those of the operators, also for NaN.
template <Comparison comparison, class V>
TANDEM_HD_INLINE auto compare_bits(V a, V b) {
    constexpr int number_predicates[] = {_CMP_LT_OS, _CMP_LE_OS, _CMP_GT_OS, _CMP_GE_OS, _CMP_EQ_OQ, _CMP_NEQ_UQ};
    constexpr int word_predicates[] = {_MM_CMPINT_LT,  _MM_CMPINT_LE, _MM_CMPINT_NLE,
                                       _MM_CMPINT_NLT, _MM_CMPINT_EQ, _MM_CMPINT_NE};
    constexpr int number = number_predicates[static_cast<int>(comparison)];
    constexpr int word = word_predicates[static_cast<int>(comparison)];
    using T = std::remove_reference_t<decltype(a[0])>;
    static_assert(std::is_floating_point_v<T> || std::is_unsigned_v<T>);
    if constexpr (std::is_same_v<T, float>) {
        return _mm512_cmp_ps_mask(reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b), number);
    } else if constexpr (std::is_same_v<T, double>) {
        return _mm512_cmp_pd_mask(reinterpret_cast<__m512d>(a), reinterpret_cast<__m512d>(b), number);
    } else if constexpr (sizeof(T) == 4) {
        return _mm512_cmp_epu32_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b), word);
    } else {
        return _mm512_cmp_epu64_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b), word);
    }
}

TANDEM_HD_INLINE __mmask16 join_bits(__mmask8 first, __mmask8 second) { return _mm512_kunpackb(second, first); }
TANDEM_HD_INLINE __mmask8 first_bits(__mmask16 bits) { return static_cast<__mmask8>(bits); }
TANDEM_HD_INLINE __mmask8 second_bits(__mmask16 bits) { return static_cast<__mmask8>(_kshiftri_mask16(bits, 8)); }

/// a where the bit of the element is set, else b.
template <class V>
TANDEM_HD_INLINE V choose_bits(__mmask16 bits, V a, V b) {
    return reinterpret_cast<V>(
        _mm512_mask_blend_epi32(bits, reinterpret_cast<__m512i>(b), reinterpret_cast<__m512i>(a)));
}
template <class V>
TANDEM_HD_INLINE V choose_bits(__mmask8 bits, V a, V b) {
    return reinterpret_cast<V>(
        _mm512_mask_blend_epi64(bits, reinterpret_cast<__m512i>(b), reinterpret_cast<__m512i>(a)));
}
#endif

/// mask ? a : b for a mask of all ones or all zeros per element. GCC 12 would compare the mask with zero first; clang
/// sees through the comparison that made the mask, but not through the instruction.
template <class M, class V>
TANDEM_HD_INLINE V choose(M mask, V a, V b) {
#if defined(__SSE4_1__) && !defined(__clang__)
    using Same = typename Native<std::conditional_t<sizeof(a[0]) == 4, float, double>, sizeof(V)>::type;
    return reinterpret_cast<V>(
        blend(reinterpret_cast<Same>(mask), reinterpret_cast<Same>(a), reinterpret_cast<Same>(b)));
#else
    return mask ? a : b;
#endif
}

}  // namespace lanes_detail

}  // namespace tandem
