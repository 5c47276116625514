/// Skinned meshes, where their joints put them at rest.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tandem/gltf/buffers.h"
#include "tandem/gltf/geometry.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// Poses the meshes of nodes that have a skin, and moves them to root nodes of their own: a skinned mesh follows its
/// joints, and not its node (glTF 2.0, 3.7.3.3). The pose is that of the nodes' own transforms; animation does not move
/// it. A skin that cannot be used is noted, and its mesh stays at its node. `node_of`: from node of the file to node of
/// the scene. `geometry`: the reader that made the meshes.
void pose_skins(const Source& source, const std::vector<std::optional<std::uint32_t>>& node_of,
                const GeometryReader& geometry, Scene& scene, ImportReport& report, FlawLog& flaws);

}  // namespace tandem::gltf
