/// Validates authored textures.
#pragma once

#include <string>
#include <vector>

#include "tandem/scene/scene.h"

namespace tandem {

/// The problems of images, textures and their uses, one sentence each; for validate().
[[nodiscard]] std::vector<std::string> find_texture_problems(const Scene& scene);

}  // namespace tandem
