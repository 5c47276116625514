/// How tandem-bench targets measures.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "backend_source.h"
#include "baseline/naive_renderer.h"
#include "ray_sets.h"
#include "tandem/report/report.h"
#include "tandem/report/statistics.h"
#include "tandem/scene/scene.h"
#include "targets.h"
#include "versus.h"

namespace tandem::bench {

inline constexpr const char* million_spheres = "named:spheres/1000000";
inline constexpr const char* million_triangles = "named:triangles/1000000";
inline constexpr const char* million_boxes = "named:boxes/1000000";
inline constexpr int mitsuba_threads = 2;

/// Measures targets, one after the other, and adds the rows to a report. Each function fills the measured value and the
/// verdict of a result, or why it was not measured.
class TargetRun {
  public:
    TargetRun(const TargetOptions& options, const BackendSource& source, Report& report);

    /// Sample rate of the kernel of a tier divided by that of the naive kernel.
    void gpu_kernel(TargetResult& result, Tier tier, bool culls_pixels);

    /// Sample rate of our CPU renderer divided by that of a build of the naive one, on the same number of threads.
    void cpu_against(TargetResult& result, const NaiveBuild& build, int threads);

    /// Our rays per second divided by raw Embree's.
    void cpu_rays(TargetResult& result, RaySet set);

    /// Our rays per second on the GPU.
    void gpu_rays(TargetResult& result, const char* scene, RaySet set);

    /// Our rays per second in a city of instances, divided by those in a block of them that is written out.
    void gpu_city_rays(TargetResult& result, RaySet set);

    /// Rays per second in a scene that is hard for a hierarchy, divided by those in an ordinary one.
    void hard_rays(TargetResult& result, const char* backend, RaySet set, const char* scene, const char* ordinary);

    /// Rays from the points that coherent rays hit to a point light, in a million spheres: any hit ends them.
    void gpu_shadow_rays(TargetResult& result);

    /// Rays per second of the tier fast divided by those of strict: the price of exactness.
    void price_of_strict(TargetResult& result, const char* scene);

    /// The time of a frame in strict over that in fast: the worst of all scenes.
    void frame_price(TargetResult& result, const std::string& backend);

    /// Samples per second of whitted.gltf in strict.
    void whitted_rate(TargetResult& result);

    /// Samples per second of whitted.gltf in strict on the CPU, divided by those of a variant of Mitsuba.
    void beside_mitsuba(TargetResult& result, const char* variant);

    /// Primitives per second of a build on the GPU whose memory is there from the build before.
    void gpu_build(TargetResult& result);

    /// Seconds from the start of tandem-render until its picture is written.
    void gpu_first_picture(TargetResult& result);

    /// The least efficiency of several GPUs among two scenes.
    void gpu_scale(TargetResult& result, int gpus);

    /// Share of the animation's wall-clock time that is kernel time: the median of some runs behind a first one, which
    /// links the kernel and allocates memory.
    void render_share(TargetResult& result);

  private:
    std::unique_ptr<Backend> make(const std::string& name, const BackendOptions& options);
    /// Empty if tandem-render is not there; then `result` says so.
    static std::string find_renderer(TargetResult& result);
    /// Times frames of a scene in each tier, in turns, after one round of warm-up.
    std::vector<BenchmarkRow> time_frames(Backend& backend, const std::string& path, const std::vector<Tier>& tiers);
    double render_seconds(Backend& backend, const RenderJob& job);
    RenderJob paper_job() const;
    NaiveJob naive_job() const;
    std::vector<float>& buffer();
    VersusOptions ray_options(const char* scene, RaySet set) const;
    /// Times both in turns, after one round of warm-up; the measured value is the baseline's time over ours.
    void compare(TargetResult& result, const std::string& their_name, const std::function<double()>& theirs,
                 const std::string& our_name, const std::function<double()>& ours);
    void add_rows(const std::vector<BenchmarkRow>& rows);
    static void finish_rays(TargetResult& result, const BenchmarkRow& row);
    static void finish(TargetResult& result, const Ratio& ratio);
    static void finish_at_most(TargetResult& result, const Ratio& ratio);
    /// Times all measures in turns, into a row for each.
    void time_in_turns(std::span<BenchmarkRow> rows, const std::function<double(std::size_t)>& measure) const;

    const TargetOptions& options_;
    const BackendSource& source_;
    Report& report_;
    Scene paper_;
    std::vector<float> buffer_;
};

}  // namespace tandem::bench
