/// The cameras of a scene: selection by name, and orientation.
#pragma once

#include <optional>
#include <string>

#include "tandem/scene/scene.h"

namespace tandem {

/// The node of the camera with that name, or of the first one if the name is empty; empty if there is none.
[[nodiscard]] std::optional<std::size_t> find_camera(const Scene& scene, const std::string& name);

/// The same, but throws InputError that lists the cameras if there is none.
[[nodiscard]] std::size_t camera_node(const Scene& scene, const std::string& name);

/// The names of all cameras, "'eye', 'other'"; "none" if there are none.
[[nodiscard]] std::string camera_names(const Scene& scene);

/// The right, up and backward axes of a camera under that transform: orthogonal unit vectors, in the rows. The camera
/// looks along -z of its node; scale does not change what it sees (glTF 2.0, 3.10). Empty if the transform is not
/// invertible.
[[nodiscard]] std::optional<Matrix3> camera_axes(const Transform& world_from_node);

}  // namespace tandem
