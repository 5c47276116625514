#include "target_list.h"

#include <fmt/format.h>

#include <array>
#include <tuple>
#include <utility>

#include "sequence.h"

namespace tandem::bench {

namespace {

std::string command_of(const std::string& id) { return "tandem-bench targets --only " + id; }

Target target(const std::string& id, const std::string& statement, double required, int needed_gpus,
              std::function<void(TargetRun&, TargetResult&)> measure) {
    Target made;
    made.description.id = id;
    made.description.statement = statement;
    made.description.required = required;
    made.description.command = command_of(id);
    made.needed_gpus = needed_gpus;
    made.measure = std::move(measure);
    return made;
}

/// The thread counts to measure on a machine with `cores` cores: 1, 2 and 16, as far as it has them.
std::vector<int> thread_counts(int cores) {
    std::vector<int> counts;
    for (const int count : {1, 2, 16}) {
        if (count <= cores) counts.push_back(count);
    }
    return counts;
}

/// Nearest hits through trace(), in the tier strict; rates in G rays/s.
struct GpuRays {
    const char* suffix;
    const char* what;
    const char* scene;
    double coherent, random;
    double fast_over_strict;  ///< at most, for random rays
};
constexpr std::array gpu_rays = {
    GpuRays{"", "A million spheres", million_spheres, 7.0, 2.8, 1.10},
    GpuRays{"-mesh", "A mesh of 1.3 million triangles", "named:icosphere/8", 7.2, 3.0, 1.35},
    GpuRays{"-triangles", "A million loose triangles", million_triangles, 2.5, 1.05, 1.10},
    GpuRays{"-boxes", "A million turned boxes", million_boxes, 5.0, 2.1, 1.10},
};

/// Scenes that are hard for a hierarchy, and ordinary ones of the same kind of primitive.
struct HardScene {
    const char* name;
    const char* what;
    const char* scene;
    const char* than;
    const char* ordinary;
};
constexpr std::array hard_scenes = {
    HardScene{"giant", "A million spheres above one of 1000 km", "named:giant/1000000", "the spheres alone",
              million_spheres},
    HardScene{"hair", "A million hair-thin triangles", "named:hair/1000000", "as many loose triangles",
              million_triangles},
};

}  // namespace

std::vector<Target> all_targets(int cores) {
    std::vector<Target> targets;
    for (const Tier tier : {Tier::strict, Tier::fast}) {
        const double rate = tier == Tier::strict ? 1.25 : 2;
        targets.push_back(target(
            fmt::format("gpu-paper{}", tier == Tier::strict ? "" : "-" + to_string(tier)),
            fmt::format("Paper's scene, GPU, {}, kernel time: at least {} times the sample rate of the naive kernel, "
                        "which has the scene in its code",
                        to_string(tier), rate),
            rate, 1, [tier](TargetRun& run, TargetResult& result) { run.gpu_kernel(result, tier, true); }));
    }
    targets.push_back(target(
        "gpu-paper-unculled",
        "The same in strict, where each pixel tests all primitives, as the naive kernel does: at least 0.8 times", 0.8,
        1, [](TargetRun& run, TargetResult& result) { run.gpu_kernel(result, Tier::strict, false); }));
    for (const int threads : thread_counts(cores)) {
        const char* plural = threads == 1 ? "" : "s";
        targets.push_back(target(
            fmt::format("cpu-paper-{}", threads),
            fmt::format("Paper's scene, CPU, {} thread{}: at least 0.5 times the naive loops with -O3", threads,
                        plural),
            0.5, 0, [threads](TargetRun& run, TargetResult& result) { run.cpu_against(result, naive_o3, threads); }));
    }
    targets.push_back(target(
        "cpu-paper-o0",
        fmt::format("Paper's scene, CPU, one thread per core ({}): at least 4 times the naive loops with -O0", cores),
        4, 0, [cores](TargetRun& run, TargetResult& result) { run.cpu_against(result, naive_o0, cores); }));
    targets.push_back(target("cpu-rays-coherent", "A million spheres, CPU, coherent rays: at least 2 times raw Embree",
                             2, 0, [](TargetRun& run, TargetResult& r) { run.cpu_rays(r, RaySet::coherent); }));
    targets.push_back(target("cpu-rays-random", "A million spheres, CPU, random rays: at least 1 times raw Embree", 1,
                             0, [](TargetRun& run, TargetResult& r) { run.cpu_rays(r, RaySet::random); }));
    for (const GpuRays& rays : gpu_rays) {
        const auto add = [&](RaySet set, double rate) {
            targets.push_back(
                target(fmt::format("gpu-rays-{}{}", to_string(set), rays.suffix),
                       fmt::format("{}, GPU (H200), {} rays: at least {} G rays/s", rays.what, to_string(set), rate),
                       rate * 1e9, 1,
                       [&rays, set](TargetRun& run, TargetResult& result) { run.gpu_rays(result, rays.scene, set); }));
        };
        add(RaySet::coherent, rays.coherent);
        add(RaySet::random, rays.random);
        targets.push_back(target(fmt::format("gpu-fast-random{}", rays.suffix),
                                 fmt::format("{}, GPU, random rays: fast at most {} times as fast as strict", rays.what,
                                             rays.fast_over_strict),
                                 rays.fast_over_strict, 1, [&rays](TargetRun& run, TargetResult& result) {
                                     run.price_of_strict(result, rays.scene);
                                 }));
    }
    for (const RaySet set : {RaySet::coherent, RaySet::random}) {
        targets.push_back(target(fmt::format("gpu-city-{}", to_string(set)),
                                 fmt::format("A city of 100,489 instances of a mesh, GPU, {} rays: at least 0.2 times "
                                             "the rate in a block of 125 that is written out",
                                             to_string(set)),
                                 0.2, 1, [set](TargetRun& run, TargetResult& r) { run.gpu_city_rays(r, set); }));
    }
    for (const char* backend : {"cuda", "cpu"}) {
        const bool on_gpu = backend == std::string("cuda");
        for (const RaySet set : {RaySet::coherent, RaySet::random}) {
            for (const HardScene& scene : hard_scenes) {
                targets.push_back(target(fmt::format("{}-{}-{}", on_gpu ? "gpu" : "cpu", scene.name, to_string(set)),
                                         fmt::format("{}, {}, {} rays: at least 0.2 times the rate in {}", scene.what,
                                                     on_gpu ? "GPU" : "CPU", to_string(set), scene.than),
                                         0.2, on_gpu ? 1 : 0,
                                         [backend, set, &scene](TargetRun& run, TargetResult& result) {
                                             run.hard_rays(result, backend, set, scene.scene, scene.ordinary);
                                         }));
            }
        }
    }
    targets.push_back(target("gpu-rays-shadow", "A million spheres, GPU (H200), shadow rays: at least 3 G rays/s", 3e9,
                             1, [](TargetRun& run, TargetResult& result) { run.gpu_shadow_rays(result); }));
    targets.push_back(target("gpu-whitted", "whitted.gltf, GPU (H200), strict: at least 1.4 G samples/s", 1.4e9, 1,
                             [](TargetRun& run, TargetResult& result) { run.whitted_rate(result); }));
    for (const char* backend : {"cuda", "cpu"}) {
        const bool on_gpu = backend == std::string("cuda");
        targets.push_back(target(
            fmt::format("{}-frame-price", on_gpu ? "gpu" : "cpu"),
            fmt::format(
                "Frames of the scenes of assets/scenes and of a million primitives, {}: strict takes at most 1.10 "
                "times as long as fast",
                on_gpu ? "GPU" : "CPU"),
            1.10, on_gpu ? 1 : 0,
            [backend](TargetRun& run, TargetResult& result) { run.frame_price(result, backend); }));
    }
    for (const auto& [suffix, variant, rate] :
         {std::tuple{"scalar", "scalar_rgb", 6.0}, {"llvm", "llvm_ad_rgb", 2.5}}) {
        targets.push_back(
            target(fmt::format("cpu-mitsuba-{}", suffix),
                   fmt::format("whitted.gltf, CPU, {} threads, strict: at least {} times the sample rate of "
                               "Mitsuba 3's {}",
                               mitsuba_threads, rate, variant),
                   rate, 0, [name = variant](TargetRun& run, TargetResult& r) { run.beside_mitsuba(r, name); }));
    }
    targets.push_back(target("gpu-build", "Ten million spheres, GPU (H200), build: at least 1 G spheres/s", 1e9, 1,
                             [](TargetRun& run, TargetResult& result) { run.gpu_build(result); }));
    targets.push_back(target(
        "gpu-first-picture",
        "Ten million spheres, GPU: at most 2 s from the start of tandem-render until its picture is written and it has "
        "ended, with kernels in the cache",
        2, 1, [](TargetRun& run, TargetResult& result) { run.gpu_first_picture(result); }));
    targets.push_back(target(
        "gpu-share", "Paper's animation on the GPU with PNG files: at least 95 % of the wall-clock time is kernel time",
        least_render_share, 1, [](TargetRun& run, TargetResult& result) { run.render_share(result); }));
    for (const auto& [gpus, efficiency] : {std::pair{2, 0.95}, std::pair{4, 0.9}}) {
        targets.push_back(target(
            fmt::format("gpu-scale-{}", gpus),
            fmt::format("4K frames of the paper's scene and of a million spheres, 64 samples, "
                        "strict, {} GPUs: efficiency at least {}",
                        gpus, efficiency),
            efficiency, gpus, [count = gpus](TargetRun& run, TargetResult& result) { run.gpu_scale(result, count); }));
    }
    return targets;
}

}  // namespace tandem::bench
