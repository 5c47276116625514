/// Validation of the author's textures.
#pragma once

#include <string>
#include <vector>

#include "tandem/scene/scene.h"

namespace tandem {

/// What is wrong with images, textures and their uses, one sentence each; for validate().
[[nodiscard]] std::vector<std::string> find_texture_problems(const Scene& scene);

}  // namespace tandem
