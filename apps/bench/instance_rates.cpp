#include "instance_rates.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "output.h"
#include "tandem/base/seconds.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

/// A scene on the GPU, and its row.
struct InstanceContender {
    BenchmarkRow row{};
    std::shared_ptr<ResidentScene> resident{};
    std::vector<Ray<float>> rays{};
    std::vector<Hit> hits{};
};

/// `keeps`: the mesh is kept once. Otherwise its faces are written out.
InstanceContender make_contender(Backend& gpu, const std::string& scene, bool keeps, RaySet set,
                                 std::vector<Ray<float>> rays) {
    InstanceContender made;
    PrepareOptions options;
    options.origin = Vec3d{0, 0, 0};  // the rays are made in world space
    options.instanced_from = keeps ? 1 : std::numeric_limits<std::uint64_t>::max();
    const Scene authored = load_scene(scene);
    const Stopwatch preparing;
    const PreparedScene prepared = prepare(authored, options);
    phase(made.row, "prepare").seconds = {preparing.seconds()};
    const Stopwatch loading;
    made.resident = gpu.load(prepared);
    phase(made.row, "load").seconds = {loading.seconds()};
    made.rays = std::move(rays);
    made.hits.resize(made.rays.size());
    made.row.label = fmt::format("{}, {}, {}", scene, keeps ? "kept once" : "written out", to_string(set));
    made.row.scene = fmt::format("{}, {} rays", scene, to_string(set));
    made.row.backend = gpu.name();
    made.row.tier = "strict";
    made.row.rays = static_cast<double>(made.rays.size());
    return made;
}

}  // namespace

std::vector<Ray<float>> city_rays(RaySet set, int city_edge, int ray_edge) {
    std::vector<Ray<float>> rays = make_rays(set, ray_edge);
    // half of the angle of view, and how far down it looks: the horizon is at the top
    const double half = 0.15, cosine = 1 / std::sqrt(1 + half * half), sine = half * cosine;
    for (Ray<float>& ray : rays) {
        if (set == RaySet::random) {
            ray.origin.y /= static_cast<float>(city_edge);
            continue;
        }
        const Vec3d d = widen(ray.direction) * (half * 1.5);
        ray.origin = {0, static_cast<float>(11.0 / city_edge), 1};
        ray.direction = narrow(Vec3d{d.x, d.y * cosine - sine, -d.y * sine - cosine});
    }
    return rays;
}

InstanceRates time_instances(RaySet set, const InstanceRateOptions& options, const BackendSource& source,
                             Report& report) {
    log_progress(fmt::format("instances: {} rays", to_string(set)));
    const std::unique_ptr<Backend> gpu = source.make("cuda", {});
    describe_backend(*gpu, report);
    const std::string block = fmt::format("named:block/{}", options.block);
    const std::string city = fmt::format("named:city/{}", options.city_edge * options.city_edge);
    const std::vector<Ray<float>> rays = make_rays(set, options.ray_edge);
    std::array contenders = {
        make_contender(*gpu, block, false, set, rays), make_contender(*gpu, block, true, set, rays),
        make_contender(*gpu, city, true, set, city_rays(set, options.city_edge, options.ray_edge))};
    for (int round = -1; round < options.repetitions; ++round) {  // the first warms up
        for (const std::size_t i : interleaved_order(contenders.size(), static_cast<std::size_t>(round) + 1)) {
            InstanceContender& one = contenders[i];
            const double seconds =
                gpu->trace(*one.resident,
                           {.rays = one.rays, .hits = one.hits, .counters = round < 0 ? &one.row.counters : nullptr});
            if (round < 0) continue;
            one.row.seconds.push_back(seconds);
            one.row.rounds.push_back(round);
        }
    }
    std::size_t differing = 0;
    for (std::size_t i = 0; i < contenders[0].hits.size(); ++i) {
        differing += has_bits_of(contenders[0].hits[i], contenders[1].hits[i]) ? 0 : 1;
    }
    for (InstanceContender& one : contenders) {
        std::size_t hits = 0;
        for (const Hit& hit : one.hits) hits += hit.primitive != no_primitive ? 1 : 0;
        one.row.figures.emplace_back("share of hits", static_cast<double>(hits) / one.row.rays);
    }
    return {std::move(contenders[0].row), std::move(contenders[1].row), std::move(contenders[2].row), differing};
}

bool run_instance_rates(const InstanceRateOptions& options, const BackendSource& source, Report& report) {
    report.blocks.emplace_back(Heading{"Instances"});
    Table table{
        fmt::format("{} rays, strict, medians of {} rounds in turns. The ratio is to the block written out",
                    format_count(static_cast<double>(options.ray_edge) * options.ray_edge), options.repetitions),
        {{"Rays"}, {"Scene"}, {"Load", true}, {"Rays/s", true}, {"Hits", true}, {"Ratio", true}},
        {}};
    std::size_t differing = 0;
    for (const RaySet set : {RaySet::coherent, RaySet::random}) {
        InstanceRates rates = time_instances(set, options, source, report);
        differing += rates.differing_hits;
        const std::vector<double> reference = rates.written.seconds;
        for (BenchmarkRow* row : {&rates.written, &rates.kept, &rates.city}) {
            table.rows.push_back({to_string(set), row->label, format_seconds(phase(*row, "load").seconds[0]),
                                  format_count(rays_per_second(*row)), format_share(row->figures.back().second),
                                  format_ratio(ratio_of_medians(reference, row->seconds))});
            report.rows.push_back(std::move(*row));
        }
    }
    report.blocks.emplace_back(std::move(table));
    report.blocks.emplace_back(
        differing == 0 ? Callout{Callout::Kind::good, "All hits of the block are equal, bit for bit."}
                       : Callout{Callout::Kind::bad,
                                 fmt::format("{} hits differ from those of the faces written out.", differing)});
    return differing == 0;
}

}  // namespace tandem::bench
