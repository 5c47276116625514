/// Reads mirrors, dielectrics and emission: TANDEM_materials_phong.mirror, KHR_materials_transmission, _ior, _volume,
/// TANDEM_materials_dielectric, emissiveFactor and KHR_materials_emissive_strength.
#pragma once

#include "tandem/gltf/document.h"
#include "tandem/gltf/report.h"
#include "tandem/kernel/bsdf/optics.h"

namespace tandem::gltf {

/// `material`: its JSON object; `path`: the path of that object.
[[nodiscard]] Optics read_optics(const Json& material, const std::string& path, ImportReport& report);

}  // namespace tandem::gltf
