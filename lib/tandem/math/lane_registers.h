/// The vector registers of x86-64 processors, and the few operations that the compilers' vector extension lacks. For
/// lanes.h.
#pragma once

#include <immintrin.h>

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "tandem/math/real.h"

namespace tandem {

struct Sse4 {
    static constexpr int bytes = 16;
    static constexpr const char* name = "x86-64-v2";
};
struct Avx2 {
    static constexpr int bytes = 32;
    static constexpr const char* name = "x86-64-v3";
};
struct Avx512 {
    static constexpr int bytes = 64;
    static constexpr const char* name = "x86-64-v4";
};

/// The instruction set I for the fast tier: decisions in float, loose operations.
template <class I>
struct Fast : I {
    static constexpr bool fast = true;
};
template <class I>
inline constexpr bool is_fast_isa = false;
template <class I>
inline constexpr bool is_fast_isa<Fast<I>> = true;

namespace lanes_detail {

template <class T, int bytes>
struct Native {
    typedef T type __attribute__((vector_size(bytes)));
};

/// First (part 0) or second (part 1) half of a vector of 32-bit elements.
template <int part, class V>
TANDEM_HD_INLINE auto half(V v) {
    constexpr int n = sizeof(V) / 8;
    constexpr int s = part * n;
    if constexpr (n == 2) {
        return __builtin_shufflevector(v, v, s, s + 1);
    } else if constexpr (n == 4) {
        return __builtin_shufflevector(v, v, s, s + 1, s + 2, s + 3);
    } else {
        return __builtin_shufflevector(v, v, s, s + 1, s + 2, s + 3, s + 4, s + 5, s + 6, s + 7);
    }
}

template <class H>
TANDEM_HD_INLINE auto join(H a, H b) {
    constexpr int n = sizeof(H) / 4;
    if constexpr (n == 2) {
        return __builtin_shufflevector(a, b, 0, 1, 2, 3);
    } else if constexpr (n == 4) {
        return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    } else {
        return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    }
}

/// The even 32-bit elements of a, then those of b: narrows two 64-bit masks to one 32-bit mask.
template <class V>
TANDEM_HD_INLINE V even_elements(V a, V b) {
    constexpr int n = sizeof(V) / 4;
    if constexpr (n == 4) {
        return __builtin_shufflevector(a, b, 0, 2, 4, 6);
    } else if constexpr (n == 8) {
        return __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14);
    } else {
        return __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    }
}

// The operations that the compilers' vector extension lacks, per register width.
template <class V, class Scalar>
TANDEM_HD_INLINE V per_element(V a, Scalar scalar) {
    for (unsigned i = 0; i < sizeof(V) / sizeof(a[0]); ++i) a[i] = scalar(a[i]);
    return a;
}

using F16 = Native<float, 16>::type;
using D16 = Native<double, 16>::type;
using U16 = Native<std::uint32_t, 16>::type;
TANDEM_HD_INLINE F16 square_root(F16 a) { return reinterpret_cast<F16>(_mm_sqrt_ps(reinterpret_cast<__m128>(a))); }
TANDEM_HD_INLINE D16 square_root(D16 a) { return reinterpret_cast<D16>(_mm_sqrt_pd(reinterpret_cast<__m128d>(a))); }
TANDEM_HD_INLINE D16 multiply_add(D16 a, D16 b, D16 c) {
#if defined(__FMA__)
    return reinterpret_cast<D16>(
        _mm_fmadd_pd(reinterpret_cast<__m128d>(a), reinterpret_cast<__m128d>(b), reinterpret_cast<__m128d>(c)));
#else
    return D16{::fma(a[0], b[0], c[0]), ::fma(a[1], b[1], c[1])};
#endif
}
TANDEM_HD_INLINE F16 loose_multiply_add(F16 a, F16 b, F16 c) {
#if defined(__FMA__)
    return reinterpret_cast<F16>(
        _mm_fmadd_ps(reinterpret_cast<__m128>(a), reinterpret_cast<__m128>(b), reinterpret_cast<__m128>(c)));
#else
    return a * b + c;
#endif
}
TANDEM_HD_INLINE D16 round_to_int(D16 a) {
#if defined(__SSE4_1__)
    constexpr int nearest = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
    return reinterpret_cast<D16>(_mm_round_pd(reinterpret_cast<__m128d>(a), nearest));
#else
    return per_element(a, [](double x) { return ::rint(x); });
#endif
}
/// Exactly a < b ? a : b and a > b ? a : b: the instructions are defined so, for NaN and zeros too.
TANDEM_HD_INLINE F16 minimum(F16 a, F16 b) {
    return reinterpret_cast<F16>(_mm_min_ps(reinterpret_cast<__m128>(a), reinterpret_cast<__m128>(b)));
}
TANDEM_HD_INLINE D16 minimum(D16 a, D16 b) {
    return reinterpret_cast<D16>(_mm_min_pd(reinterpret_cast<__m128d>(a), reinterpret_cast<__m128d>(b)));
}
TANDEM_HD_INLINE F16 maximum(F16 a, F16 b) {
    return reinterpret_cast<F16>(_mm_max_ps(reinterpret_cast<__m128>(a), reinterpret_cast<__m128>(b)));
}
TANDEM_HD_INLINE D16 maximum(D16 a, D16 b) {
    return reinterpret_cast<D16>(_mm_max_pd(reinterpret_cast<__m128d>(a), reinterpret_cast<__m128d>(b)));
}
#if defined(__SSE4_1__)
/// a where the sign bit of the mask is set, else b.
TANDEM_HD_INLINE F16 blend(F16 mask, F16 a, F16 b) {
    return reinterpret_cast<F16>(
        _mm_blendv_ps(reinterpret_cast<__m128>(b), reinterpret_cast<__m128>(a), reinterpret_cast<__m128>(mask)));
}
TANDEM_HD_INLINE D16 blend(D16 mask, D16 a, D16 b) {
    return reinterpret_cast<D16>(
        _mm_blendv_pd(reinterpret_cast<__m128d>(b), reinterpret_cast<__m128d>(a), reinterpret_cast<__m128d>(mask)));
}
#endif
/// 64-bit products of the even 32-bit elements.
TANDEM_HD_INLINE U16 multiply_even(U16 a, U16 b) {
    return reinterpret_cast<U16>(_mm_mul_epu32(reinterpret_cast<__m128i>(a), reinterpret_cast<__m128i>(b)));
}

#if defined(__SSSE3__)
/// In each 16 bytes: the bytes of `bytes` at the places `at`, which are below 16.
TANDEM_HD_INLINE U16 pick_bytes(U16 bytes, U16 at) {
    return reinterpret_cast<U16>(_mm_shuffle_epi8(reinterpret_cast<__m128i>(bytes), reinterpret_cast<__m128i>(at)));
}
#endif

#if defined(__AVX2__) && defined(__FMA__)
using F32 = Native<float, 32>::type;
using D32 = Native<double, 32>::type;
using U32 = Native<std::uint32_t, 32>::type;
TANDEM_HD_INLINE F32 square_root(F32 a) { return reinterpret_cast<F32>(_mm256_sqrt_ps(reinterpret_cast<__m256>(a))); }
TANDEM_HD_INLINE D32 square_root(D32 a) { return reinterpret_cast<D32>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(a))); }
TANDEM_HD_INLINE D32 multiply_add(D32 a, D32 b, D32 c) {
    return reinterpret_cast<D32>(
        _mm256_fmadd_pd(reinterpret_cast<__m256d>(a), reinterpret_cast<__m256d>(b), reinterpret_cast<__m256d>(c)));
}
TANDEM_HD_INLINE F32 loose_multiply_add(F32 a, F32 b, F32 c) {
    return reinterpret_cast<F32>(
        _mm256_fmadd_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b), reinterpret_cast<__m256>(c)));
}
TANDEM_HD_INLINE D32 round_to_int(D32 a) {
    constexpr int nearest = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
    return reinterpret_cast<D32>(_mm256_round_pd(reinterpret_cast<__m256d>(a), nearest));
}
TANDEM_HD_INLINE F32 minimum(F32 a, F32 b) {
    return reinterpret_cast<F32>(_mm256_min_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b)));
}
TANDEM_HD_INLINE D32 minimum(D32 a, D32 b) {
    return reinterpret_cast<D32>(_mm256_min_pd(reinterpret_cast<__m256d>(a), reinterpret_cast<__m256d>(b)));
}
TANDEM_HD_INLINE F32 maximum(F32 a, F32 b) {
    return reinterpret_cast<F32>(_mm256_max_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b)));
}
TANDEM_HD_INLINE D32 maximum(D32 a, D32 b) {
    return reinterpret_cast<D32>(_mm256_max_pd(reinterpret_cast<__m256d>(a), reinterpret_cast<__m256d>(b)));
}
TANDEM_HD_INLINE F32 blend(F32 mask, F32 a, F32 b) {
    return reinterpret_cast<F32>(
        _mm256_blendv_ps(reinterpret_cast<__m256>(b), reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(mask)));
}
TANDEM_HD_INLINE D32 blend(D32 mask, D32 a, D32 b) {
    return reinterpret_cast<D32>(
        _mm256_blendv_pd(reinterpret_cast<__m256d>(b), reinterpret_cast<__m256d>(a), reinterpret_cast<__m256d>(mask)));
}
TANDEM_HD_INLINE U32 multiply_even(U32 a, U32 b) {
    return reinterpret_cast<U32>(_mm256_mul_epu32(reinterpret_cast<__m256i>(a), reinterpret_cast<__m256i>(b)));
}
TANDEM_HD_INLINE U32 pick_bytes(U32 bytes, U32 at) {
    return reinterpret_cast<U32>(_mm256_shuffle_epi8(reinterpret_cast<__m256i>(bytes), reinterpret_cast<__m256i>(at)));
}
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512BW__)
// The maskz forms, because GCC 12 warns of uninitialised variables in the plain ones.
using F64 = Native<float, 64>::type;
using D64 = Native<double, 64>::type;
using U64 = Native<std::uint32_t, 64>::type;
TANDEM_HD_INLINE F64 square_root(F64 a) {
    return reinterpret_cast<F64>(_mm512_maskz_sqrt_ps(0xFFFF, reinterpret_cast<__m512>(a)));
}
TANDEM_HD_INLINE D64 square_root(D64 a) {
    return reinterpret_cast<D64>(_mm512_maskz_sqrt_pd(0xFF, reinterpret_cast<__m512d>(a)));
}
TANDEM_HD_INLINE D64 multiply_add(D64 a, D64 b, D64 c) {
    return reinterpret_cast<D64>(
        _mm512_fmadd_pd(reinterpret_cast<__m512d>(a), reinterpret_cast<__m512d>(b), reinterpret_cast<__m512d>(c)));
}
TANDEM_HD_INLINE F64 loose_multiply_add(F64 a, F64 b, F64 c) {
    return reinterpret_cast<F64>(
        _mm512_fmadd_ps(reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b), reinterpret_cast<__m512>(c)));
}
TANDEM_HD_INLINE D64 round_to_int(D64 a) {
    constexpr int nearest = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
    return reinterpret_cast<D64>(_mm512_maskz_roundscale_pd(0xFF, reinterpret_cast<__m512d>(a), nearest));
}
TANDEM_HD_INLINE F64 minimum(F64 a, F64 b) {
    return reinterpret_cast<F64>(_mm512_maskz_min_ps(0xFFFF, reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b)));
}
TANDEM_HD_INLINE D64 minimum(D64 a, D64 b) {
    return reinterpret_cast<D64>(_mm512_maskz_min_pd(0xFF, reinterpret_cast<__m512d>(a), reinterpret_cast<__m512d>(b)));
}
TANDEM_HD_INLINE F64 maximum(F64 a, F64 b) {
    return reinterpret_cast<F64>(_mm512_maskz_max_ps(0xFFFF, reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b)));
}
TANDEM_HD_INLINE D64 maximum(D64 a, D64 b) {
    return reinterpret_cast<D64>(_mm512_maskz_max_pd(0xFF, reinterpret_cast<__m512d>(a), reinterpret_cast<__m512d>(b)));
}
TANDEM_HD_INLINE U64 multiply_even(U64 a, U64 b) {
    return reinterpret_cast<U64>(
        _mm512_maskz_mul_epu32(0xFF, reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b)));
}
TANDEM_HD_INLINE U64 pick_bytes(U64 bytes, U64 at) {
    return reinterpret_cast<U64>(_mm512_shuffle_epi8(reinterpret_cast<__m512i>(bytes), reinterpret_cast<__m512i>(at)));
}
#endif

/// reversed_bits() of each element, by tables of the bits of half a byte.
template <class V>
TANDEM_HD_INLINE V reversed_bits_of(V x) {
#if defined(__SSSE3__)
    const auto in_each_16_bytes = [](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        V words;
        for (unsigned i = 0; i < sizeof(V) / 4; ++i) words[i] = i % 4 == 0 ? a : i % 4 == 1 ? b : i % 4 == 2 ? c : d;
        return words;
    };
    const V reversed = in_each_16_bytes(0x0C040800U, 0x0E060A02U, 0x0D050901U, 0x0F070B03U);
    const V other_end = in_each_16_bytes(0x00010203U, 0x04050607U, 0x08090A0BU, 0x0C0D0E0FU);
    const V low = x & 0x0F0F0F0FU, high = (x >> 4) & 0x0F0F0F0FU;
    return pick_bytes(pick_bytes(reversed << 4, low) | pick_bytes(reversed, high), other_end);
#else
    return per_element(x, [](std::uint32_t a) { return reversed_bits(a); });
#endif
}

/// Gathers the elements at the given byte offsets from `base`. V has elements of 32 or 64 bits.
template <class V, class Offsets>
TANDEM_HD_INLINE V gather(const void* base, Offsets offsets) {
    constexpr bool words = sizeof(V) == sizeof(Offsets);
    static_assert(words || sizeof(V) == 2 * sizeof(Offsets));
#if defined(__AVX512F__) && defined(__AVX512DQ__)
    if constexpr (sizeof(V) == 64 && words) {
        const auto at = reinterpret_cast<__m512i>(offsets);
        return reinterpret_cast<V>(_mm512_mask_i32gather_epi32(__m512i{}, 0xFFFF, at, base, 1));
    } else if constexpr (sizeof(V) == 64) {
        const auto at = reinterpret_cast<__m256i>(offsets);
        return reinterpret_cast<V>(_mm512_mask_i32gather_epi64(__m512i{}, 0xFF, at, base, 1));
    } else
#endif
#if defined(__AVX2__)
        if constexpr (sizeof(V) == 32) {
        if constexpr (words) {
            return reinterpret_cast<V>(
                _mm256_i32gather_epi32(static_cast<const int*>(base), reinterpret_cast<__m256i>(offsets), 1));
        } else {
            return reinterpret_cast<V>(
                _mm256_i32gather_epi64(static_cast<const long long*>(base), reinterpret_cast<__m128i>(offsets), 1));
        }
    } else
#endif
    {
        V result{};
        for (unsigned i = 0; i < sizeof(V) / sizeof(result[0]); ++i) {
            auto element = result[0];
            std::memcpy(&element, static_cast<const char*>(base) + offsets[i], sizeof(element));
            result[i] = element;
        }
        return result;
    }
}

/// The 32-bit elements at the given places of a register.
template <class V, class Places>
TANDEM_HD_INLINE V permute(V values, Places places) {
    static_assert(sizeof(V) == sizeof(Places) && sizeof(values[0]) == 4);
#if defined(__AVX512F__) && defined(__AVX512DQ__)
    if constexpr (sizeof(V) == 64) {
        return reinterpret_cast<V>(_mm512_maskz_permutexvar_epi32(0xFFFF, reinterpret_cast<__m512i>(places),
                                                                  reinterpret_cast<__m512i>(values)));
    } else
#endif
#if defined(__AVX2__)
        if constexpr (sizeof(V) == 32) {
        return reinterpret_cast<V>(
            _mm256_permutevar8x32_epi32(reinterpret_cast<__m256i>(values), reinterpret_cast<__m256i>(places)));
    } else
#endif
    {
        return gather<V>(&values, places << 2);
    }
}

}  // namespace lanes_detail

}  // namespace tandem
