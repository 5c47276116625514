/// The cameras of a scene: selection by name, and orientation.
#pragma once

#include <optional>
#include <string>

#include "tandem/scene/scene.h"

namespace tandem {

/// The node of the camera of that name; of the first one if the name is empty. Nothing if there is none.
[[nodiscard]] std::optional<std::size_t> find_camera(const Scene& scene, const std::string& name);

/// The same. Throws InputError that names the cameras if there is none.
[[nodiscard]] std::size_t camera_node(const Scene& scene, const std::string& name);

/// The names of all cameras, "'eye', 'other'"; "none" if there are none.
[[nodiscard]] std::string camera_names(const Scene& scene);

/// Right, up and backward of a camera under that transform: orthogonal unit vectors, in the rows. It looks
/// along its node; scale does not change what it sees (glTF 2.0, 3.10). Nothing if the transform is not
/// invertible.
[[nodiscard]] std::optional<Matrix3> camera_axes(const Transform& world_from_node);

}  // namespace tandem
