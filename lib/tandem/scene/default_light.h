/// Default lights for scenes without light.
#pragma once

#include "tandem/scene/scene.h"

namespace tandem {

/// Whether the scene has light of its own, or no surface that needs any (KHR_materials_unlit). One punctual light of
/// nonzero intensity is enough. Emissive surfaces are enough if the mean radiance over all surfaces at frame 0 is above
/// 0.2, which lights a closed room: emissive eyes, dials and labels leave the rest dark.
[[nodiscard]] bool has_light(const Scene& scene);

/// Adds a grey-blue background, which lights surfaces, and directional lights at new nodes: a "key light" that casts
/// shadows, from the upper left of the camera as it is in frame 0, and a "fill light" from the camera.
/// docs/scene-format.md, "Files without light", has the values.
///
/// `camera`: index of its node. The scene must be valid.
void add_default_light(Scene& scene, std::size_t camera);

}  // namespace tandem
