/// Reads materials.
#pragma once

#include <vector>

#include "tandem/gltf/buffers.h"
#include "tandem/gltf/document.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// One material per material of the file, in its order. TANDEM_materials_phong is used as it is; any other material is
/// metallic-roughness, or a dielectric whose other terms are approximated from its base colour.
[[nodiscard]] std::vector<Material> read_materials(const Source& source, ImportReport& report);

/// The default material of primitives that name none: white as in glTF, but diffuse instead of a rough metal.
[[nodiscard]] Material default_material();

/// The three numbers of a member, or `absent`.
[[nodiscard]] Vec3f read_colour(const Json& object, const char* member, const Vec3f& absent);

}  // namespace tandem::gltf
