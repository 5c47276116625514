/// The interface of all renderers: CPU, CUDA, oracle.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tandem/compile/prepared_scene.h"
#include "tandem/film/film.h"
#include "tandem/render/render_job.h"
#include "tandem/render/specialise.h"
#include "tandem/render/stats.h"
#include "tandem/render/tier.h"
#include "tandem/render/trace_job.h"

namespace tandem {

struct Capabilities {
    std::string device;       ///< the name of the processor
    std::string description;  ///< versions of libraries and drivers, for reports
    bool exact = true;        ///< guarantees the bits of the tier strict
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

class Backend {
  public:
    virtual ~Backend() = default;

    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual Capabilities capabilities() const = 0;

    /// Loads the scene into the backend's memory. Buffers of released scenes are reused. Throws EnvironmentError,
    /// before it builds anything, if the memory cannot hold the scene.
    [[nodiscard]] virtual std::shared_ptr<ResidentScene> load(const PreparedScene& scene, Tier tier = Tier::strict) = 0;

    /// Finds the nearest hits of rays in front of their origins (t > 0), or whether shadow rays are blocked
    /// (trace_job.h). Rays are in render space; render_from_world() (compile/prepared_scene.h) converts points. Rays
    /// that are not traceable (math/ray.h) miss and are counted. Returns the seconds that tracing took, without copies.
    virtual double trace(ResidentScene& scene, const TraceJob& job) = 0;
    double trace(ResidentScene& scene, std::span<const Ray<float>> rays, std::span<Hit> hits) {
        return trace(scene, TraceJob{.rays = rays, .hits = hits});
    }

    /// Starts a frame. A backend may render several at a time; call get() of each in any order.
    [[nodiscard]] virtual std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                               const RenderJob& job) = 0;

    [[nodiscard]] RenderResult render(std::shared_ptr<ResidentScene> scene, const RenderJob& job) {
        return submit(std::move(scene), job)->get();
    }
};

struct BackendOptions {
    int threads = 0;                ///< CPU and oracle: 0 means one per core
    int tile_size = 16;             ///< CPU: edge of a square tile, pixels
    std::string instruction_set{};  ///< CPU: "x86-64-v2", "-v3" or "-v4"; empty means the best of this machine
    Specialise specialise = Specialise::always;  ///< CUDA
    /// CUDA: whether a pixel tests only the primitives that it may show (kernel/pixel_culling.h). False to measure what
    /// that saves; no bit depends on it.
    bool culls_pixels = true;
};

}  // namespace tandem
