/// Which effects a scene needs, and why.
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

/// Effects that are not simulated by kernels but around them, on the host: kernels neither have code for them nor carry
/// it. PreparedScene::effects is without them.
inline constexpr EffectMask host_effects = Effect::motion_blur;

/// In the order of effects.def. A pure function of the scene and what prepare() made of it; what no ray can hit, such
/// as a material without a primitive, and a light without intensity need nothing.
[[nodiscard]] std::vector<EffectNeed> derive_effects(const Scene& scene, const PreparedScene& prepared);

[[nodiscard]] EffectMask mask_of(const std::vector<EffectNeed>& needs);

/// The scene, and the settings, without what needs these effects: lights cast no shadows, mirrors and dielectrics are
/// gone, and so on. This is how an effect is forced off: the kernels then have nothing to leave out.
[[nodiscard]] Scene without_effects(Scene scene, EffectMask off);
[[nodiscard]] RenderSettings without_effects(RenderSettings settings, EffectMask off);

}  // namespace tandem
