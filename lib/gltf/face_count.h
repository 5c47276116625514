/// How many faces the nodes of a file show.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tandem/gltf/buffers.h"

namespace tandem::gltf {

/// Refuses a file whose nodes and instances repeat its meshes into more than a million faces, or more than one for
/// every two bytes of its data. A face takes some 350 bytes of memory, whichever the mesh that it repeats. What has no
/// faces, as a sphere or lines, counts as four. Copies nothing. `node_of`: by node of the file, nothing if the scene
/// does not have it. Throws InputError.
void check_face_count(const Source& source, const std::vector<std::optional<std::uint32_t>>& node_of);

}  // namespace tandem::gltf
