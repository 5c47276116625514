/// Limits the number of faces that the nodes of a file show.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tandem/gltf/buffers.h"

namespace tandem::gltf {

/// Refuses a file whose nodes and instances repeat its meshes so often that the faces would take more than 380 MB of
/// memory, or more than 190 bytes for each byte of its data. A face takes 235 bytes plus the values at its corners; a
/// primitive without faces, such as a sphere or lines, counts as four faces. Copies nothing. `node_of`: the number in
/// the scene of each node of the file, if the scene has it. Throws InputError.
void check_face_count(const Source& source, const std::vector<std::optional<std::uint32_t>>& node_of);

}  // namespace tandem::gltf
