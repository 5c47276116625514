#include "tandem/scene/environment_image.h"

#include <utility>

#include "tandem/scene/scene.h"

namespace tandem {

void light_by(Scene& scene, EnvironmentImage image) {
    scene.environment_image = std::move(image);
    scene.environment.illuminates = 1;
    scene.environment.ambient = {0, 0, 0};
}

}  // namespace tandem
