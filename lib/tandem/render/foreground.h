/// Which pixels of a film show something, and which the background.
#pragma once

#include "tandem/compile/prepared_scene.h"
#include "tandem/images/image.h"
#include "tandem/kernel/camera/camera.h"
#include "tandem/kernel/lights/environment.h"

namespace tandem {

/// What a camera sees where the scene has nothing. Small, and independent of the scene that it is made from.
class Backdrop {
  public:
    /// For films of width x height pixels.
    Backdrop(const PreparedScene& scene, int width, int height);

    /// The means of a film of that size, and black where they are those of the background: in every channel between
    /// what it has at the corners of the pixel, but for a hundredth, which is for lenses. A picture of the environment
    /// is part of what is shown.
    [[nodiscard]] FloatImage foreground(const Film& film) const;

  private:
    CameraView camera_;
    Environment environment_;
    bool is_picture_;
};

}  // namespace tandem
