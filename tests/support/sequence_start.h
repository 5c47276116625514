/// Inverts ShortSequence: finds the start that gives the wanted numbers.
#pragma once

#include <bit>

#include "tandem/kernel/sampler/philox.h"

namespace tandem::test {

/// A start whose first three numbers are these. `third_word` is free.
inline PhiloxBlock<std::uint32_t> sequence_start(std::uint32_t first, std::uint32_t second, std::uint32_t third,
                                                 std::uint32_t third_word) {
    const std::uint32_t c = third_word;
    const std::uint32_t next_b = 9 * c, next_c = std::rotl(c, 21) + first;
    const std::uint32_t counter = third - (next_b ^ (next_b >> 9)) - 9 * next_c - 2;
    const std::uint32_t mixed = second - next_b - counter - 1;  // b ^ (b >> 9)
    const std::uint32_t b = mixed ^ (mixed >> 9) ^ (mixed >> 18) ^ (mixed >> 27);
    return {{first - b - counter, b, c, counter}};
}

}  // namespace tandem::test
