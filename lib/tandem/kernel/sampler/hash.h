/// A hash of 32 bits, for the seeds of scramblings.
#pragma once

#include "tandem/math/real.h"

namespace tandem {

/// Of words that differ by multiples of this, the hashes are independent: it is odd, 2^32 over the golden ratio.
inline constexpr std::uint32_t hash_step = 0x9E3779B9U;

/// A bijection of words whose bits look independent. Source: C. Wellons, "Prospecting for Hash Functions", 2018:
/// lowbias32.
template <class Word>
TANDEM_HD_INLINE Word hashed(Word x) {
    x = (x ^ (x >> 16)) * Word(0x7FEB352DU);
    x = (x ^ (x >> 15)) * Word(0x846CA68BU);
    return x ^ (x >> 16);
}

}  // namespace tandem
