/// Motion blur: a frame is the mean of what the camera sees at several instants of its shutter's interval. Each instant
/// is a scene of its own, prepared, loaded and rendered, and the films are added. So whatever moves is blurred, the
/// camera too, by every backend and tier to the bit alike, and kernels know nothing of it.
/// P. Haeberli, K. Akeley, "The Accumulation Buffer: Hardware Support for High-Quality Rendering", SIGGRAPH 1990.
#pragma once

#include <string>
#include <vector>

#include "tandem/compile/prepare.h"
#include "tandem/render/backend.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// What is rendered of a frame at one moment.
struct FrameInstant {
    PrepareOptions prepare;
    RenderJob job;  ///< the instant's samples, by their numbers in the frame
};

struct FramePlan {
    std::vector<FrameInstant> instants;  ///< in the order of time and of samples
    EffectMask effects;                  ///< host_effects that are simulated, or were forced on
};

/// Does the frame have motion blur? Then its instants have times of their own, one at least.
[[nodiscard]] inline bool is_blurred(const FramePlan& plan) { return plan.instants.front().prepare.time.has_value(); }

/// The frame `options.frame`. Where nothing moves while the shutter is open, where it does not open, and with
/// motion_blur forced off, that is one instant, at the time of the frame: `options` and `job` as they are.
///
/// Else there are as many instants as the shutter says, but no more than samples. They share the samples, as equally as
/// these can be divided: the first ones go to the first instant. Each sample stands for an equal part of the interval,
/// and an instant is in the middle of the parts of its samples; where they are shared equally, in the middle of an
/// equal part. A time that is set in `options` is such an instant already. Throws InputError for a scene, camera or job
/// that cannot be.
[[nodiscard]] FramePlan plan_frame(const Scene& scene, const PrepareOptions& options, const RenderJob& job);

/// SHA-256, in hexadecimal, over what makes the picture: scene_hash() for a frame without blur, else over those of all
/// its instants and how many samples each has.
class FrameHash {
  public:
    explicit FrameHash(const FramePlan& plan) : plan_(plan) {}
    /// In the order of the instants.
    void add(const PreparedScene& instant) { hashes_.push_back(scene_hash(instant)); }
    /// After all instants have been added.
    [[nodiscard]] std::string get() const;

  private:
    const FramePlan& plan_;
    std::vector<std::string> hashes_;
};

/// The hash, by preparing every instant.
[[nodiscard]] std::string frame_hash(const Scene& scene, const FramePlan& plan);

struct RenderedFrame {
    /// Times, rays and most counters are sums over the instants; effects are those of any, and the plan's; the variants
    /// are named once each.
    RenderResult result;
    PhaseTimes load;     ///< what the loads cost together
    double prepare = 0;  ///< seconds of all preparations, and their hashes; they may overlap with rendering
};

/// Renders a frame. Two instants are with the backend at a time; their films are added in double, in the order of time.
/// A frame without blur has the bits that Backend::render() gives it. `hash`: if there is one, the instants are added.
[[nodiscard]] RenderedFrame render_frame(Backend& backend, const Scene& scene, const FramePlan& plan,
                                         FrameHash* hash = nullptr);

/// The same for what plan_frame() makes of the options.
[[nodiscard]] RenderedFrame render_frame(Backend& backend, const Scene& scene, const PrepareOptions& options,
                                         const RenderJob& job);

}  // namespace tandem
