/// The interface that every renderer has: CPU, CUDA, oracle. Five verbs.
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
    std::string device;       ///< the processor, in words
    std::string description;  ///< versions of what it stands on, for reports
    bool exact = true;        ///< promises the bits of the strict tier
};

/// A scene in the memory of a backend, made ready for a tier. Belongs to the backend that loaded it and must not
/// outlive it.
class ResidentScene {
  public:
    explicit ResidentScene(Tier tier) : tier_(tier) {}
    virtual ~ResidentScene() = default;
    [[nodiscard]] Tier tier() const { return tier_; }
    /// What load() cost.
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
    /// Waits. Call once.
    [[nodiscard]] virtual RenderResult get() = 0;
};

class Backend {
  public:
    virtual ~Backend() = default;

    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual Capabilities capabilities() const = 0;

    /// Takes the scene into the backend's memory. Buffers of scenes that were let go are used again.
    [[nodiscard]] virtual std::shared_ptr<ResidentScene> load(const PreparedScene& scene, Tier tier = Tier::strict) = 0;

    /// Nearest hits of rays in front of their origins (t > 0), or whether shadow rays are stopped (trace_job.h). Rays
    /// are in render space: a point of the world is there at render_from_world() (compile/prepared_scene.h). Rays that
    /// are not traceable (math/ray.h) miss and are counted. Returns the seconds that the tracing itself took, without
    /// copies.
    virtual double trace(ResidentScene& scene, const TraceJob& job) = 0;
    double trace(ResidentScene& scene, std::span<const Ray<float>> rays, std::span<Hit> hits) {
        return trace(scene, TraceJob{.rays = rays, .hits = hits});
    }

    /// Starts a frame. A backend may run several at a time; get() returns them in any order.
    [[nodiscard]] virtual std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                               const RenderJob& job) = 0;

    [[nodiscard]] RenderResult render(std::shared_ptr<ResidentScene> scene, const RenderJob& job) {
        return submit(std::move(scene), job)->get();
    }
};

struct BackendOptions {
    int threads = 0;              ///< CPU and oracle: 0 means one per core
    int tile_size = 16;           ///< CPU: edge of a square tile, pixels
    std::string instruction_set;  ///< CPU: "x86-64-v2", "-v3" or "-v4"; empty means the best of this machine
    Specialise specialise = Specialise::always;  ///< CUDA
};

}  // namespace tandem
