/// Takes numbers from the lanes of several packets in memory. Tested by tests/math/lanes_test.cpp.
#pragma once

#include <bit>
#include <cstddef>

#include "tandem/math/lanes.h"

namespace tandem {

/// The number of packets.
inline constexpr int pick_packets = 8;

namespace pick_detail {

/// The parts of places (see pick()).
template <class Word>
struct Place {
    Word offset;  ///< of the packet, in bytes
    Word lane;

    TANDEM_HD_INLINE Place(const Word& place, std::size_t stride)
        : offset((place >> std::countr_zero(static_cast<unsigned>(Word::size))) *
                 Word(static_cast<std::uint32_t>(stride))),
          lane(place & Word(Word::size - 1)) {}
};

#if TANDEM_MASK_REGISTERS
TANDEM_HD_INLINE __m512i load(const std::byte* from) { return _mm512_load_si512(from); }

// A permutation chooses from two registers by the low five bits of a place. The higher bits choose among its results.
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

// The same for doubles, of which a packet has two registers: a permutation chooses by the low four bits.
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

/// Lane i of the result is the number at place[i] in packets that are `stride` bytes apart. A place is the number of
/// the packet times that of the lanes, plus the lane. `first`: the numbers of the first packet.
template <std::size_t stride, class T, class I>
TANDEM_HD_INLINE Lanes<T, I> pick(const Lanes<T, I>& first, const Lanes<std::uint32_t, I>& place) {
    static_assert(stride % alignof(Lanes<T, I>) == 0);
#if TANDEM_MASK_REGISTERS
    if constexpr (I::bytes == 64) {  // gathering takes longer: docs/performance/cpu.md, "Re-sorting paths"
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
        const pick_detail::Place at(place, stride);
        return Lanes<T, I>::gather(&first, at.offset + (at.lane << std::countr_zero(sizeof(T))));
    }
}

/// The same for a mask. Reads four bytes of each, even if a mask has two.
template <std::size_t stride, class I>
TANDEM_HD_INLINE LaneMask<I> pick(const LaneMask<I>& first, const Lanes<std::uint32_t, I>& place) {
    const pick_detail::Place at(place, stride);
    return gather_mask(&first, at.offset, at.lane);
}

}  // namespace tandem
