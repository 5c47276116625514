/// A packet of rays as a Real (math/real.h): Lanes<T, Isa> holds one T per ray and behaves like a T, so that a
/// formula written once for one ray runs for 4, 8 or 16. Each operation is the IEEE operation of its lane, hence
/// the bits are those of the scalar formula.
///
/// The instruction set is a type parameter, not only a compiler flag: code for different sets then has different
/// names, and the linker cannot replace one by another. A float vector fills one register of the set; a double
/// vector takes two. Host only. The set must be enabled for the file that instantiates it (cpu/CMakeLists.txt).
#pragma once

#include <immintrin.h>

#include <cstdint>
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
TANDEM_HD auto half(V v) {
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
TANDEM_HD auto join(H a, H b) {
    constexpr int n = sizeof(H) / 4;
    if constexpr (n == 2) {
        return __builtin_shufflevector(a, b, 0, 1, 2, 3);
    } else if constexpr (n == 4) {
        return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    } else {
        return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    }
}

/// The even 32-bit elements of a, then those of b: narrows a pair of 64-bit masks to one 32-bit mask.
template <class V>
TANDEM_HD V even_elements(V a, V b) {
    constexpr int n = sizeof(V) / 4;
    if constexpr (n == 4) {
        return __builtin_shufflevector(a, b, 0, 2, 4, 6);
    } else if constexpr (n == 8) {
        return __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14);
    } else {
        return __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    }
}

// The few operations that have no operator in the compilers' vector extension, per register width.
template <class V, class Scalar>
TANDEM_HD V per_element(V a, Scalar scalar) {
    for (unsigned i = 0; i < sizeof(V) / sizeof(a[0]); ++i) a[i] = scalar(a[i]);
    return a;
}

using F16 = Native<float, 16>::type;
using D16 = Native<double, 16>::type;
using U16 = Native<std::uint32_t, 16>::type;
TANDEM_HD F16 square_root(F16 a) { return reinterpret_cast<F16>(_mm_sqrt_ps(reinterpret_cast<__m128>(a))); }
TANDEM_HD D16 square_root(D16 a) { return reinterpret_cast<D16>(_mm_sqrt_pd(reinterpret_cast<__m128d>(a))); }
TANDEM_HD D16 multiply_add(D16 a, D16 b, D16 c) {
#if defined(__FMA__)
    return reinterpret_cast<D16>(
        _mm_fmadd_pd(reinterpret_cast<__m128d>(a), reinterpret_cast<__m128d>(b), reinterpret_cast<__m128d>(c)));
#else
    return D16{::fma(a[0], b[0], c[0]), ::fma(a[1], b[1], c[1])};
#endif
}
TANDEM_HD F16 loose_multiply_add(F16 a, F16 b, F16 c) {
#if defined(__FMA__)
    return reinterpret_cast<F16>(
        _mm_fmadd_ps(reinterpret_cast<__m128>(a), reinterpret_cast<__m128>(b), reinterpret_cast<__m128>(c)));
#else
    return a * b + c;
#endif
}
TANDEM_HD D16 round_to_int(D16 a) {
#if defined(__SSE4_1__)
    constexpr int nearest = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
    return reinterpret_cast<D16>(_mm_round_pd(reinterpret_cast<__m128d>(a), nearest));
#else
    return per_element(a, [](double x) { return ::rint(x); });
#endif
}
/// a < b ? a : b and a > b ? a : b, to the bit; the instructions mean just that, also for NaN and zeros.
TANDEM_HD F16 minimum(F16 a, F16 b) {
    return reinterpret_cast<F16>(_mm_min_ps(reinterpret_cast<__m128>(a), reinterpret_cast<__m128>(b)));
}
TANDEM_HD D16 minimum(D16 a, D16 b) {
    return reinterpret_cast<D16>(_mm_min_pd(reinterpret_cast<__m128d>(a), reinterpret_cast<__m128d>(b)));
}
TANDEM_HD F16 maximum(F16 a, F16 b) {
    return reinterpret_cast<F16>(_mm_max_ps(reinterpret_cast<__m128>(a), reinterpret_cast<__m128>(b)));
}
TANDEM_HD D16 maximum(D16 a, D16 b) {
    return reinterpret_cast<D16>(_mm_max_pd(reinterpret_cast<__m128d>(a), reinterpret_cast<__m128d>(b)));
}
#if defined(__SSE4_1__)
/// a where the sign bit of the mask is set, else b.
TANDEM_HD F16 blend(F16 mask, F16 a, F16 b) {
    return reinterpret_cast<F16>(
        _mm_blendv_ps(reinterpret_cast<__m128>(b), reinterpret_cast<__m128>(a), reinterpret_cast<__m128>(mask)));
}
TANDEM_HD D16 blend(D16 mask, D16 a, D16 b) {
    return reinterpret_cast<D16>(
        _mm_blendv_pd(reinterpret_cast<__m128d>(b), reinterpret_cast<__m128d>(a), reinterpret_cast<__m128d>(mask)));
}
#endif
/// 64-bit products of the even 32-bit elements.
TANDEM_HD U16 multiply_even(U16 a, U16 b) {
    return reinterpret_cast<U16>(_mm_mul_epu32(reinterpret_cast<__m128i>(a), reinterpret_cast<__m128i>(b)));
}

#if defined(__AVX2__) && defined(__FMA__)
using F32 = Native<float, 32>::type;
using D32 = Native<double, 32>::type;
using U32 = Native<std::uint32_t, 32>::type;
TANDEM_HD F32 square_root(F32 a) { return reinterpret_cast<F32>(_mm256_sqrt_ps(reinterpret_cast<__m256>(a))); }
TANDEM_HD D32 square_root(D32 a) { return reinterpret_cast<D32>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(a))); }
TANDEM_HD D32 multiply_add(D32 a, D32 b, D32 c) {
    return reinterpret_cast<D32>(
        _mm256_fmadd_pd(reinterpret_cast<__m256d>(a), reinterpret_cast<__m256d>(b), reinterpret_cast<__m256d>(c)));
}
TANDEM_HD F32 loose_multiply_add(F32 a, F32 b, F32 c) {
    return reinterpret_cast<F32>(
        _mm256_fmadd_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b), reinterpret_cast<__m256>(c)));
}
TANDEM_HD D32 round_to_int(D32 a) {
    constexpr int nearest = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
    return reinterpret_cast<D32>(_mm256_round_pd(reinterpret_cast<__m256d>(a), nearest));
}
TANDEM_HD F32 minimum(F32 a, F32 b) {
    return reinterpret_cast<F32>(_mm256_min_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b)));
}
TANDEM_HD D32 minimum(D32 a, D32 b) {
    return reinterpret_cast<D32>(_mm256_min_pd(reinterpret_cast<__m256d>(a), reinterpret_cast<__m256d>(b)));
}
TANDEM_HD F32 maximum(F32 a, F32 b) {
    return reinterpret_cast<F32>(_mm256_max_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b)));
}
TANDEM_HD D32 maximum(D32 a, D32 b) {
    return reinterpret_cast<D32>(_mm256_max_pd(reinterpret_cast<__m256d>(a), reinterpret_cast<__m256d>(b)));
}
TANDEM_HD F32 blend(F32 mask, F32 a, F32 b) {
    return reinterpret_cast<F32>(
        _mm256_blendv_ps(reinterpret_cast<__m256>(b), reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(mask)));
}
TANDEM_HD D32 blend(D32 mask, D32 a, D32 b) {
    return reinterpret_cast<D32>(
        _mm256_blendv_pd(reinterpret_cast<__m256d>(b), reinterpret_cast<__m256d>(a), reinterpret_cast<__m256d>(mask)));
}
TANDEM_HD U32 multiply_even(U32 a, U32 b) {
    return reinterpret_cast<U32>(_mm256_mul_epu32(reinterpret_cast<__m256i>(a), reinterpret_cast<__m256i>(b)));
}
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__)
// The maskz forms: in the plain ones GCC 12 sees the use of an uninitialised variable.
using F64 = Native<float, 64>::type;
using D64 = Native<double, 64>::type;
using U64 = Native<std::uint32_t, 64>::type;
TANDEM_HD F64 square_root(F64 a) {
    return reinterpret_cast<F64>(_mm512_maskz_sqrt_ps(0xFFFF, reinterpret_cast<__m512>(a)));
}
TANDEM_HD D64 square_root(D64 a) {
    return reinterpret_cast<D64>(_mm512_maskz_sqrt_pd(0xFF, reinterpret_cast<__m512d>(a)));
}
TANDEM_HD D64 multiply_add(D64 a, D64 b, D64 c) {
    return reinterpret_cast<D64>(
        _mm512_fmadd_pd(reinterpret_cast<__m512d>(a), reinterpret_cast<__m512d>(b), reinterpret_cast<__m512d>(c)));
}
TANDEM_HD F64 loose_multiply_add(F64 a, F64 b, F64 c) {
    return reinterpret_cast<F64>(
        _mm512_fmadd_ps(reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b), reinterpret_cast<__m512>(c)));
}
TANDEM_HD D64 round_to_int(D64 a) {
    constexpr int nearest = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
    return reinterpret_cast<D64>(_mm512_maskz_roundscale_pd(0xFF, reinterpret_cast<__m512d>(a), nearest));
}
TANDEM_HD F64 minimum(F64 a, F64 b) {
    return reinterpret_cast<F64>(_mm512_maskz_min_ps(0xFFFF, reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b)));
}
TANDEM_HD D64 minimum(D64 a, D64 b) {
    return reinterpret_cast<D64>(_mm512_maskz_min_pd(0xFF, reinterpret_cast<__m512d>(a), reinterpret_cast<__m512d>(b)));
}
TANDEM_HD F64 maximum(F64 a, F64 b) {
    return reinterpret_cast<F64>(_mm512_maskz_max_ps(0xFFFF, reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b)));
}
TANDEM_HD D64 maximum(D64 a, D64 b) {
    return reinterpret_cast<D64>(_mm512_maskz_max_pd(0xFF, reinterpret_cast<__m512d>(a), reinterpret_cast<__m512d>(b)));
}
TANDEM_HD U64 multiply_even(U64 a, U64 b) {
    return reinterpret_cast<U64>(
        _mm512_maskz_mul_epu32(0xFF, reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b)));
}
#endif

}  // namespace lanes_detail

/// One comparison result per lane: all ones or all zeros.
template <class Isa>
struct LaneMask {
    using Vector = typename lanes_detail::Native<std::int32_t, Isa::bytes>::type;
    Vector v;

    LaneMask() = default;
    TANDEM_HD explicit LaneMask(Vector bits) : v(bits) {}
    TANDEM_HD explicit LaneMask(bool all) : v(Vector{} - static_cast<std::int32_t>(all)) {}

    TANDEM_HD friend LaneMask operator&&(LaneMask a, LaneMask b) { return LaneMask(a.v & b.v); }
    TANDEM_HD friend LaneMask operator||(LaneMask a, LaneMask b) { return LaneMask(a.v | b.v); }
    TANDEM_HD friend LaneMask operator!=(LaneMask a, LaneMask b) { return LaneMask(a.v ^ b.v); }
    TANDEM_HD LaneMask operator!() const { return LaneMask(~v); }
    TANDEM_HD bool operator[](int lane) const { return v[lane] != 0; }
};

template <class Isa>
TANDEM_HD bool any(LaneMask<Isa> mask) {
    if constexpr (Isa::bytes == 16) {
        return _mm_movemask_ps(reinterpret_cast<__m128>(mask.v)) != 0;
#if defined(__AVX__)
    } else if constexpr (Isa::bytes == 32) {
        return _mm256_movemask_ps(reinterpret_cast<__m256>(mask.v)) != 0;
#endif
#if defined(__AVX512F__)
    } else {
        return _mm512_test_epi32_mask(reinterpret_cast<__m512i>(mask.v), reinterpret_cast<__m512i>(mask.v)) != 0;
#endif
    }
}

template <class Isa>
TANDEM_HD bool all(LaneMask<Isa> mask) {
    return !any(!mask);
}

template <class T, class I>
struct Lanes {
    static constexpr int size = I::bytes / 4;
    static constexpr int parts = sizeof(T) / 4;
    using Isa = I;
    using Vector = typename lanes_detail::Native<T, I::bytes>::type;
    using Index = typename lanes_detail::Native<std::int32_t, I::bytes>::type;
    Vector part[parts];

    Lanes() = default;
    TANDEM_HD Lanes(T value) {  // a scalar means the same value in every lane
        for (int k = 0; k < parts; ++k) part[k] = Vector{} + value;
    }
    /// Lane i holds make(i).
    template <class Make>
    TANDEM_HD static Lanes from(Make make) {
        Lanes result;
        for (int i = 0; i < size; ++i) result.set(i, make(i));
        return result;
    }

    TANDEM_HD T operator[](int lane) const { return part[lane / (size / parts)][lane % (size / parts)]; }
    TANDEM_HD void set(int lane, T value) { part[lane / (size / parts)][lane % (size / parts)] = value; }

    template <class Op>
    TANDEM_HD static Lanes zip(const Lanes& a, const Lanes& b, Op op) {
        Lanes result;
        for (int k = 0; k < parts; ++k) result.part[k] = op(a.part[k], b.part[k]);
        return result;
    }
    template <class Op>
    TANDEM_HD static LaneMask<I> compare(const Lanes& a, const Lanes& b, Op op) {
        if constexpr (parts == 1) {
            return LaneMask<I>(reinterpret_cast<Index>(op(a.part[0], b.part[0])));
        } else {
            return LaneMask<I>(lanes_detail::even_elements(reinterpret_cast<Index>(op(a.part[0], b.part[0])),
                                                           reinterpret_cast<Index>(op(a.part[1], b.part[1]))));
        }
    }

#define TANDEM_LANES_OPERATOR(op)                                            \
    TANDEM_HD friend Lanes operator op(const Lanes& a, const Lanes& b) {     \
        return zip(a, b, [](Vector x, Vector y) { return Vector(x op y); }); \
    }
    TANDEM_LANES_OPERATOR(+)
    TANDEM_LANES_OPERATOR(-)
    TANDEM_LANES_OPERATOR(*)
    TANDEM_LANES_OPERATOR(/)
    TANDEM_LANES_OPERATOR(&)
    TANDEM_LANES_OPERATOR(|)
    TANDEM_LANES_OPERATOR(^)
#undef TANDEM_LANES_OPERATOR
#define TANDEM_LANES_COMPARISON(op)                                            \
    TANDEM_HD friend LaneMask<I> operator op(const Lanes& a, const Lanes& b) { \
        return compare(a, b, [](Vector x, Vector y) { return x op y; });       \
    }
    TANDEM_LANES_COMPARISON(<)
    TANDEM_LANES_COMPARISON(<=)
    TANDEM_LANES_COMPARISON(>)
    TANDEM_LANES_COMPARISON(>=)
    TANDEM_LANES_COMPARISON(==)
    TANDEM_LANES_COMPARISON(!=)
#undef TANDEM_LANES_COMPARISON
    TANDEM_HD Lanes operator-() const {
        Lanes result;
        for (int k = 0; k < parts; ++k) result.part[k] = -part[k];
        return result;
    }
    TANDEM_HD Lanes operator>>(int count) const {
        Lanes result;
        for (int k = 0; k < parts; ++k) result.part[k] = part[k] >> count;
        return result;
    }
    TANDEM_HD Lanes operator<<(int count) const {
        Lanes result;
        for (int k = 0; k < parts; ++k) result.part[k] = part[k] << count;
        return result;
    }
    TANDEM_HD Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
};

template <class T, class I>
struct RealTraits<Lanes<T, I>> {
    using Scalar = T;
    using Mask = LaneMask<I>;
    using Float = Lanes<float, I>;
    using Double = Lanes<std::conditional_t<is_fast_isa<I>, float, double>, I>;
    using Wide = Lanes<double, I>;
    using UInt = Lanes<std::uint32_t, I>;
    using UInt64 = Lanes<std::uint64_t, I>;
    static constexpr int lanes = Lanes<T, I>::size;
    static constexpr bool fast = is_fast_isa<I>;
};

namespace lanes_detail {

/// mask ? a : b for a mask of all ones or all zeros per element. GCC 12 would compare the mask with zero first; clang
/// sees through the comparison that made the mask, but not through the instruction.
template <class M, class V>
TANDEM_HD V choose(M mask, V a, V b) {
#if defined(__SSE4_1__) && !defined(__clang__)
    if constexpr (sizeof(V) <= 32) {
        using Same = typename Native<std::conditional_t<sizeof(a[0]) == 4, float, double>, sizeof(V)>::type;
        return reinterpret_cast<V>(
            blend(reinterpret_cast<Same>(mask), reinterpret_cast<Same>(a), reinterpret_cast<Same>(b)));
    }
#endif
    return mask ? a : b;
}

}  // namespace lanes_detail

template <class T, class I>
TANDEM_HD Lanes<T, I> select(const LaneMask<I>& mask, const Lanes<T, I>& a, const Lanes<T, I>& b) {
    Lanes<T, I> result;
    if constexpr (Lanes<T, I>::parts == 1) {
        result.part[0] = lanes_detail::choose(mask.v, a.part[0], b.part[0]);
    } else {
        using Wide = typename lanes_detail::Native<std::int64_t, I::bytes>::type;
        const Wide first = __builtin_convertvector(lanes_detail::half<0>(mask.v), Wide);
        const Wide second = __builtin_convertvector(lanes_detail::half<1>(mask.v), Wide);
        result.part[0] = lanes_detail::choose(first, a.part[0], b.part[0]);
        result.part[1] = lanes_detail::choose(second, a.part[1], b.part[1]);
    }
    return result;
}

template <class I>
TANDEM_HD LaneMask<I> select(const LaneMask<I>& mask, const LaneMask<I>& a, const LaneMask<I>& b) {
    return LaneMask<I>((mask.v & a.v) | (~mask.v & b.v));
}

// As the formulas in real.h, in one instruction.
template <class T, class I>
requires std::is_floating_point_v<T> TANDEM_HD Lanes<T, I> lesser(const Lanes<T, I>& a, const Lanes<T, I>& b) {
    return Lanes<T, I>::zip(b, a, [](auto x, auto y) { return lanes_detail::minimum(x, y); });
}
template <class T, class I>
requires std::is_floating_point_v<T> TANDEM_HD Lanes<T, I> greater(const Lanes<T, I>& a, const Lanes<T, I>& b) {
    return Lanes<T, I>::zip(b, a, [](auto x, auto y) { return lanes_detail::maximum(x, y); });
}

template <class I>
TANDEM_HD Lanes<double, I> to_wide(const Lanes<float, I>& a) {
    using Vector = typename Lanes<double, I>::Vector;
    Lanes<double, I> result;
    result.part[0] = __builtin_convertvector(lanes_detail::half<0>(a.part[0]), Vector);
    result.part[1] = __builtin_convertvector(lanes_detail::half<1>(a.part[0]), Vector);
    return result;
}
template <class I>
TANDEM_HD Lanes<double, I> to_wide(const Lanes<double, I>& a) {
    return a;
}

/// Values as the type of decisions.
template <class T, class I>
TANDEM_HD Double<Lanes<T, I>> widen(const Lanes<T, I>& a) {
    if constexpr (is_fast_isa<I>) {
        return a;
    } else {
        return to_wide(a);
    }
}

template <class I>
TANDEM_HD Lanes<float, I> narrow(const Lanes<double, I>& a) {
    using Half = typename lanes_detail::Native<float, I::bytes / 2>::type;
    Lanes<float, I> result;
    result.part[0] =
        lanes_detail::join(__builtin_convertvector(a.part[0], Half), __builtin_convertvector(a.part[1], Half));
    TANDEM_KEEP_ROUNDING(result.part[0]);
    return result;
}

template <class I>
TANDEM_HD Lanes<float, I> narrow(const Lanes<float, I>& a) {
    return a;
}

template <class T, class I>
TANDEM_HD Lanes<T, I> square_root(const Lanes<T, I>& a) {
    Lanes<T, I> result;
    for (int k = 0; k < Lanes<T, I>::parts; ++k) result.part[k] = lanes_detail::square_root(a.part[k]);
    return result;
}

template <class I>
TANDEM_HD Lanes<double, I> multiply_add(const Lanes<double, I>& a, const Lanes<double, I>& b,
                                        const Lanes<double, I>& c) {
    Lanes<double, I> result;
    for (int k = 0; k < 2; ++k) result.part[k] = lanes_detail::multiply_add(a.part[k], b.part[k], c.part[k]);
    return result;
}

template <class I>
TANDEM_HD Lanes<float, I> loose_multiply_add(const Lanes<float, I>& a, const Lanes<float, I>& b,
                                             const Lanes<float, I>& c) {
    Lanes<float, I> result;
    result.part[0] = lanes_detail::loose_multiply_add(a.part[0], b.part[0], c.part[0]);
    return result;
}

template <class I>
TANDEM_HD Lanes<double, I> round_to_int(const Lanes<double, I>& a) {
    Lanes<double, I> result;
    for (int k = 0; k < 2; ++k) result.part[k] = lanes_detail::round_to_int(a.part[k]);
    return result;
}

template <class To, class From, class I>
TANDEM_HD Lanes<To, I> reinterpret_lanes(const Lanes<From, I>& a) {
    static_assert(sizeof(To) == sizeof(From));
    Lanes<To, I> result;
    for (int k = 0; k < Lanes<To, I>::parts; ++k) {
        result.part[k] = reinterpret_cast<typename Lanes<To, I>::Vector>(a.part[k]);
    }
    return result;
}

template <class I>
TANDEM_HD Lanes<std::uint64_t, I> bits_of(const Lanes<double, I>& a) {
    return reinterpret_lanes<std::uint64_t>(a);
}
template <class I>
TANDEM_HD Lanes<double, I> double_of(const Lanes<std::uint64_t, I>& a) {
    return reinterpret_lanes<double>(a);
}
template <class I>
TANDEM_HD Lanes<std::uint32_t, I> bits_of(const Lanes<float, I>& a) {
    return reinterpret_lanes<std::uint32_t>(a);
}
template <class I>
TANDEM_HD Lanes<float, I> float_of(const Lanes<std::uint32_t, I>& a) {
    return reinterpret_lanes<float>(a);
}

template <class I>
TANDEM_HD Lanes<float, I> absolute(const Lanes<float, I>& a) {
    return float_of(bits_of(a) & Lanes<std::uint32_t, I>(0x7FFFFFFFU));
}
template <class I>
TANDEM_HD Lanes<double, I> absolute(const Lanes<double, I>& a) {
    return double_of(bits_of(a) & Lanes<std::uint64_t, I>(0x7FFFFFFFFFFFFFFF));
}

template <class I>
TANDEM_HD Lanes<float, I> to_float(const Lanes<std::uint32_t, I>& a) {
    Lanes<float, I> result;
    result.part[0] =
        __builtin_convertvector(reinterpret_lanes<std::int32_t>(a).part[0], typename Lanes<float, I>::Vector);
    return result;
}

template <class I>
TANDEM_HD void multiply_wide(const Lanes<std::uint32_t, I>& a, const Lanes<std::uint32_t, I>& b,
                             Lanes<std::uint32_t, I>& high, Lanes<std::uint32_t, I>& low) {
    using Wide = typename lanes_detail::Native<std::uint64_t, I::bytes>::type;
    using Narrow = typename Lanes<std::uint32_t, I>::Vector;
    const auto odd = [](const Lanes<std::uint32_t, I>& x) {
        return reinterpret_cast<Narrow>(reinterpret_cast<Wide>(x.part[0]) >> 32);
    };
    const Wide even_product = reinterpret_cast<Wide>(lanes_detail::multiply_even(a.part[0], b.part[0]));
    const Wide odd_product = reinterpret_cast<Wide>(lanes_detail::multiply_even(odd(a), odd(b)));
    const Wide low_word = Wide{} + 0xFFFFFFFFU;
    high.part[0] = reinterpret_cast<Narrow>((even_product >> 32) | (odd_product & ~low_word));
    low.part[0] = reinterpret_cast<Narrow>((even_product & low_word) | (odd_product << 32));
}

template <class T, class I>
TANDEM_HD T lane(const Lanes<T, I>& value, int i) {
    return value[i];
}
template <class I>
TANDEM_HD bool lane(const LaneMask<I>& mask, int i) {
    return mask[i];
}
template <class T, class I>
TANDEM_HD void set_lane(Lanes<T, I>& value, int i, T lane_value) {
    value.set(i, lane_value);
}

/// Calls f(value, mask) once for each different value among the lanes of `active`.
template <class I, class F>
TANDEM_HD void for_each_value(const Lanes<std::uint32_t, I>& values, LaneMask<I> active, F f) {
    for (int lane = 0; lane < Lanes<std::uint32_t, I>::size; ++lane) {
        if (!active[lane]) continue;
        const std::uint32_t value = values[lane];
        const LaneMask<I> here = active && values == Lanes<std::uint32_t, I>(value);
        f(value, here);
        active = active && !here;
    }
}

/// Lane numbers 0, 1, 2, ...
template <class I>
TANDEM_HD Lanes<std::uint32_t, I> lane_index(const Lanes<std::uint32_t, I>&) {
    return Lanes<std::uint32_t, I>::from([](int lane) { return static_cast<std::uint32_t>(lane); });
}

}  // namespace tandem
