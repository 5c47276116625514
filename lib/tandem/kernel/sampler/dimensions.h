/// Random numbers are keyed by dimension name and vertex: every use has its own dimension, so that an effect does not
/// change the numbers of others.
#pragma once

#include "tandem/kernel/sampler/philox.h"
#include "tandem/kernel/sampler/sampler_kind.h"
#include "tandem/kernel/sampler/sobol.h"

namespace tandem {

/// Each has a block of four numbers for every vertex of a path. Samplers other than random make them in pairs of
/// numbers (first_of_pairs()): the coordinates of a point should be a pair.
enum class Dimension : std::uint32_t {
    film = 0,         ///< numbers 0 and 1: position in the filter of the pixel; at vertex 0 only
    scatter = 1,      ///< number 0: choice of a lobe; 1: reflection or refraction; 2: Russian roulette
    lens = 2,         ///< numbers 0 and 1: point on the lens; at vertex 0 only
    area_light = 3,   ///< numbers 0 and 3: which light; 1 and 2: the point on it
    hemisphere = 4,   ///< numbers 0 and 1: direction from a diffuse lobe
    environment = 5,  ///< numbers 0 and 1: direction to the background; all four: to the environment picture
    light = 6,        ///< all four: the light that gets the shadow ray (light_reservoir.h); always random
    microfacets = 7,  ///< numbers 0 and 1: direction from a glossy lobe
    light_order = 8,  ///< number 0: the first choice between lights, for samplers other than random
};

/// The place in a block of the first pair's first number; the second pair follows it, cyclically.
TANDEM_HD_INLINE constexpr int first_of_pairs(Dimension dimension) {
    return dimension == Dimension::area_light ? 1 : 0;
}

/// Whether only the first pair is used. Samplers other than random leave the other numbers 0.
TANDEM_HD_INLINE constexpr bool has_one_pair(Dimension dimension) {
    return dimension == Dimension::film || dimension == Dimension::lens || dimension == Dimension::light_order;
}

namespace sampler_detail {

template <class Word>
TANDEM_HD_CALL_ON(device)
PhiloxBlock<Word> philox_by_call(PhiloxBlock<Word> counter, std::uint32_t key0, std::uint32_t key1) {
    return philox4x32<Word>(counter, key0, key1);
}

/// Four numbers of a sample. `pixel`: on a Morton curve for sobol_blue. `use`: dimension and vertex.
template <class Word>
TANDEM_HD_INLINE PhiloxBlock<Word> sobol_block(JobSampler sampler, const Word& pixel, const Word& sample,
                                               const Word& use, Dimension dimension) {
    const bool among_pixels = sampler_of(sampler) == Sampler::sobol_blue;
    const Word key(sampler.key);
    const Word base = among_pixels ? key : hashed(pixel ^ key);
    const Word first = base + use * Word(8U * hash_step);
    const auto seed = [&](std::uint32_t number) __attribute__((always_inline)) {
        return hashed(first + Word(number * hash_step));
    };
    const Word number = reversed_bits(sample);
    const auto pair = [&](std::uint32_t from) __attribute__((always_inline)) {
        SobolSeeds<Word> seeds = {seed(from), seed(from + 1), seed(from + 2), Word(0U)};
        if (!among_pixels) return sobol_pair(number, seeds);
        seeds.of_tile = seed(from + 3);
        return sobol_pair_among_pixels(number, reversed_bits(pixel), seeds);
    };
    const SobolPair<Word> a = pair(0);
    if (has_one_pair(dimension)) return {{a.u, a.v, Word(0U), Word(0U)}};
    const SobolPair<Word> b = pair(4);
    if (first_of_pairs(dimension) == 1) return {{b.v, a.u, a.v, b.u}};
    return {{a.u, a.v, b.u, b.v}};
}
/// The same for kernels that are linked for the sampler, and then for all others: out of line, so that these are
/// compiled as if they had only random.
template <class Word>
TANDEM_HD_CALL_ON(device)
PhiloxBlock<Word> sobol_by_call(JobSampler sampler, Word pixel, Word sample, Word use, Dimension dimension) {
    return sobol_block(sampler, pixel, sample, use, dimension);
}
template <class Word>
TANDEM_HD_CALL PhiloxBlock<Word> sobol_aside(JobSampler sampler, Word pixel, Word sample, Word use,
                                             Dimension dimension) {
    return sobol_block(sampler, pixel, sample, use, dimension);
}

}  // namespace sampler_detail

/// A sample of a pixel, for each lane of `Real`. Its random numbers depend on nothing else.
template <class Real>
struct SampleId {
    const PhiloxKeys* keys;  ///< of the seed
    std::uint32_t frame;
    UInt<Real> pixel;  ///< PixelJob::number_of()
    UInt<Real> sample;
    JobSampler sampler{};

    [[nodiscard]] TANDEM_HD_INLINE bool is_random() const { return sampler_of(sampler) == Sampler::random; }

    /// The four numbers of a dimension at a vertex (0: where the camera ray hits), as uniform bits.
    TANDEM_HD_INLINE PhiloxBlock<UInt<Real>> block(Dimension dimension,
                                                   const UInt<Real>& vertex = UInt<Real>(0U)) const {
        if (!is_random()) [[unlikely]]
            return sobol_block(dimension, vertex);
        return random_block(dimension, vertex);
    }
    /// The same, but out of line on the device, for numbers that a path needs at every vertex.
    TANDEM_HD_INLINE PhiloxBlock<UInt<Real>> block_at_vertex(Dimension dimension, const UInt<Real>& vertex) const {
        if (!is_random()) [[unlikely]]
            return sobol_block(dimension, vertex);
        return random_block_at_vertex(dimension, vertex);
    }

    /// The numbers of the sampler random, whatever the job's. The counter is (pixel, sample, dimension and vertex,
    /// frame) and the key is the seed, so each combination has its own numbers without any state.
    TANDEM_HD_INLINE PhiloxBlock<UInt<Real>> random_block(Dimension dimension, const UInt<Real>& vertex) const {
        return philox4x32(counter(dimension, vertex), *keys);
    }
    TANDEM_HD_INLINE PhiloxBlock<UInt<Real>> random_block_at_vertex(Dimension dimension,
                                                                    const UInt<Real>& vertex) const {
        return sampler_detail::philox_by_call<UInt<Real>>(counter(dimension, vertex), keys->of_round[0][0],
                                                          keys->of_round[0][1]);
    }

  private:
    using Word = UInt<Real>;

    TANDEM_HD_INLINE static Word use_of(Dimension dimension, const Word& vertex) {
        return (vertex << 8) | Word(static_cast<std::uint32_t>(dimension));
    }
    TANDEM_HD_INLINE PhiloxBlock<Word> counter(Dimension dimension, const Word& vertex) const {
        return {{pixel, sample, use_of(dimension, vertex), Word(frame)}};
    }
    TANDEM_HD_INLINE PhiloxBlock<Word> sobol_block(Dimension dimension, const Word& vertex) const {
        const Word use = use_of(dimension, vertex);
        if (is_sampler_linked()) return sampler_detail::sobol_by_call<Word>(sampler, pixel, sample, use, dimension);
        return sampler_detail::sobol_aside<Word>(sampler, pixel, sample, use, dimension);
    }
};

}  // namespace tandem
