/// Materials.
#pragma once

#include <vector>

#include "tandem/gltf/buffers.h"
#include "tandem/gltf/document.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// One material per material of the file, in its order. TANDEM_materials_phong as it stands; any other is
/// metallic-roughness, or glass whose other terms are approximated from its base colour.
[[nodiscard]] std::vector<Material> read_materials(const Source& source, ImportReport& report);

/// What glTF gives to primitives that name no material, but matt and not a rough metal: white.
[[nodiscard]] Material default_material();

/// Three numbers of a member, or `absent`.
[[nodiscard]] Vec3f read_colour(const Json& object, const char* member, const Vec3f& absent);

}  // namespace tandem::gltf
