/// How many faces the nodes of a file show.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tandem/gltf/buffers.h"

namespace tandem::gltf {

/// Refuses a file whose nodes and instances repeat its meshes into faces that would take more than 380 MB of memory, or
/// 190 bytes for each byte of its data. A face takes 235 bytes and what its corners carry, whichever the mesh that it
/// repeats; what has no faces, as a sphere or lines, counts as four. Copies nothing. `node_of`: by node of the file,
/// nothing if the scene does not have it. Throws InputError.
void check_face_count(const Source& source, const std::vector<std::optional<std::uint32_t>>& node_of);

}  // namespace tandem::gltf
