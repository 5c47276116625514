/// What every lobe gives, as bits, for packets and for one ray. This interface is all that the files compiled for an
/// instruction set share with others: what else they use is in lobe_lanes_body.h, in an unnamed namespace or inlined by
/// force.
#pragma once

#include <cstdint>

namespace tandem::test {

/// What lobes are made of and asked with.
struct LobeInput {
    double wo[3], wi[3], u[3];
    double colour[3], roughness[2], eta;
};

/// f, pdf and albedo, then the sample: wi, pdf, weight, valid and transmits.
inline constexpr int numbers_of_a_lobe = 16;
inline constexpr int lobe_count = 0
#define TANDEM_LOBE(type, ...) +1
#include "tandem/kernel/bsdf/lobes.def"
    ;
struct LobeBits {
    std::uint64_t number[lobe_count][numbers_of_a_lobe];
};

/// Reads one input and writes one result a lane.
struct LobeRunner {
    int lanes;
    void (*run)(const LobeInput* in, LobeBits* out);
};

struct LobeRunners {
    LobeRunner strict, precise;
};
LobeRunners lobe_runners_v2();
LobeRunners lobe_runners_v3();
LobeRunners lobe_runners_v4();

}  // namespace tandem::test
