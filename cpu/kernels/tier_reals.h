/// The arithmetic of a tier.
#pragma once

#include "tandem/math/fast_math.h"
#include "tandem/math/lanes.h"
#include "tandem/render/tier.h"

namespace tandem {

/// For one ray and for a packet.
template <class Isa, Tier tier>
struct TierReals;
template <class Isa>
struct TierReals<Isa, Tier::strict> {
    using One = float;
    using Packet = Lanes<float, Isa>;
};
template <class Isa>
struct TierReals<Isa, Tier::precise> {
    using One = double;
    using Packet = Lanes<double, Isa>;
};
template <class Isa>
struct TierReals<Isa, Tier::fast> {
    using One = FastFloat;
    using Packet = Lanes<float, Fast<Isa>>;
};

}  // namespace tandem
