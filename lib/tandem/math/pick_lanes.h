/// Takes numbers from the lanes of eight packets in memory.
#pragma once

#include <bit>
#include <cstddef>

#include "tandem/math/lanes.h"

namespace tandem {

namespace pick_detail {

#if TANDEM_MASK_REGISTERS
TANDEM_HD_INLINE __m512i load(const std::byte* from) { return _mm512_load_si512(from); }

// Permutations read two registers, so they give a choice of numbers, from which each bit of the place selects half.
template <std::size_t stride>
TANDEM_HD_INLINE __m512i pick_words(const std::byte* first, __m512i place) {
    const auto of_two = [&](std::size_t packet) __attribute__((always_inline)) {
        const std::byte* from = first + packet * stride;
        return _mm512_permutex2var_epi32(load(from), place, load(from + stride));
    };
    const __mmask16 in_odd_pair = _mm512_test_epi32_mask(place, _mm512_set1_epi32(32));
    const auto of_four = [&](std::size_t packet) __attribute__((always_inline)) {
        return _mm512_mask_blend_epi32(in_odd_pair, of_two(packet), of_two(packet + 2));
    };
    return _mm512_mask_blend_epi32(_mm512_test_epi32_mask(place, _mm512_set1_epi32(64)), of_four(0), of_four(4));
}

// A packet of doubles has two registers.
template <std::size_t stride>
TANDEM_HD_INLINE __m512i pick_doubles(const std::byte* first, __m256i place_words) {
    const __m512i place = _mm512_maskz_cvtepu32_epi64(0xFF, place_words);
    const auto of_one = [&](std::size_t packet) __attribute__((always_inline)) {
        const std::byte* from = first + packet * stride;
        return _mm512_permutex2var_epi64(load(from), place, load(from + sizeof(__m512i)));
    };
    const __mmask8 in_odd = _mm512_test_epi64_mask(place, _mm512_set1_epi64(16));
    const auto of_two = [&](std::size_t packet) __attribute__((always_inline)) {
        return _mm512_mask_blend_epi64(in_odd, of_one(packet), of_one(packet + 1));
    };
    const __mmask8 in_odd_pair = _mm512_test_epi64_mask(place, _mm512_set1_epi64(32));
    const auto of_four = [&](std::size_t packet) __attribute__((always_inline)) {
        return _mm512_mask_blend_epi64(in_odd_pair, of_two(packet), of_two(packet + 2));
    };
    return _mm512_mask_blend_epi64(_mm512_test_epi64_mask(place, _mm512_set1_epi64(64)), of_four(0), of_four(4));
}
#endif

}  // namespace pick_detail

/// A place in eight packets that are `stride` bytes apart: the number of the packet times the number of lanes, plus the
/// lane. The result has in lane i the number at place[i]. `first`: the one in the first packet.
template <std::size_t stride, class T, class I>
TANDEM_HD_INLINE Lanes<T, I> pick(const Lanes<T, I>& first, const Lanes<std::uint32_t, I>& place) {
    using Word = Lanes<std::uint32_t, I>;
#if TANDEM_MASK_REGISTERS
    if constexpr (I::bytes == 64) {  // gathering takes longer: docs/performance.md, "Re-sorting paths"
        using Vector = typename Lanes<T, I>::Vector;
        const auto* from = reinterpret_cast<const std::byte*>(&first);
        Lanes<T, I> result;
        if constexpr (sizeof(T) == 4) {
            const auto at = reinterpret_cast<__m512i>(place.part[0]);
            result.part[0] = reinterpret_cast<Vector>(pick_detail::pick_words<stride>(from, at));
        } else {
            const auto low = reinterpret_cast<__m256i>(lanes_detail::half<0>(place.part[0]));
            const auto high = reinterpret_cast<__m256i>(lanes_detail::half<1>(place.part[0]));
            result.part[0] = reinterpret_cast<Vector>(pick_detail::pick_doubles<stride>(from, low));
            result.part[1] = reinterpret_cast<Vector>(pick_detail::pick_doubles<stride>(from, high));
        }
        return result;
    } else
#endif
    {
        const Word packet = place >> std::countr_zero(static_cast<unsigned>(Word::size));
        const Word lane = place & Word(Word::size - 1);
        return Lanes<T, I>::gather(
            &first, packet * Word(static_cast<std::uint32_t>(stride)) + (lane << std::countr_zero(sizeof(T))));
    }
}

/// The same for a mask. Reads four bytes of each, even if a mask has two.
template <std::size_t stride, class I>
TANDEM_HD_INLINE LaneMask<I> pick(const LaneMask<I>& first, const Lanes<std::uint32_t, I>& place) {
    using Word = Lanes<std::uint32_t, I>;
    const Word packet = place >> std::countr_zero(static_cast<unsigned>(Word::size));
    const Word lane = place & Word(Word::size - 1);
    return gather_mask(&first, packet * Word(static_cast<std::uint32_t>(stride)), lane);
}

}  // namespace tandem
