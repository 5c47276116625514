/// Pairs of dimensions of an Owen-scrambled Sobol sequence.
///
/// A pair's points are the first two dimensions of the Sobol sequence, which are a (0, 2)-sequence in base 2: of 2^k
/// points from a multiple of 2^k on, every box of 2^-a by 2^-b with a + b = k holds exactly one. Scrambling and the
/// shuffling of numbers keep this. Pairs differ in the order of their points and in their scrambling, so that together
/// they are as if independent ("padding").
///
/// Source: B. Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020, with the nested permutation of S. Laine,
///         T. Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011, in N. Vegdahl's form ("Building a
///         Better LK Hash", 2021). The order over pixels follows A. Ahmed, P. Wonka, "Screen-Space Blue-Noise Diffusion
///         of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels", ACM TOG 39(6), 2020, with matrices that
///         need not know the number of samples: see sobol_pair_among_pixels().
/// Tested by tests/kernel/sampler/sobol_test.cpp.
#pragma once

#include "tandem/kernel/sampler/hash.h"

namespace tandem {

/// A point, as fractions of 2^32.
template <class Word>
struct SobolPair {
    Word u, v;
};

/// The seeds of a pair's permutations.
template <class Word>
struct SobolSeeds {
    Word order;    ///< of its points
    Word u, v;     ///< of the scrambling of each dimension
    Word of_tile;  ///< of the order of pixels; for sobol_pair_among_pixels() alone
};

namespace sobol_detail {

/// A random permutation of words, by `seed`, in which a bit depends on itself and on less significant bits alone.
template <class Word>
TANDEM_HD_INLINE Word nested_permutation(Word x, const Word& seed) {
    x = x ^ (x * Word(0x3D20ADEAU));
    x = x + seed;
    x = x * ((seed >> 16) | Word(1U));
    x = x ^ (x * Word(0x05526C56U));
    return x ^ (x * Word(0x53A22864U));
}

/// Owen's scrambling of a fraction: each bit depends on itself and on more significant bits.
template <class Word>
TANDEM_HD_INLINE Word scrambled(const Word& x, const Word& seed) {
    return reversed_bits(nested_permutation(reversed_bits(x), seed));
}

// Pascal's triangle modulo 2 as a matrix, with bit 0 the most significant one: bit j of the result is the sum of bits i
// times "i choose j". It is the Kronecker product of five matrices of 2 x 2, since "i choose j" modulo 2 is the product
// of those of the binary digits (Lucas).
template <class Word>
TANDEM_HD_INLINE Word pascal(Word x) {
    x = x ^ (x << 16);
    x = x ^ ((x << 8) & Word(0xFF00FF00U));
    x = x ^ ((x << 4) & Word(0xF0F0F0F0U));
    x = x ^ ((x << 2) & Word(0xCCCCCCCCU));
    return x ^ ((x << 1) & Word(0xAAAAAAAAU));
}
/// The transposed matrix: "j choose i".
template <class Word>
TANDEM_HD_INLINE Word pascal_transposed(Word x) {
    x = x ^ (x >> 16);
    x = x ^ ((x >> 8) & Word(0x00FF00FFU));
    x = x ^ ((x >> 4) & Word(0x0F0F0F0FU));
    x = x ^ ((x >> 2) & Word(0x33333333U));
    return x ^ ((x >> 1) & Word(0x55555555U));
}

}  // namespace sobol_detail

/// The point of a pair for a sample. `sample`: its number, with reversed_bits() bits. Of a number with reversed bits,
/// the nested permutation shuffles aligned blocks of 2^k numbers, for every k.
template <class Word>
TANDEM_HD_INLINE SobolPair<Word> sobol_pair(const Word& sample, const SobolSeeds<Word>& seeds) {
    using namespace sobol_detail;
    const Word number = nested_permutation(sample, seeds.order);
    return {scrambled(number, seeds.u), scrambled(pascal(number), seeds.v)};
}

/// The same for pixels that share their seeds, and differ in `place`: their number on a Morton curve, with
/// reversed_bits() bits. The samples of a pixel are a (0, 2)-sequence as before. In addition the first 2^k samples of
/// each of 2^j pixels of an aligned block together have one in each of 2^(k + j) intervals of u, and of v; and the
/// first samples of these pixels are a (0, 2)-net. So neighbours err in different directions. Method: u = s + P^T P m
/// and v = P s + P^T m, modulo 2, for the bits of the sample's number s and of the pixel's m,
///         and Pascal's matrix P. The first k columns of 1 and of P span the first k bits; the blocks of j rows from
///         the k-th on of the first j columns of P^T P and of P^T have the determinant 1.
template <class Word>
TANDEM_HD_INLINE SobolPair<Word> sobol_pair_among_pixels(const Word& sample, const Word& place,
                                                         const SobolSeeds<Word>& seeds) {
    using namespace sobol_detail;
    const Word number = nested_permutation(sample, seeds.order);
    const Word pixel = nested_permutation(place, seeds.of_tile);
    const Word u = number ^ pascal_transposed(pascal(pixel));
    const Word v = pascal(number) ^ pascal_transposed(pixel);
    return {scrambled(u, seeds.u), scrambled(v, seeds.v)};
}

/// The number of a pixel on a Morton curve, whose aligned squares of 2^j by 2^j pixels have 4^j numbers that follow
/// each other. x, y < 65536.
template <class Word>
TANDEM_HD_INLINE Word morton(const Word& x, const Word& y) {
    const auto spread = [](Word a) __attribute__((always_inline)) {
        a = (a | (a << 8)) & Word(0x00FF00FFU);
        a = (a | (a << 4)) & Word(0x0F0F0F0FU);
        a = (a | (a << 2)) & Word(0x33333333U);
        return (a | (a << 1)) & Word(0x55555555U);
    };
    return spread(x) | (spread(y) << 1);
}

}  // namespace tandem
