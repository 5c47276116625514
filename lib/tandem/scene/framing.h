/// Cameras for scenes without one, and for other views of a scene.
#pragma once

#include <string>

#include "tandem/scene/scene.h"

namespace tandem {

/// "auto, front, back, left, right, top, bottom, three-quarter". The front of a scene faces +z, as in glTF; left and
/// right are those of a viewer in front of the scene.
[[nodiscard]] std::string view_names();

[[nodiscard]] bool is_view(const std::string& name);

/// A camera that shows a whole scene.
struct Framing {
    Node node;                ///< the node of the camera; its name is that of the view
    std::string description;  ///< "from the front, 15 degrees above"
    bool is_empty = false;    ///< there is no surface to show: the camera frames a cube of 1 m at the origin
};

/// A camera from which all surfaces of the scene at frame 0 just fit into a film whose width is `aspect` times its
/// height, with a margin of a twentieth. The vertical field of view is 40 degrees. If frame 0 shows no surface, the
/// middle of the animation is used, or else its end.
///
/// Views from the sides look down a little, and more so the flatter the scene is, so that its floor is visible. "auto"
/// is the front, rotated to the right if the scene is much deeper than wide. Any bounds can be framed: points, planes,
/// tiny and huge ones, far from the origin, unless coordinates exceed 1e17.
///
/// `view`: one of view_names(). The scene must be valid. Throws InputError for an unknown view, and for an aspect that
/// is not above 0 and finite.
[[nodiscard]] Framing frame_scene(const Scene& scene, const std::string& view, double aspect);

}  // namespace tandem
