/// Frames that survive an interruption.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "tandem/images/image_metadata.h"
#include "tandem/render/adaptive_frame.h"
#include "tandem/render/motion_blur.h"

namespace tandem {

struct CheckpointOptions {
    std::string file{};
    double every = 60;    ///< seconds from one checkpoint to the next
    bool resume = false;  ///< go on from the file, if it exists
};

/// Throws InputError if checkpoints cannot be written there, or if there is a file already but not `resume`.
void check_output(const CheckpointOptions& options);

/// Renders a frame in tiles (render_tiles()) and writes checkpoints meanwhile. `frame`: describe() of its job and its
/// scene. Once `interrupted` is set, it writes a last checkpoint and returns nothing. The film has the bits of
/// render_frame(), whenever and wherever parts of it were rendered. The file of the checkpoint stays: remove it when
/// the image is written.
///
/// Throws InputError if the checkpoint is of another scene, job or version (the message says what differs), or is
/// damaged.
[[nodiscard]] std::optional<RenderedFrame> render_with_checkpoints(Backend& backend, const Scene& scene,
                                                                   const FramePlan& plan, const ImageMetadata& frame,
                                                                   const CheckpointOptions& options,
                                                                   const std::atomic<bool>& interrupted);

/// The same for render_to_target(). The film is that of a render without an interruption, unless the time limit ends
/// the render; the time limit counts all runs together. The target's error must be that of the checkpoint; its time
/// limit may differ.
[[nodiscard]] std::optional<TargetFrame> render_to_target_with_checkpoints(
    Backend& backend, const Scene& scene, const FramePlan& plan, const RenderTarget& target, ImageMetadata frame,
    const CheckpointOptions& options, const std::atomic<bool>& interrupted, const std::function<double()>& clock);

}  // namespace tandem
