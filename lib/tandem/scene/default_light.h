/// Light for scenes that have none.
#pragma once

#include "tandem/scene/scene.h"

namespace tandem {

/// Does the scene have light of its own, or no surface that needs any (KHR_materials_unlit)? One punctual light with an
/// intensity is enough. Emissive surfaces are if their mean radiance over all surfaces at frame 0 is above 0.2, which
/// lights a closed room: emissive eyes, dials and labels leave the rest dark.
[[nodiscard]] bool has_light(const Scene& scene);

/// Adds an even grey-blue sky, which lights surfaces, and a directional light at a new node "key light" that casts
/// shadows. It comes from the upper left of the camera, as it is in frame 0. A diffuse surface of albedo 0.8 is then up
/// to 0.87 bright where it faces the light, and about 0.2 in its shadow.
///
/// `camera`: index of its node. The scene must be valid.
void add_default_light(Scene& scene, std::size_t camera);

}  // namespace tandem
