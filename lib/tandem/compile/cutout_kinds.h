/// Which kinds of primitives have holes.
#pragma once

#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// PrimitiveKinds of the primitives whose material is cut out by its alpha.
[[nodiscard]] std::uint32_t kinds_cut_out_by_alpha(const SceneView& scene);

}  // namespace tandem
