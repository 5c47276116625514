/// Philox4x32-10, a counter-based random number generator.
#pragma once

#include "tandem/math/real.h"

namespace tandem {

template <class Word>
struct PhiloxBlock {
    Word word[4];
};

inline constexpr int philox_rounds = 10;

/// The keys of the rounds. Host code forms them once for a seed: on a GPU they are then constants among the kernel's
/// parameters; forming them there would take two additions a round.
struct PhiloxKeys {
    std::uint32_t of_round[philox_rounds][2];
};

TANDEM_HD_INLINE constexpr PhiloxKeys philox_keys(std::uint32_t key0, std::uint32_t key1) {
    PhiloxKeys keys{};
#if TANDEM_ON_DEVICE
#pragma unroll
#endif
    for (auto& of_round : keys.of_round) {
        of_round[0] = key0;
        of_round[1] = key1;
        key0 += 0x9E3779B9U;
        key1 += 0xBB67AE85U;
    }
    return keys;
}
[[nodiscard]] TANDEM_HD_INLINE constexpr PhiloxKeys philox_keys(std::uint64_t seed) {
    return philox_keys(static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32));
}

/// Ten rounds over a 128-bit counter under a 64-bit key: for each key a bijection of the counters, so different
/// counters never give the same block.
/// Source: J. Salmon, M. Moraes, R. Dror, D. Shaw, "Parallel Random Numbers: As Easy as 1, 2, 3", SC 2011, sec. 3.3;
/// checked against the authors' known answers in tests/kernel/sampler/philox_test.cpp.
template <class Word>
TANDEM_HD_INLINE PhiloxBlock<Word> philox4x32(PhiloxBlock<Word> counter, const PhiloxKeys& keys) {
    const Word multiplier0(0xD2511F53U);
    const Word multiplier1(0xCD9E8D57U);
#if TANDEM_ON_DEVICE
#pragma unroll
#endif
    for (int round = 0; round < philox_rounds; ++round) {
        Word high0, low0, high1, low1;
        multiply_wide(multiplier0, counter.word[0], high0, low0);
        multiply_wide(multiplier1, counter.word[2], high1, low1);
        const Word key0(keys.of_round[round][0]), key1(keys.of_round[round][1]);
        counter = {{high1 ^ counter.word[1] ^ key0, low1, high0 ^ counter.word[3] ^ key1, low0}};
    }
    return counter;
}
template <class Word>
TANDEM_HD_INLINE PhiloxBlock<Word> philox4x32(const PhiloxBlock<Word>& counter, std::uint32_t key0,
                                              std::uint32_t key1) {
    return philox4x32(counter, philox_keys(key0, key1));
}

/// Uniform in [0, 1): the upper 24 bits, so that every value is exact in float and below 1.
template <class Real>
TANDEM_HD_INLINE Real to_unit_interval(const UInt<Real>& word) {
    return from_uint<Real>(word >> 8) * Real(0x1p-24F);
}

}  // namespace tandem
