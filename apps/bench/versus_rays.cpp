// The part of versus that traces rays.
#include <fmt/format.h>

#include <bit>
#include <functional>

#include "baseline/embree_native.h"
#include "output.h"
#include "tandem/render/seconds.h"
#include "tandem/report/statistics.h"
#include "tandem/scene/load_scene.h"
#include "tandem/scene/prepare.h"
#include "versus.h"

namespace tandem::bench {

namespace {

/// Something that traces rays, and the row of its times.
struct RayContender {
    BenchmarkRow row;
    std::function<double(std::span<const Ray<float>>, std::span<Hit>, RenderCounters&)> trace;
    std::vector<Hit> hits;
};

bool same(const Hit& a, const Hit& b) {
    return a.primitive == b.primitive && std::bit_cast<std::uint32_t>(a.t) == std::bit_cast<std::uint32_t>(b.t);
}

bool only_spheres(const PreparedScene& scene) { return scene.spheres.size() == primitive_count(scene); }

BenchmarkRow ray_row(const VersusOptions& options, const std::string& label, const std::string& backend) {
    BenchmarkRow row;
    row.label = label;
    row.scene = fmt::format("{}, {} rays", options.scene, to_string(*options.rays));
    row.backend = backend;
    row.rays = static_cast<double>(options.ray_edge) * options.ray_edge;
    if (backend != "cuda") row.threads = options.threads;
    return row;
}

/// The measurements of all contenders in rounds that go forth and back; one round before them warms up and gives the
/// hits.
void measure(std::vector<RayContender>& contenders, const std::vector<Ray<float>>& rays, int repetitions) {
    for (RayContender& contender : contenders) {
        contender.hits.resize(rays.size());
        contender.trace(rays, contender.hits, contender.row.counters);
    }
    std::vector<Hit> scratch(rays.size());
    for (int round = 0; round < repetitions; ++round) {
        for (const std::size_t i : interleaved_order(contenders.size(), static_cast<std::size_t>(round))) {
            contenders[i].row.seconds.push_back(contenders[i].trace(rays, scratch, contenders[i].row.counters));
            contenders[i].row.rounds.push_back(round);
        }
    }
}

}  // namespace

RayTiming time_rays(const VersusOptions& options, const std::vector<std::string>& backends, const BackendSource& source,
                    Report& report) {
    log_progress(fmt::format("{}: {} rays", options.scene, to_string(*options.rays)));
    // the rays are made in world space
    const PreparedScene scene = prepare(load_scene(options.scene), {options.frame, {}, Vec3d{0, 0, 0}});
    const std::vector<Ray<float>> rays = make_rays(*options.rays, options.ray_edge);

    // Owners before what traces with them.
    std::vector<std::unique_ptr<Backend>> owners;
    std::vector<RayContender> contenders;
    RayTiming timing;
    bool has_cpu = false;
    for (const std::string& name : backends) {
        Backend& backend = *owners.emplace_back(source.make(name, {options.threads, 16, {}}));
        describe_backend(backend, report);
        has_cpu = has_cpu || name == "cpu";
        RayContender contender{ray_row(options, name, name), {}, {}};
        contender.row.tier = "strict";
        const std::shared_ptr<ResidentScene> resident = backend.load(scene);
        phase(contender.row, "build").seconds = {resident->load_times().build};
        phase(contender.row, "upload").seconds = {resident->load_times().upload};
        contender.trace = [&backend, resident](auto some_rays, auto hits, RenderCounters& counters) {
            return backend.trace(*resident, {.rays = some_rays, .hits = hits, .counters = &counters});
        };
        contenders.push_back(std::move(contender));
    }
    std::unique_ptr<EmbreeNative> native;
    if (has_cpu && only_spheres(scene)) {
        native = std::make_unique<EmbreeNative>(scene.spheres, options.threads);
        RayContender contender{ray_row(options, "raw Embree, rtcIntersect1", "embree"), {}, {}};
        contender.row.variant = EmbreeNative::version() + ", RTC_GEOMETRY_TYPE_SPHERE_POINT";
        phase(contender.row, "build").seconds = {native->build_seconds()};
        contender.trace = [&native](auto some_rays, auto hits, RenderCounters&) {
            return native->trace(some_rays, hits);
        };
        contenders.push_back(std::move(contender));
        timing.has_native = true;
    }
    measure(contenders, rays, options.repetitions);

    const std::vector<Hit>& first = contenders.front().hits;
    for (const Hit& hit : first) timing.hits += hit.primitive != no_primitive ? 1 : 0;
    for (std::size_t c = 1; c < contenders.size(); ++c) {
        const bool is_native = timing.has_native && c + 1 == contenders.size();
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Hit& hit = contenders[c].hits[i];
            if (is_native) {
                timing.native_ids += hit.primitive != first[i].primitive ? 1 : 0;
            } else {
                timing.differing_hits += same(hit, first[i]) ? 0 : 1;
            }
        }
    }
    for (RayContender& contender : contenders) timing.rows.push_back(std::move(contender.row));
    return timing;
}

}  // namespace tandem::bench
