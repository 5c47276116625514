// The part of `versus` that traces rays.
#include <fmt/format.h>

#include <functional>

#include "baseline/embree_native.h"
#include "output.h"
#include "ray_sets.h"
#include "tandem/base/seconds.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/report/statistics.h"
#include "versus.h"

namespace tandem::bench {

namespace {

/// Something that traces rays, and the row of its times.
struct RayContender {
    BenchmarkRow row;
    std::function<double(std::span<const Ray<float>>, std::span<Hit>, RenderCounters&)> trace;
    bool is_compared = false;  ///< the bits of its hits are compared with those of the first contender
    std::vector<Hit> hits;
    std::shared_ptr<ResidentScene> resident{};  ///< null for raw Embree
};

/// Null for scenes that Embree's own spheres or triangles cannot represent.
std::unique_ptr<EmbreeNative> make_native(const PreparedScene& scene, int threads) {
    const std::size_t count = primitive_count(scene);
    if (!scene.instances.empty()) return nullptr;
    if (scene.spheres.size() == count) return std::make_unique<EmbreeNative>(scene.spheres, threads);
    if (scene.triangles.size() == count) return std::make_unique<EmbreeNative>(scene.triangles, threads);
    return nullptr;
}

BenchmarkRow ray_row(const VersusOptions& options, const std::string& label, const std::string& backend) {
    BenchmarkRow row;
    row.label = label;
    row.scene = fmt::format("{}, {} rays", options.scene, to_string(*options.rays));
    row.backend = backend;
    row.rays = static_cast<double>(options.ray_edge) * options.ray_edge;
    if (backend != "cuda") row.threads = options.threads;
    return row;
}

RayContender make_contender(Backend& backend, const PreparedScene& scene, Tier tier, BenchmarkRow row) {
    const std::shared_ptr<ResidentScene> resident = backend.load(scene, tier);
    row.tier = to_string(tier);
    phase(row, "build").seconds = {resident->load_times().build};
    phase(row, "upload").seconds = {resident->load_times().upload};
    const auto trace = [&backend, resident](auto rays, auto hits, RenderCounters& counters) {
        return backend.trace(*resident, {.rays = rays, .hits = hits, .counters = &counters});
    };
    return {std::move(row), trace, true, {}, resident};
}

/// Measures all contenders in rounds of alternating order. One round before them warms up and gives the hits.
void measure(std::vector<RayContender>& contenders, const std::vector<Ray<float>>& rays, int repetitions) {
    for (RayContender& contender : contenders) {
        contender.hits.resize(rays.size());
        contender.trace(rays, contender.hits, contender.row.counters);
        // the first rays of a kind may build more
        if (contender.resident != nullptr)
            phase(contender.row, "build").seconds = {contender.resident->load_times().build};
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
    const Tier tier = parse_tier(options.tier);
    // the rays are made in world space
    const PreparedScene scene = prepare(load_scene(options.scene), {options.frame, {}, Vec3d{0, 0, 0}});
    const std::vector<Ray<float>> rays = make_rays(*options.rays, options.ray_edge);

    // Declared before the contenders that use them.
    std::vector<std::unique_ptr<Backend>> owners;
    std::vector<RayContender> contenders;
    RayTiming timing;
    Backend* cpu = nullptr;
    for (const std::string& name : backends) {
        Backend& backend = *owners.emplace_back(source.make(name, {options.threads, 16, {}}));
        describe_backend(backend, report);
        if (name == "cpu") cpu = &backend;
        contenders.push_back(make_contender(backend, scene, tier, ray_row(options, name, name)));
    }
    if (cpu != nullptr && tier != Tier::fast) {
        contenders.push_back(make_contender(*cpu, scene, Tier::fast, ray_row(options, "cpu, tier fast", "cpu")));
        contenders.back().is_compared = false;
    }
    std::unique_ptr<EmbreeNative> native;
    if (cpu != nullptr) native = make_native(scene, options.threads);
    if (native != nullptr) {
        RayContender contender{ray_row(options, "raw Embree, rtcIntersect1", "embree"), {}, false, {}};
        contender.row.variant = EmbreeNative::version();
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
        if (!is_native && !contenders[c].is_compared) continue;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Hit& hit = contenders[c].hits[i];
            if (is_native) {
                timing.native_ids += hit.primitive != first[i].primitive ? 1 : 0;
            } else {
                timing.differing_hits += has_bits_of(hit, first[i]) ? 0 : 1;
            }
        }
    }
    for (RayContender& contender : contenders) timing.rows.push_back(std::move(contender.row));
    return timing;
}

}  // namespace tandem::bench
