/// Random numbers by name: every use of one has a dimension of its own, so that an effect that is off does not
/// shift the numbers of the others.
#pragma once

#include "tandem/sampler/philox.h"

namespace tandem {

/// One block of four numbers each, for every vertex of a path.
enum class Dimension : std::uint32_t {
    film = 0,     ///< numbers 0 and 1: position within the pixel. Of the path, at vertex 0.
    scatter = 1,  ///< number 0: how a path goes on; 1: reflected or refracted
};

/// One sample of one pixel, of `Real`'s lanes. Its random numbers hang on nothing else.
template <class Real>
struct SampleId {
    std::uint64_t seed;
    std::uint32_t frame;
    UInt<Real> pixel;
    std::uint32_t sample;

    /// The four numbers of a dimension at a vertex (0: where the camera ray hits), as uniform bits. The counter is
    /// (pixel, sample, dimension and vertex, frame) and the key the seed: each combination once, no state.
    TANDEM_HD PhiloxBlock<UInt<Real>> block(Dimension dimension, std::uint32_t vertex = 0) const {
        using Word = UInt<Real>;
        const std::uint32_t place = (vertex << 8) | static_cast<std::uint32_t>(dimension);
        return philox4x32<Word>({{pixel, Word(sample), Word(place), Word(frame)}}, static_cast<std::uint32_t>(seed),
                                static_cast<std::uint32_t>(seed >> 32));
    }
};

}  // namespace tandem
