/// Derives which effects a scene needs, and why.
#pragma once

#include <string>
#include <vector>

#include "tandem/compile/prepared_scene.h"
#include "tandem/compile/render_settings.h"
#include "tandem/effects/effects.h"
#include "tandem/scene/scene.h"

namespace tandem {

struct EffectNeed {
    Effect effect;
    std::string reason;  ///< a clause that names the material, light or camera: "material 'glass' has transmission 1"
};

/// Effects that the host simulates, not the kernels. PreparedScene::effects does not contain them.
inline constexpr EffectMask host_effects = Effect::motion_blur;

/// In the order of effects.def. A pure function of the scene and its prepared form. What cannot change the image, such
/// as a material without a primitive or a light without intensity, needs nothing.
[[nodiscard]] std::vector<EffectNeed> derive_effects(const Scene& scene, const PreparedScene& prepared);

[[nodiscard]] EffectMask mask_of(const std::vector<EffectNeed>& needs);

/// Removes what needs these effects from the scene and the settings: lights cast no shadows, mirrors and dielectrics
/// disappear, and so on. This is how an effect is forced off, so kernels need no switch for it.
[[nodiscard]] Scene without_effects(Scene scene, EffectMask off);
[[nodiscard]] RenderSettings without_effects(RenderSettings settings, EffectMask off);

}  // namespace tandem
