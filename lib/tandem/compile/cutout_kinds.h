/// The kinds of primitives that have alpha masks.
#pragma once

#include "tandem/compile/prepared_scene.h"

namespace tandem {

/// PrimitiveKinds of the primitives whose material has an alpha mask; faces of instanced meshes are triangles.
[[nodiscard]] std::uint32_t kinds_cut_out_by_alpha(const PreparedScene& scene);

}  // namespace tandem
