/// Random numbers are keyed by dimension name and vertex: every use has its own dimension, so that an effect does not
/// change the numbers of others.
#pragma once

#include "tandem/kernel/sampler/philox.h"

namespace tandem {

/// Each has a block of four numbers for every vertex of a path.
enum class Dimension : std::uint32_t {
    film = 0,         ///< numbers 0 and 1: position within the pixel; at vertex 0 only
    scatter = 1,      ///< number 0: choice of a lobe; 1: reflection or refraction; 2: Russian roulette
    lens = 2,         ///< numbers 0 and 1: point on the lens; at vertex 0 only
    area_light = 3,   ///< numbers 0 and 3: which light; 1 and 2: the point on it
    hemisphere = 4,   ///< numbers 0 and 1: direction from a diffuse lobe
    environment = 5,  ///< numbers 0 and 1: direction to the background; all four: to the environment picture
    light = 6,        ///< all four: the light that gets the shadow ray (light_reservoir.h)
    microfacets = 7,  ///< numbers 0 and 1: direction from a glossy lobe
};

namespace sampler_detail {

template <class Word>
TANDEM_HD_CALL_ON(device)
PhiloxBlock<Word> philox_by_call(PhiloxBlock<Word> counter, std::uint32_t key0, std::uint32_t key1) {
    return philox4x32<Word>(counter, key0, key1);
}

}  // namespace sampler_detail

/// A sample of a pixel, for each lane of `Real`. Its random numbers depend on nothing else.
template <class Real>
struct SampleId {
    const PhiloxKeys* keys;  ///< of the seed
    std::uint32_t frame;
    UInt<Real> pixel;
    UInt<Real> sample;

    /// The four numbers of a dimension at a vertex (0: where the camera ray hits), as uniform bits. The counter is
    /// (pixel, sample, dimension and vertex, frame) and the key is the seed, so each combination has its own numbers
    /// without any state.
    TANDEM_HD_INLINE PhiloxBlock<UInt<Real>> block(Dimension dimension,
                                                   const UInt<Real>& vertex = UInt<Real>(0U)) const {
        return philox4x32(counter(dimension, vertex), *keys);
    }
    /// The same, but out of line on the device, for numbers that a path needs at every vertex.
    TANDEM_HD_INLINE PhiloxBlock<UInt<Real>> block_at_vertex(Dimension dimension, const UInt<Real>& vertex) const {
        return sampler_detail::philox_by_call<UInt<Real>>(counter(dimension, vertex), keys->of_round[0][0],
                                                          keys->of_round[0][1]);
    }

  private:
    TANDEM_HD_INLINE PhiloxBlock<UInt<Real>> counter(Dimension dimension, const UInt<Real>& vertex) const {
        using Word = UInt<Real>;
        return {{pixel, sample, (vertex << 8) | Word(static_cast<std::uint32_t>(dimension)), Word(frame)}};
    }
};

}  // namespace tandem
