/// The kinds of primitives that have alpha masks.
#pragma once

#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// PrimitiveKinds of the primitives whose material has an alpha mask.
[[nodiscard]] std::uint32_t kinds_cut_out_by_alpha(const SceneView& scene);

}  // namespace tandem
