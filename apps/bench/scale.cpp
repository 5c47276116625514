#include "scale.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "gpu_scale.h"
#include "instance_rates.h"
#include "output.h"
#include "ray_sets.h"
#include "second_rays.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/math/accurate_functions.h"
#include "tandem/math/exact_math.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

/// Growth is judged from this number of primitives on: with fewer, the set-up of a ray dominates.
constexpr double first_judged = 1000;

/// A backend with a number of threads or GPUs; one line of every plot.
struct ScaleContender {
    std::string name, label;
    int threads;
    int gpus;  ///< 0 for a CPU
    std::unique_ptr<Backend> backend;
};

std::vector<ScaleContender> make_contenders(const ScaleOptions& options, const BackendSource& source, Report& report) {
    std::vector<ScaleContender> contenders;
    for (const std::string& name : available_backends(source, options.backends, report)) {
        const auto add = [&](const std::string& suffix, int threads, int gpus, const BackendOptions& made) {
            contenders.push_back({name, name + suffix, threads, gpus, source.make(name, made)});
            describe_backend(*contenders.back().backend, report);
        };
        if (name == "cuda") {
            for (const int gpus : numbers_of_gpus(options.gpus, source)) {
                add(options.gpus == std::vector<int>{1} ? "" : ", " + gpus_in_words(gpus), 0, gpus,
                    {.refits_hierarchies = false, .gpus = {.count = gpus}});
            }
            continue;
        }
        for (const int threads : options.threads) {
            const std::string suffix =
                threads == 0 ? "" : fmt::format(", {} thread{}", threads, threads == 1 ? "" : "s");
            add(suffix, threads, 0, {.threads = threads});
        }
    }
    if (contenders.empty()) throw EnvironmentError("none of the backends can run here");
    return contenders;
}

std::vector<double> numbers_of_primitives(const ScaleOptions& options) {
    std::vector<double> counts;
    for (int i = 0;; ++i) {
        const double count = std::round(options.least * power<double>(10.0, i / double(options.steps)));
        if (count > options.most * (1 + 1e-9)) break;
        if (counts.empty() || count > counts.back()) counts.push_back(count);
    }
    return counts;
}

/// The lines of a plot: values by the number of primitives.
using Lines = std::map<std::string, std::vector<Point>>;

LinePlot plot_of(const std::string& title, const std::string& unit, const Lines& lines) {
    LinePlot plot{title, {"primitives", true}, {unit, true}, {}, {}};
    for (const auto& [label, points] : lines) plot.lines.push_back({label, points});
    return plot;
}

/// One kind of primitive in scenes of growing size.
class KindScale {
  public:
    KindScale(const ScaleOptions& options, std::string kind, std::vector<ScaleContender>& contenders, Report& report)
        : options_(options), kind_(std::move(kind)), contenders_(contenders), report_(report) {
        table_.caption = fmt::format("{}, {}: median times of {} rounds", kind_, options_.tier, options_.repetitions);
        table_.columns = {{"Primitives", true}, {"Row"}, {"Build", true}, {"Primitives/s", true}};
        for (const std::string& set : options_.rays) table_.columns.push_back({set + ", rays/s", true});
    }

    /// The number of hits that differ between backends.
    std::size_t run() {
        report_.blocks.emplace_back(Heading{kind_});
        for (const double count : numbers_of_primitives(options_)) measure(count);
        report_.blocks.emplace_back(std::move(table_));
        report_.blocks.emplace_back(plot_of(kind_ + ": rays per second", "rays/s", rates_));
        report_.blocks.emplace_back(plot_of(kind_ + ": build", "seconds", builds_));
        add_growth();
        add_gpus();
        return differing_;
    }

  private:
    void measure(double count) {
        const std::string name = fmt::format("named:{}/{:.0f}", kind_, count);
        log_progress(fmt::format("scale: {}", name));
        // the rays are made in world space
        const PreparedScene scene = prepare(load_scene(name), {0, {}, Vec3d{0, 0, 0}});
        std::map<std::string, RaysToTrace> sets;
        std::map<std::string, std::vector<Hit>> first_hits;
        for (const ScaleContender& contender : contenders_) {
            const auto resident = contender.backend->load(scene, parse_tier(options_.tier));
            const double build = resident->load_times().build;
            std::vector<std::string> cells = {format_count(count), contender.label, format_seconds(build),
                                              build > 0 ? format_count(count / build) : "-"};
            builds_[contender.label].push_back({count, build});
            if (sets.empty()) make_sets(contender, *resident, sets);
            for (const std::string& set : options_.rays) {
                BenchmarkRow row = row_of(name, contender, set);
                phase(row, "build").seconds = {build};
                phase(row, "upload").seconds = {resident->load_times().upload};
                std::vector<Hit> hits(sets.at(set).rays.size());
                const TraceJob job = sets.at(set).job(hits, row.counters);
                (void)contender.backend->trace(*resident, job);  // warms up
                for (int round = 0; round < options_.repetitions; ++round) {
                    row.seconds.push_back(contender.backend->trace(*resident, job));
                    row.rounds.push_back(round);
                }
                const auto [first, is_first] = first_hits.try_emplace(set, hits);
                for (std::size_t i = 0; i < hits.size() && !is_first; ++i) {
                    differing_ += has_bits_of(hits[i], first->second[i]) ? 0 : 1;
                }
                cells.push_back(format_count(rays_per_second(row)));
                const std::string line = contender.label + ", " + set;
                rates_[line].push_back({count, rays_per_second(row)});
                times_[line].push_back({count, row.rays / rays_per_second(row)});
                if (contender.gpus > 0) by_gpus_[set][contender.gpus] = rays_per_second(row);
                report_.rows.push_back(std::move(row));
            }
            table_.rows.push_back(std::move(cells));
        }
    }

    /// The rays of a second vertex start at the hit points of the coherent ones, as the first contender finds them.
    void make_sets(const ScaleContender& contender, ResidentScene& resident,
                   std::map<std::string, RaysToTrace>& sets) const {
        const std::vector<Ray<float>> coherent = make_rays(RaySet::coherent, options_.ray_edge);
        std::vector<Hit> hits(coherent.size());
        (void)contender.backend->trace(resident, {.rays = coherent, .hits = hits});
        for (const std::string& set : options_.rays) {
            if (set == "bounce" || set == "shadow") {
                sets[set] = second_rays(coherent, hits, options_.ray_edge, set == "shadow");
            } else {
                sets[set] = {make_rays(parse_ray_set(set), options_.ray_edge), {}, {}};
            }
        }
    }

    [[nodiscard]] BenchmarkRow row_of(const std::string& scene, const ScaleContender& contender,
                                      const std::string& set) const {
        BenchmarkRow row;
        row.label = fmt::format("{}, {}, {}", scene, contender.label, set);
        row.scene = fmt::format("{}, {} rays", scene, set);
        row.backend = contender.name;
        row.tier = options_.tier;
        row.threads = contender.threads;
        row.rays = static_cast<double>(options_.ray_edge) * options_.ray_edge;
        if (contender.gpus > 0) row.figures.emplace_back("gpus", contender.gpus);
        return row;
    }

    void add_growth() {
        Table growth{
            fmt::format(
                "Growth of the time per ray from {:.0f} primitives on: the exponent e of n^e, and the largest ratio to "
                "log n. At 1 or less, the time grows no faster than log n",
                first_judged),
            {{"Rays"}, {"e", true}, {"Over log n", true}},
            {}};
        for (const auto& [label, points] : times_) {
            std::vector<Point> judged;
            std::copy_if(points.begin(), points.end(), std::back_inserter(judged),
                         [](const Point& p) { return p.x >= first_judged; });
            if (judged.size() < 2) continue;
            growth.rows.push_back({label, fmt::format("{:.3f}", fitted_exponent(judged)),
                                   fmt::format("{:.2f}", growth_over_log(judged))});
        }
        if (!growth.rows.empty()) report_.blocks.emplace_back(std::move(growth));
    }

    /// The rates in the scene with the most primitives, by number of GPUs.
    void add_gpus() {
        Table table{
            fmt::format("{} in the largest scene by number of GPUs. Efficiency: the rate over the number of GPUs "
                        "and the rate of one",
                        kind_),
            {{"Rays"}, {"GPUs", true}, {"Rays/s", true}, {"Efficiency", true}},
            {}};
        LinePlot plot{kind_ + ": rays per second by number of GPUs", {"GPUs", true}, {"rays/s", true}, {}, {}};
        for (const auto& [set, rates] : by_gpus_) {
            Line line{set, {}};
            for (const auto& [gpus, rate] : rates) {
                const bool has_one = rates.contains(1);
                table.rows.push_back({set, std::to_string(gpus), format_count(rate),
                                      has_one ? format_number(rate / (gpus * rates.at(1))) : ""});
                line.points.push_back({static_cast<double>(gpus), rate});
            }
            if (line.points.size() > 1) plot.lines.push_back(std::move(line));
        }
        if (plot.lines.empty()) return;
        report_.blocks.emplace_back(std::move(table));
        report_.blocks.emplace_back(std::move(plot));
    }

    const ScaleOptions& options_;
    std::string kind_;
    std::vector<ScaleContender>& contenders_;
    Report& report_;
    Table table_;
    Lines rates_, times_, builds_;
    std::map<std::string, std::map<int, double>> by_gpus_;  ///< rates by set of rays, of the last scene
    std::size_t differing_ = 0;
};

}  // namespace

double fitted_exponent(const std::vector<Point>& times) {
    double x = 0, y = 0, xx = 0, xy = 0;
    const auto n = static_cast<double>(times.size());
    for (const Point& p : times) {
        const double lx = accurate_log(p.x), ly = accurate_log(p.y);
        x += lx, y += ly, xx += lx * lx, xy += lx * ly;
    }
    return (n * xy - x * y) / (n * xx - x * x);
}

double growth_over_log(const std::vector<Point>& times) {
    double most = 0;
    for (const Point& p : times) {
        most = std::max(most, p.y / times.front().y / (accurate_log(p.x) / accurate_log(times.front().x)));
    }
    return most;
}

std::vector<int> numbers_of_gpus(const std::vector<int>& wanted, const BackendSource& source) {
    std::set<int> numbers;
    for (const int number : wanted) {
        if (number < 0) throw InputError(fmt::format("--gpus: {} is not a number of GPUs", number));
        if (number > 0) numbers.insert(number);
        for (int i = 1; number == 0 && i <= source.gpu_count(); ++i) numbers.insert(i);
    }
    return {numbers.begin(), numbers.end()};
}

namespace {

/// Builds and traces the scenes. True if all hits are equal, or need not be.
bool run_rays(const ScaleOptions& options, const BackendSource& source, Report& report) {
    if (!(options.least >= 1) || !(options.most >= options.least)) {
        throw InputError(
            "--from and --to must be numbers of primitives, the first at least 1 and not above the second");
    }
    for (const std::string& set : options.rays) {
        if (set != "bounce" && set != "shadow") (void)parse_ray_set(set);
    }
    std::vector<ScaleContender> contenders = make_contenders(options, source, report);
    std::size_t differing = 0;
    for (const std::string& kind : options.kinds) differing += KindScale(options, kind, contenders, report).run();
    report.blocks.emplace_back(Paragraph{
        "Coherent rays are those of a camera, random ones start anywhere in the scene. Bounce rays start where the "
        "coherent "
        "ones hit, in random directions on the side that these came from; shadow rays go from there to a light, and "
        "ask "
        "for any hit. Where a coherent ray misses, both have a random ray. Scenes have random places and sizes that "
        "shrink with the number of primitives."});
    const bool must_agree = parse_tier(options.tier) != Tier::fast;
    if (contenders.size() > 1) {
        report.blocks.emplace_back(differing == 0
                                       ? Callout{Callout::Kind::good, "All hits are equal, bit for bit."}
                                       : Callout{must_agree ? Callout::Kind::bad : Callout::Kind::note,
                                                 fmt::format("{} hits differ between backends.", differing)});
    }
    return differing == 0 || !must_agree;
}

}  // namespace

bool run_scale(const ScaleOptions& options, const BackendSource& source, Report& report) {
    const auto has = [&](const char* part) {
        return std::find(options.parts.begin(), options.parts.end(), part) != options.parts.end();
    };
    report.title = "Scale";
    bool holds = true;
    if (has("rays")) {
        report.summary = fmt::format("Times of {} from {:.0f} to {:.0f} primitives, tier {}.",
                                     fmt::join(options.kinds, ", "), options.least, options.most, options.tier);
        holds = run_rays(options, source, report);
    }
    if (has("frames")) {
        const std::vector<int> gpus = numbers_of_gpus(options.gpus, source);
        report.summary += fmt::format("{}Frames of {} by number of GPUs, tier {}.", report.summary.empty() ? "" : " ",
                                      fmt::join(options.scenes, ", "), options.tier);
        const std::string reason = source.why_unavailable("cuda");
        if (!reason.empty())
            throw EnvironmentError(fmt::format("frames by number of GPUs cannot be measured: {}", reason));
        const GpuScaleOptions frames{{}, gpus, options.size, options.samples, options.tier, options.repetitions};
        holds = run_gpu_scale(frames, options.scenes, source, report) && holds;
    }
    if (has("instances")) {
        const std::string reason = source.why_unavailable("cuda");
        if (!reason.empty())
            throw EnvironmentError(fmt::format("rays through instances cannot be measured: {}", reason));
        report.summary += "Rays through meshes that are kept once.";
        const InstanceRateOptions rates{.ray_edge = options.ray_edge, .repetitions = options.repetitions};
        holds = run_instance_rates(rates, source, report) && holds;
    }
    return holds;
}

}  // namespace tandem::bench
