/// A packet of rays as a Real (math/real.h): Lanes<T, Isa> holds one T per ray and behaves like a T, so that a formula
/// written for one ray also runs for 4, 8 or 16. Each operation is the IEEE operation in every lane, so the bits are
/// those of the scalar formula.
///
/// The instruction set is a type parameter, not only a compiler flag: so code for different sets has different names,
/// and the linker cannot replace one by another. A float vector fills one register of the set; a double vector takes
/// two. Host only. The set must be enabled for the file that instantiates it (cpu/CMakeLists.txt).
#pragma once

#include "tandem/math/lane_mask.h"

namespace tandem {

template <class T, class I>
struct Lanes {
    static constexpr int size = I::bytes / 4;
    static constexpr int parts = sizeof(T) / 4;
    using Isa = I;
    using Vector = typename lanes_detail::Native<T, I::bytes>::type;
    using Index = typename lanes_detail::Native<std::int32_t, I::bytes>::type;
    Vector part[parts];

    Lanes() = default;
    /// The same value in every lane.
    TANDEM_HD_INLINE Lanes(T value) {
        // adding 0 would lose the sign of -0, and takes an instruction
        for (int k = 0; k < parts; ++k) part[k] = value - Vector{};
    }
    /// Lane i holds make(i).
    template <class Make>
    TANDEM_HD_INLINE static Lanes from(Make make) {
        Lanes result;
        for (int i = 0; i < size; ++i) result.set(i, make(i));
        return result;
    }

    /// Lane i holds the T at offsets[i] bytes from `base`.
    TANDEM_HD_INLINE static Lanes gather(const void* base, const Lanes<std::uint32_t, I>& offsets) {
        Lanes result;
        if constexpr (parts == 1) {
            result.part[0] = lanes_detail::gather<Vector>(base, offsets.part[0]);
        } else {
            result.part[0] = lanes_detail::gather<Vector>(base, lanes_detail::half<0>(offsets.part[0]));
            result.part[1] = lanes_detail::gather<Vector>(base, lanes_detail::half<1>(offsets.part[0]));
        }
        return result;
    }

    TANDEM_HD_INLINE T operator[](int lane) const { return part[lane / (size / parts)][lane % (size / parts)]; }
    TANDEM_HD_INLINE void set(int lane, T value) { part[lane / (size / parts)][lane % (size / parts)] = value; }

    template <class Op>
    TANDEM_HD_INLINE static Lanes zip(const Lanes& a, const Lanes& b, Op op) {
        Lanes result;
        for (int k = 0; k < parts; ++k) result.part[k] = op(a.part[k], b.part[k]);
        return result;
    }
    template <lanes_detail::Comparison comparison>
    TANDEM_HD_INLINE static LaneMask<I> compare(const Lanes& a, const Lanes& b) {
#if TANDEM_MASK_REGISTERS
        if constexpr (I::bytes == 64) {
            using lanes_detail::compare_bits;
            const auto first = compare_bits<comparison>(a.part[0], b.part[0]);
            if constexpr (parts == 1) {
                return LaneMask<I>(first);
            } else {
                return LaneMask<I>(lanes_detail::join_bits(first, compare_bits<comparison>(a.part[1], b.part[1])));
            }
        } else
#endif
        {
            const auto of_part = [&](int k) {
                return reinterpret_cast<Index>(lanes_detail::compare<comparison>(a.part[k], b.part[k]));
            };
            if constexpr (parts == 1) {
                return LaneMask<I>(of_part(0));
            } else {
                return LaneMask<I>(lanes_detail::even_elements(of_part(0), of_part(1)));
            }
        }
    }

#define TANDEM_LANES_OPERATOR(op)                                               \
    TANDEM_HD_INLINE friend Lanes operator op(const Lanes& a, const Lanes& b) { \
        return zip(a, b, [](Vector x, Vector y) { return Vector(x op y); });    \
    }
    TANDEM_LANES_OPERATOR(+)
    TANDEM_LANES_OPERATOR(-)
    TANDEM_LANES_OPERATOR(*)
    TANDEM_LANES_OPERATOR(/)
    TANDEM_LANES_OPERATOR(&)
    TANDEM_LANES_OPERATOR(|)
    TANDEM_LANES_OPERATOR(^)
#undef TANDEM_LANES_OPERATOR
#define TANDEM_LANES_COMPARISON(op, name)                                             \
    TANDEM_HD_INLINE friend LaneMask<I> operator op(const Lanes& a, const Lanes& b) { \
        return compare<lanes_detail::Comparison::name>(a, b);                         \
    }
    TANDEM_LANES_COMPARISON(<, less)
    TANDEM_LANES_COMPARISON(<=, less_equal)
    TANDEM_LANES_COMPARISON(>, greater)
    TANDEM_LANES_COMPARISON(>=, greater_equal)
    TANDEM_LANES_COMPARISON(==, equal)
    TANDEM_LANES_COMPARISON(!=, not_equal)
#undef TANDEM_LANES_COMPARISON
    TANDEM_HD_INLINE Lanes operator-() const {
        Lanes result;
        for (int k = 0; k < parts; ++k) result.part[k] = -part[k];
        return result;
    }
    TANDEM_HD_INLINE Lanes operator>>(int count) const {
        Lanes result;
        for (int k = 0; k < parts; ++k) result.part[k] = part[k] >> count;
        return result;
    }
    TANDEM_HD_INLINE Lanes operator<<(int count) const {
        Lanes result;
        for (int k = 0; k < parts; ++k) result.part[k] = part[k] << count;
        return result;
    }
    TANDEM_HD_INLINE Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
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

template <class T, class I>
TANDEM_HD_INLINE Lanes<T, I> select(const LaneMask<I>& mask, const Lanes<T, I>& a, const Lanes<T, I>& b) {
    Lanes<T, I> result;
#if TANDEM_MASK_REGISTERS
    if constexpr (I::bytes == 64) {
        using namespace lanes_detail;
        if constexpr (Lanes<T, I>::parts == 1) {
            result.part[0] = choose_bits(mask.v, a.part[0], b.part[0]);
        } else {
            result.part[0] = choose_bits(first_bits(mask.v), a.part[0], b.part[0]);
            result.part[1] = choose_bits(second_bits(mask.v), a.part[1], b.part[1]);
        }
    } else
#endif
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

// The formulas of real.h, in one instruction.
template <class T, class I>
requires std::is_floating_point_v<T> TANDEM_HD_INLINE Lanes<T, I> lesser(const Lanes<T, I>& a, const Lanes<T, I>& b) {
    return Lanes<T, I>::zip(b, a, [](auto x, auto y) { return lanes_detail::minimum(x, y); });
}
template <class T, class I>
requires std::is_floating_point_v<T> TANDEM_HD_INLINE Lanes<T, I> greater(const Lanes<T, I>& a, const Lanes<T, I>& b) {
    return Lanes<T, I>::zip(b, a, [](auto x, auto y) { return lanes_detail::maximum(x, y); });
}

/// Floats or integers as doubles.
template <class T, class I>
TANDEM_HD_INLINE Lanes<double, I> to_wide(const Lanes<T, I>& a) {
    using Vector = typename Lanes<double, I>::Vector;
    Lanes<double, I> result;
    result.part[0] = __builtin_convertvector(lanes_detail::half<0>(a.part[0]), Vector);
    result.part[1] = __builtin_convertvector(lanes_detail::half<1>(a.part[0]), Vector);
    return result;
}
template <class I>
TANDEM_HD_INLINE Lanes<double, I> to_wide(const Lanes<double, I>& a) {
    return a;
}

/// Values as the type of decisions.
template <class T, class I>
TANDEM_HD_INLINE Double<Lanes<T, I>> widen(const Lanes<T, I>& a) {
    if constexpr (is_fast_isa<I>) {
        return a;
    } else {
        return to_wide(a);
    }
}

template <class I>
TANDEM_HD_INLINE Lanes<float, I> narrow(const Lanes<double, I>& a) {
    using Half = typename lanes_detail::Native<float, I::bytes / 2>::type;
    Lanes<float, I> result;
    result.part[0] =
        lanes_detail::join(__builtin_convertvector(a.part[0], Half), __builtin_convertvector(a.part[1], Half));
    TANDEM_KEEP_ROUNDING(result.part[0]);
    return result;
}

template <class I>
TANDEM_HD_INLINE Lanes<float, I> narrow(const Lanes<float, I>& a) {
    return a;
}

template <class T, class I>
TANDEM_HD_INLINE Lanes<T, I> square_root(const Lanes<T, I>& a) {
    Lanes<T, I> result;
    for (int k = 0; k < Lanes<T, I>::parts; ++k) result.part[k] = lanes_detail::square_root(a.part[k]);
    return result;
}

template <class I>
TANDEM_HD_INLINE Lanes<double, I> multiply_add(const Lanes<double, I>& a, const Lanes<double, I>& b,
                                               const Lanes<double, I>& c) {
    Lanes<double, I> result;
    for (int k = 0; k < 2; ++k) result.part[k] = lanes_detail::multiply_add(a.part[k], b.part[k], c.part[k]);
    return result;
}

template <class I>
TANDEM_HD_INLINE Lanes<float, I> loose_multiply_add(const Lanes<float, I>& a, const Lanes<float, I>& b,
                                                    const Lanes<float, I>& c) {
    Lanes<float, I> result;
    result.part[0] = lanes_detail::loose_multiply_add(a.part[0], b.part[0], c.part[0]);
    return result;
}

template <class I>
TANDEM_HD_INLINE Lanes<double, I> round_to_int(const Lanes<double, I>& a) {
    Lanes<double, I> result;
    for (int k = 0; k < 2; ++k) result.part[k] = lanes_detail::round_to_int(a.part[k]);
    return result;
}

template <class To, class From, class I>
TANDEM_HD_INLINE Lanes<To, I> reinterpret_lanes(const Lanes<From, I>& a) {
    static_assert(sizeof(To) == sizeof(From));
    Lanes<To, I> result;
    for (int k = 0; k < Lanes<To, I>::parts; ++k) {
        result.part[k] = reinterpret_cast<typename Lanes<To, I>::Vector>(a.part[k]);
    }
    return result;
}

template <class I>
TANDEM_HD_INLINE Lanes<std::uint64_t, I> bits_of(const Lanes<double, I>& a) {
    return reinterpret_lanes<std::uint64_t>(a);
}
template <class I>
TANDEM_HD_INLINE Lanes<double, I> double_of(const Lanes<std::uint64_t, I>& a) {
    return reinterpret_lanes<double>(a);
}
template <class I>
TANDEM_HD_INLINE Lanes<std::uint32_t, I> bits_of(const Lanes<float, I>& a) {
    return reinterpret_lanes<std::uint32_t>(a);
}
template <class I>
TANDEM_HD_INLINE Lanes<float, I> float_of(const Lanes<std::uint32_t, I>& a) {
    return reinterpret_lanes<float>(a);
}

template <class I>
TANDEM_HD_INLINE Lanes<float, I> absolute(const Lanes<float, I>& a) {
    return float_of(bits_of(a) & Lanes<std::uint32_t, I>(0x7FFFFFFFU));
}
template <class I>
TANDEM_HD_INLINE Lanes<double, I> absolute(const Lanes<double, I>& a) {
    return double_of(bits_of(a) & Lanes<std::uint64_t, I>(0x7FFFFFFFFFFFFFFF));
}

template <class I>
TANDEM_HD_INLINE Lanes<float, I> to_float(const Lanes<std::uint32_t, I>& a) {
    Lanes<float, I> result;
    result.part[0] =
        __builtin_convertvector(reinterpret_lanes<std::int32_t>(a).part[0], typename Lanes<float, I>::Vector);
    return result;
}

template <class T, class I>
TANDEM_HD_INLINE Lanes<std::uint32_t, I> to_word(const Lanes<T, I>& a) {
    using Whole = typename Lanes<std::int32_t, I>::Vector;
    Lanes<std::int32_t, I> result;
    if constexpr (Lanes<T, I>::parts == 1) {
        result.part[0] = __builtin_convertvector(a.part[0], Whole);
    } else {
        using Half = typename lanes_detail::Native<std::int32_t, I::bytes / 2>::type;
        result.part[0] =
            lanes_detail::join(__builtin_convertvector(a.part[0], Half), __builtin_convertvector(a.part[1], Half));
    }
    return reinterpret_lanes<std::uint32_t>(result);
}

template <class I>
TANDEM_HD_INLINE void multiply_wide(const Lanes<std::uint32_t, I>& a, const Lanes<std::uint32_t, I>& b,
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

template <class I>
TANDEM_HD_INLINE Lanes<std::uint32_t, I> reversed_bits(Lanes<std::uint32_t, I> x) {
    x.part[0] = lanes_detail::reversed_bits_of(x.part[0]);
    return x;
}

template <class T, class I>
TANDEM_HD_INLINE T lane(const Lanes<T, I>& value, int i) {
    return value[i];
}
template <class I>
TANDEM_HD_INLINE bool lane(const LaneMask<I>& mask, int i) {
    return mask[i];
}
template <class T, class I>
TANDEM_HD_INLINE void set_lane(Lanes<T, I>& value, int i, T lane_value) {
    value.set(i, lane_value);
}

/// Calls f(value, mask) once for each different value among the lanes of `active`.
template <class I, class F>
TANDEM_HD_INLINE void for_each_unique_lane(const Lanes<std::uint32_t, I>& values, LaneMask<I> active, F f) {
    while (any(active)) {
        const std::uint32_t value = values[lowest_bit(active.bits())];
        const LaneMask<I> here = active && values == Lanes<std::uint32_t, I>(value);
        f(value, here);
        active = active && !here;
    }
}

/// Lane numbers 0, 1, 2, ...
template <class I>
TANDEM_HD_INLINE Lanes<std::uint32_t, I> lane_index(const Lanes<std::uint32_t, I>&) {
    return Lanes<std::uint32_t, I>::from([](int lane) { return static_cast<std::uint32_t>(lane); });
}

/// Lane i is the value of lane[i]; each lane number is below the size.
template <class T, class I>
TANDEM_HD_INLINE Lanes<T, I> permute(const Lanes<T, I>& values, const Lanes<std::uint32_t, I>& lane) {
    static_assert(Lanes<T, I>::parts == 1);
    Lanes<T, I> result;
    result.part[0] = lanes_detail::permute(values.part[0], lane.part[0]);
    return result;
}

/// For each lane, how many lanes of the mask are before it.
template <class I>
TANDEM_HD_INLINE Lanes<std::uint32_t, I> lanes_before(const LaneMask<I>& mask) {
    using Word = Lanes<std::uint32_t, I>;
    static_assert(Word::size <= 16);
    const Word before = Word::from([](int lane) { return (1U << lane) - 1U; });
    // counts bits in ever larger groups
    Word count = Word(mask.bits()) & before;
    count = count - ((count >> 1) & Word(0x5555U));
    count = (count & Word(0x3333U)) + ((count >> 2) & Word(0x3333U));
    count = (count + (count >> 4)) & Word(0x0F0FU);
    return (count + (count >> 8)) & Word(0x1FU);
}

}  // namespace tandem
