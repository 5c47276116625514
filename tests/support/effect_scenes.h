/// Scenes that need effects, small enough for the oracle.
#pragma once

#include <string>
#include <vector>

#include "tandem/effects/effects.h"
#include "tandem/scene/scene.h"

namespace tandem::test {

struct EffectScene {
    std::string name;
    Scene scene;
    EffectMask effects;  ///< that it needs
};

/// Each effect alone, and combinations; without those of the host (host_effects).
[[nodiscard]] const std::vector<EffectScene>& effect_scenes();

}  // namespace tandem::test
