/// Tells the foreground of a film from the background.
#pragma once

#include "tandem/compile/prepared_scene.h"
#include "tandem/images/image.h"
#include "tandem/kernel/camera/camera.h"
#include "tandem/kernel/lights/environment.h"
#include "tandem/kernel/sampler/pixel_filter.h"

namespace tandem {

/// The background that a camera sees. Small, and independent of the scene that it is made from.
class Backdrop {
  public:
    /// For films of width x height pixels with a filter.
    Backdrop(const PreparedScene& scene, int width, int height, PixelFilter filter = PixelFilter::box);

    /// The means of a film of that size, with background pixels black: those whose channels are all between the values
    /// of the background at the corners of the filter, with a tolerance of a hundredth for lenses. An environment
    /// picture counts as foreground.
    [[nodiscard]] FloatImage foreground(const Film& film) const;

  private:
    CameraView camera_;
    Environment environment_;
    float reach_;
    bool is_gradient_;
};

}  // namespace tandem
