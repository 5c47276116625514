/// Poses skinned meshes at rest.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tandem/gltf/buffers.h"
#include "tandem/gltf/geometry.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// Poses the meshes of nodes with a skin, and moves them to root nodes of their own: a skinned mesh follows its joints,
/// not its node (glTF 2.0, 3.7.3.3). The pose comes from the nodes' own transforms; animation does not change it. A
/// skin that cannot be used is noted, and its mesh stays at its node. `node_of`: the number in the scene of each node
/// of the file. `geometry`: the reader that made the meshes.
void pose_skins(const Source& source, const std::vector<std::optional<std::uint32_t>>& node_of,
                const GeometryReader& geometry, Scene& scene, ImportReport& report, FlawLog& flaws);

}  // namespace tandem::gltf
