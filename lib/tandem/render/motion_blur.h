/// Motion blur: a frame is the mean over several instants of the shutter interval. Each instant is prepared, loaded and
/// rendered as a scene of its own, and the films are added. So everything that moves is blurred, the camera too, with
/// the same bits from every exact backend, and kernels need no support for it. Source: P. Haeberli, K. Akeley, "The
/// Accumulation Buffer: Hardware Support for High-Quality Rendering", SIGGRAPH 1990.
#pragma once

#include <string>
#include <vector>

#include "tandem/compile/prepare.h"
#include "tandem/render/backend.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// One instant of a frame.
struct FrameInstant {
    PrepareOptions prepare;
    RenderJob job;  ///< the instant's samples, by their numbers in the frame
};

struct FramePlan {
    std::vector<FrameInstant> instants;  ///< in the order of time and of samples
    EffectMask effects;                  ///< host_effects that are simulated, or forced on
};

/// Whether the frame has motion blur. Then each of its instants has a time of its own.
[[nodiscard]] inline bool is_blurred(const FramePlan& plan) { return plan.instants.front().prepare.time.has_value(); }

/// Plans the frame `options.frame`. If nothing moves while the shutter is open, if the shutter does not open, or if
/// motion_blur is forced off, the frame is one instant, at its own time, with `options` and `job` as they are.
///
/// Otherwise it has as many instants as the shutter specifies, but no more than samples. The samples are distributed as
/// evenly as possible, the first ones to the first instant. Each sample stands for an equal part of the interval, and
/// an instant is in the middle of the parts of its samples. A time that is set in `options` is already such an instant.
/// Throws InputError for an invalid scene, camera or job.
[[nodiscard]] FramePlan plan_frame(const Scene& scene, const PrepareOptions& options, const RenderJob& job);

/// SHA-256, in hexadecimal, of what determines the image: scene_hash() for a frame without blur, else the hash of those
/// of all its instants and their numbers of samples.
class FrameHash {
  public:
    explicit FrameHash(const FramePlan& plan) : plan_(plan) {}
    /// Adds an instant; call it in the order of the instants.
    void add(const PreparedScene& instant);
    /// The hash, after all instants have been added.
    [[nodiscard]] std::string get() const;

  private:
    const FramePlan& plan_;
    std::vector<std::string> hashes_;
};

/// The hash, by preparing every instant.
[[nodiscard]] std::string frame_hash(const Scene& scene, const FramePlan& plan);

struct RenderedFrame {
    /// Times, rays and most counters are sums over the instants; effects are those of any instant and of the plan; each
    /// variant is named once.
    RenderResult result;
    PhaseTimes load;     ///< sums over all loads
    double prepare = 0;  ///< seconds of all preparations and hashes; they may overlap with rendering
};

/// Renders a frame. The backend renders two instants at a time; their films are added in double, in the order of time.
/// A frame without blur has the bits of Backend::render(). The instants are added to `hash` unless it is null.
[[nodiscard]] RenderedFrame render_frame(Backend& backend, const Scene& scene, const FramePlan& plan,
                                         FrameHash* hash = nullptr);

/// Plans and renders a frame.
[[nodiscard]] RenderedFrame render_frame(Backend& backend, const Scene& scene, const PrepareOptions& options,
                                         const RenderJob& job);

}  // namespace tandem
