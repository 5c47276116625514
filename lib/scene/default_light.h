/// Light for scenes that have none.
#pragma once

#include "tandem/scene/scene.h"

namespace tandem {

/// Does light of its own make the scene visible? A lamp that shines does, and so do surfaces that glow, if their mean
/// radiance over all surfaces is above 0.05: eyes and dials that glow leave the rest dark. As it is at frame 0.
[[nodiscard]] bool has_light(const Scene& scene);

/// Adds an even grey-blue sky, which lights surfaces, and a directional light at a new node "key light" that casts
/// shadows. It comes from the upper left of the camera, which stands still at its place in frame 0. A white matt
/// surface is then up to 0.85 bright where it faces the light. `camera`: index of its node. The scene must be valid.
void add_default_light(Scene& scene, std::size_t camera);

}  // namespace tandem
