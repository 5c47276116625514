/// Cameras for scenes that have none, and for other views of a scene.
#pragma once

#include <string>

#include "tandem/scene/scene.h"

namespace tandem {

/// "auto, front, back, left, right, top, bottom, three-quarter". The front of a scene faces +z, as in glTF; left and
/// right are those of a viewer in front of it.
[[nodiscard]] std::string view_names();

[[nodiscard]] bool is_view(const std::string& name);

/// A camera that shows a whole scene.
struct Framing {
    Node node;                ///< of the camera; its name is that of the view
    std::string description;  ///< "from the front, 15 degrees above"
    bool is_empty = false;    ///< there is no surface to show: the camera frames a cube of 1 m at the origin
};

/// Stands where all surfaces of the scene, as they are at frame 0, just fit into a film whose width is `aspect` times
/// its height, with a margin of a twentieth on every side that they reach. The vertical angle is 40 degrees. Where
/// frame 0 shows nothing, the middle of the animation counts, or its end.
///
/// Views from the sides stand a little above, and the higher the flatter the scene is, so that a floor is seen. "auto"
/// is the front, rotated to the right if the scene is much deeper than wide. Any bounds are framed: points, planes,
/// tiny and huge ones, far from the origin, but for those whose coordinates pass 1e17.
///
/// `view`: one of view_names(). The scene must be valid. Throws InputError for an unknown view, and for an aspect that
/// is not above 0 and finite.
[[nodiscard]] Framing frame_scene(const Scene& scene, const std::string& view, double aspect);

}  // namespace tandem
