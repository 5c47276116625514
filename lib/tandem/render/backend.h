/// The interface of all renderers: CPU, CUDA, oracle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tandem/film/film.h"
#include "tandem/images/display.h"
#include "tandem/images/image.h"
#include "tandem/render/gpu_choice.h"
#include "tandem/render/render_job.h"
#include "tandem/render/specialise.h"
#include "tandem/render/stats.h"
#include "tandem/render/tier.h"
#include "tandem/render/trace_job.h"

namespace tandem {

struct PreparedScene;

/// The work that a member of a combined backend has done so far (combined_backend.h).
struct MemberWork {
    std::string name;           ///< "GPU 1"
    std::string device;         ///< its own Capabilities::device
    std::uint64_t samples = 0;  ///< pixel samples
    std::uint64_t rays = 0;     ///< of trace()
    std::string failure{};      ///< why it was left out; empty if it works
};

struct Capabilities {
    std::string device;                 ///< the name of the processor
    std::string description;            ///< versions of libraries and drivers, for reports
    bool exact = true;                  ///< guarantees the bits of the tier strict
    std::vector<MemberWork> members{};  ///< of a combined backend
};

/// A scene in the memory of a backend, loaded for one tier. It belongs to the backend that loaded it and must not
/// outlive it.
class ResidentScene {
  public:
    explicit ResidentScene(Tier tier) : tier_(tier) {}
    virtual ~ResidentScene() = default;
    [[nodiscard]] Tier tier() const { return tier_; }
    /// The time that load() took.
    [[nodiscard]] virtual PhaseTimes load_times() const = 0;

  private:
    Tier tier_;
};

struct RenderResult {
    Film film;
    RenderStats stats;
};

/// A frame that is being rendered.
class PendingFrame {
  public:
    virtual ~PendingFrame() = default;
    /// Waits for the film. Call once.
    [[nodiscard]] virtual RenderResult get() = 0;
};

/// A frame in 8-bit levels: the result of tone_map() for its film.
struct ImageResult {
    ByteImageView image;
    std::shared_ptr<const void> memory;  ///< of the values; it returns to the backend when the last pointer is released
    std::size_t nan_values = 0;          ///< how many values were NaN and became 0
    RenderStats stats;
};

/// A frame in levels that is being rendered.
class PendingImage {
  public:
    virtual ~PendingImage() = default;
    /// Waits for the image. Call once.
    [[nodiscard]] virtual ImageResult get() = 0;
};

/// Throws InputError if a job for submit_image() has planes.
void check_image(const RenderJob& job);

class Backend {
  public:
    virtual ~Backend() = default;

    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual Capabilities capabilities() const = 0;

    /// Loads the scene into the backend's memory. Buffers of released scenes are reused. Throws EnvironmentError,
    /// before it builds anything, if the memory cannot hold the scene.
    [[nodiscard]] virtual std::shared_ptr<ResidentScene> load(const PreparedScene& scene, Tier tier = Tier::strict) = 0;

    /// The same. A backend that reads scenes in the host's memory keeps this one instead of a copy.
    [[nodiscard]] virtual std::shared_ptr<ResidentScene> load_shared(const std::shared_ptr<const PreparedScene>& scene,
                                                                     Tier tier = Tier::strict) {
        return load(*scene, tier);
    }

    /// Finds the nearest hits of rays in front of their origins (t > 0), or whether shadow rays are blocked
    /// (trace_job.h). Rays are in render space; render_from_world() (compile/prepare.h) converts points. Rays
    /// that are not traceable (math/ray.h) miss and are counted. Returns the seconds that tracing took, without copies.
    virtual double trace(ResidentScene& scene, const TraceJob& job) = 0;
    double trace(ResidentScene& scene, std::span<const Ray<float>> rays, std::span<Hit> hits) {
        return trace(scene, TraceJob{.rays = rays, .hits = hits});
    }

    /// Starts a frame. A backend may render several at a time; call get() of each in any order.
    [[nodiscard]] virtual std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                               const RenderJob& job) = 0;

    /// Starts a frame of which only the levels are needed. A GPU computes them itself, and the film stays in its
    /// memory. Throws InputError if the job has planes. By default tone_map() takes the film of submit().
    [[nodiscard]] virtual std::unique_ptr<PendingImage> submit_image(std::shared_ptr<ResidentScene> scene,
                                                                     const RenderJob& job, const Display& display);

    [[nodiscard]] RenderResult render(std::shared_ptr<ResidentScene> scene, const RenderJob& job) {
        return submit(std::move(scene), job)->get();
    }

    /// Starts a frame whose pixels go into a part of `film`, with the job's planes; (left, top) is the place of the
    /// top left pixel of the job's window. Nothing else of the film changes, and the result has no film. Copies of a
    /// Film share its memory, so other frames may fill other parts meanwhile. By default the pixels are copied.
    [[nodiscard]] virtual std::unique_ptr<PendingFrame> submit_to(Film film, int left, int top,
                                                                  std::shared_ptr<ResidentScene> scene,
                                                                  const RenderJob& job);

    /// A film, with undefined contents, in memory that submit_to() fills fast. May be called from any thread.
    [[nodiscard]] virtual Film make_film(int width, int height, int samples, PlaneMask planes);

    /// The number of frames, or windows of one, to submit before waiting for the first, so that the processor is not
    /// idle.
    [[nodiscard]] virtual std::size_t frames_in_flight() const { return 2; }
};

struct BackendOptions {
    int threads = 0;                ///< CPU and oracle: 0 means one per core
    int tile_size = 16;             ///< CPU: edge of a square tile, pixels
    std::string instruction_set{};  ///< CPU: "x86-64-v2", "-v3" or "-v4"; empty means the best of this machine
    Specialise specialise = Specialise::always;  ///< CUDA
    /// CUDA: whether a pixel tests only the primitives that it may show (kernel/pixel_culling.h). False to measure what
    /// that saves; no bit depends on it.
    bool culls_pixels = true;
    /// CUDA: whether load() may move the hierarchy of an earlier scene to the primitives of this one, if these are as
    /// many of each kind (cuda/refit_bvh.h). False to measure builds; no bit depends on it.
    bool refits_hierarchies = true;
    GpuChoice gpus{};  ///< CUDA: which GPUs render
    /// Several GPUs: gets a sentence when one fails and the others go on, from any thread. It must not call the
    /// backend.
    std::function<void(const std::string& sentence)> report{};
};

}  // namespace tandem
