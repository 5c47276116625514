/// Random numbers by name: every use of one has a dimension of its own, so that an effect that is off does not
/// shift the numbers of the others.
#pragma once

#include "tandem/sampler/philox.h"

namespace tandem {

/// One block of four numbers each.
enum class Dimension : std::uint32_t {
    film = 0,  ///< numbers 0 and 1: position within the pixel
};

/// The four numbers of a dimension for one sample of one pixel, as uniform bits.
/// The counter is (pixel, sample, dimension, frame) and the key the seed: each combination once, no state.
template <class Real>
TANDEM_HD PhiloxBlock<UInt<Real>> random_block(std::uint64_t seed, std::uint32_t frame, const UInt<Real>& pixel,
                                               std::uint32_t sample, Dimension dimension) {
    using Word = UInt<Real>;
    return philox4x32<Word>({{pixel, Word(sample), Word(static_cast<std::uint32_t>(dimension)), Word(frame)}},
                            static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32));
}

}  // namespace tandem
