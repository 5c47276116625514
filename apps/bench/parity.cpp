#include "parity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "frame_timing.h"
#include "output.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/images/compare.h"
#include "tandem/report/format_number.h"
#include "tiers.h"

namespace tandem::bench {

namespace {

/// Limit of primitive tests per frame by brute force: about a minute on two cores.
constexpr double most_oracle_tests = 3e8;

/// Number of films that are kept at a time for comparison.
constexpr double most_film_bytes = 5e8;

/// The result of one variant for the frames of one scene.
struct Outcome {
    ParityVariant variant;
    bool exact = true;
    std::size_t differing_pixels = 0;
    std::size_t pixels = 0;
    std::array<double, tolerances.size()> worst_rate{};  ///< residual rate, the worst frame
    double largest = 0;
    BenchmarkRow row;
    std::string reason;  ///< why there is no result; empty if there is one
};

/// One scene in one tier, in all variants. Only one backend exists at a time, because a limit on threads applies to the
/// whole process.
class SceneParity {
  public:
    SceneParity(std::string name, Tier tier, const std::vector<ParityVariant>& variants, const ParityOptions& options,
                const BackendSource& source, Report& report)
        : name_(std::move(name)),
          tier_(tier),
          scene_(load_scene(name_, nullptr, {.aspect = aspect_of(options.size)})),
          options_(options),
          source_(source),
          report_(report) {
        const double tests = static_cast<double>(options.size.width) * options.size.height * options.samples *
                             static_cast<double>(primitive_count(prepare(scene_, {options.frames.first, {}})));
        for (const ParityVariant& variant : variants) {
            Outcome& outcome = outcomes_.emplace_back();
            outcome.variant = variant;
            if (variant.backend == "oracle" && tests > most_oracle_tests) {
                outcome.reason =
                    fmt::format("not run: brute force would take {} primitive tests per frame", format_count(tests));
            }
        }
    }

    void run() {
        const double film_bytes = 24.0 * options_.size.width * options_.size.height;
        const int chunk = std::max(1, static_cast<int>(most_film_bytes / film_bytes));
        for (int first = options_.frames.first; first <= options_.frames.last; first += chunk) {
            reference_.clear();
            chunk_ = {first, std::min(first + chunk - 1, options_.frames.last)};
            for (Outcome& outcome : outcomes_) {
                if (outcome.reason.empty()) render(outcome);
            }
            for (const Film& film : reference_) hashes_.push_back(film_hash(film));
        }
    }

    [[nodiscard]] std::string label() const { return fmt::format("{}, {}", name_, to_string(tier_)); }
    [[nodiscard]] std::vector<Outcome>& outcomes() { return outcomes_; }
    /// The hashes by frame, of the first variant that ran.
    [[nodiscard]] const std::vector<std::string>& hashes() const { return hashes_; }

  private:
    void render(Outcome& outcome) {
        log_progress(
            fmt::format("parity: {}: frames {} to {}: {}", label(), chunk_.first, chunk_.last, outcome.variant.label));
        const std::unique_ptr<Backend> backend = source_.make(outcome.variant.backend, outcome.variant.options);
        describe_backend(*backend, report_);
        outcome.exact = backend->capabilities().exact;
        RenderJob job{options_.size.width, options_.size.height, options_.samples, options_.seed, 0, tier_};
        BenchmarkRow& row = outcome.row;
        row.label = outcome.variant.label;
        row.scene = name_;
        row.backend = outcome.variant.backend;
        row.threads = outcome.variant.options.threads;
        row.tier = to_string(job.tier);
        row.samples = sample_count(job);
        const bool is_reference = reference_.empty();
        for (std::int32_t frame = chunk_.first; frame <= chunk_.last; ++frame) {
            job.frame = static_cast<std::uint32_t>(frame);
            TimedFrame timed = render_timed(*backend, scene_, job);
            record(row, frame, timed.stats.seconds.render, timed);
            outcome.pixels += timed.film.pixel_count();
            if (is_reference) {
                reference_.push_back(std::move(timed.film));
            } else {
                add(outcome, compare(reference_[static_cast<std::size_t>(frame - chunk_.first)], timed.film));
            }
        }
    }

    static void add(Outcome& outcome, const FilmDifference& difference) {
        outcome.differing_pixels += difference.differing_sums;
        outcome.largest = std::max(outcome.largest, difference.largest);
        for (std::size_t t = 0; t < tolerances.size(); ++t) {
            outcome.worst_rate[t] = std::max(outcome.worst_rate[t], difference.residual_rate(tolerances[t]));
        }
    }

    std::string name_;
    Tier tier_;
    Scene scene_;
    const ParityOptions& options_;
    const BackendSource& source_;
    Report& report_;
    std::vector<Outcome> outcomes_;
    FrameRange chunk_;
    std::vector<Film> reference_;
    std::vector<std::string> hashes_;
};

Table hash_table(const std::vector<std::string>& hashes, std::int32_t first_frame) {
    Table table{"SHA-256 of the films of the first variant", {{"Frame", true}, {"Film"}}, {}};
    for (std::size_t i = 0; i < hashes.size(); ++i) {
        table.rows.push_back({fmt::format("{}", first_frame + static_cast<std::int32_t>(i)), hashes[i]});
    }
    return table;
}

std::string verdict_of(const Outcome& outcome, bool is_reference) {
    if (!outcome.reason.empty()) return outcome.reason;
    if (is_reference) return "reference";
    if (outcome.differing_pixels == 0) return "equal bits";
    return outcome.exact ? "DIFFERS" : "differs, as allowed";
}

Table outcome_table(const std::vector<Outcome>& outcomes) {
    Table table{
        "Differing pixels over all frames; residual rate: share of pixels that differ by more than the tolerance, in "
        "the worst frame",
        {{"Variant"}, {"Verdict"}, {"Differing pixels", true}},
        {}};
    for (const Tolerance tolerance : tolerances) table.columns.push_back({to_string(tolerance), true});
    table.columns.push_back({"Largest difference", true});
    table.columns.push_back({"Render", true});
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        const Outcome& outcome = outcomes[i];
        std::vector<std::string> cells = {outcome.variant.label, verdict_of(outcome, i == 0)};
        if (!outcome.reason.empty()) {
            cells.insert(cells.end(), table.columns.size() - cells.size(), "");
        } else {
            cells.push_back(fmt::format("{} of {}", outcome.differing_pixels, outcome.pixels));
            for (const double rate : outcome.worst_rate) cells.push_back(format_share(rate));
            cells.push_back(format_number(outcome.largest));
            cells.push_back(format_summary(summarize(outcome.row.seconds)));
        }
        table.rows.push_back(std::move(cells));
    }
    return table;
}

/// True if all exact variants gave equal films.
bool report_parity(SceneParity& parity, const ParityOptions& options, Report& report) {
    const std::string name = parity.label();
    report.blocks.emplace_back(Heading{name});
    report.blocks.emplace_back(hash_table(parity.hashes(), options.frames.first));
    report.blocks.emplace_back(outcome_table(parity.outcomes()));
    for (std::size_t i = 0; i < parity.hashes().size(); ++i) {
        const auto frame = options.frames.first + static_cast<std::int32_t>(i);
        report.properties.emplace_back(fmt::format("film {}, frame {}", name, frame), parity.hashes()[i]);
    }
    std::size_t pixels = 0, variants = 0;
    std::string broken;
    for (Outcome& outcome : parity.outcomes()) {
        if (!outcome.reason.empty()) continue;
        if (outcome.exact) {
            pixels += outcome.pixels;
            ++variants;
            if (outcome.differing_pixels != 0) broken += (broken.empty() ? "" : "; ") + outcome.variant.label;
        }
        for (std::size_t t = 0; t < tolerances.size(); ++t) {
            outcome.row.errors.push_back(
                {parity.outcomes().front().variant.label, to_string(tolerances[t]), outcome.worst_rate[t]});
        }
        report.rows.push_back(std::move(outcome.row));
    }
    if (!broken.empty()) {
        report.blocks.emplace_back(Callout{Callout::Kind::bad, fmt::format("{}: the films differ: {}.", name, broken)});
        return false;
    }
    report.blocks.emplace_back(
        Callout{Callout::Kind::good, fmt::format("{}: {} variants, {} pixels, equal bits in all.", name, variants,
                                                 format_number(static_cast<double>(pixels)))});
    return true;
}

/// Throws InputError for a tier that does not guarantee equal bits.
std::vector<Tier> exact_tiers(const std::vector<std::string>& names) {
    std::vector<Tier> tiers = parse_tiers(names);
    if (std::find(tiers.begin(), tiers.end(), Tier::fast) != tiers.end()) {
        throw InputError("parity: the tier fast does not guarantee equal bits; use strict or precise");
    }
    return tiers;
}

}  // namespace

std::vector<ParityVariant> parity_variants(const std::vector<std::string>& backends,
                                           const std::vector<std::string>& instruction_sets) {
    std::vector<ParityVariant> variants;
    for (const std::string& backend : backends) {
        if (backend != "cpu") {
            variants.push_back({backend, backend, {}});
            continue;
        }
        for (const int threads : {1, 2, 7}) {
            variants.push_back(
                {fmt::format("cpu, {} thread{}", threads, threads == 1 ? "" : "s"), "cpu", {threads, 16, ""}});
        }
        for (const int tile : {8, 13})
            variants.push_back({fmt::format("cpu, tiles of {}", tile), "cpu", {0, tile, ""}});
        for (const std::string& set : instruction_sets) variants.push_back({"cpu, " + set, "cpu", {0, 16, set}});
    }
    return variants;
}

bool run_parity(const ParityOptions& options, const BackendSource& source, Report& report) {
    report.title = "Parity";
    report.summary = fmt::format(
        "Frames {} to {} at {} x {} with {} samples per pixel, rendered by every variant that must not change the "
        "image.",
        options.frames.first, options.frames.last, options.size.width, options.size.height, options.samples);
    const std::vector<Tier> tiers = exact_tiers(options.tiers);
    const std::vector<std::string> backends = available_backends(source, options.backends, report);
    const auto wanted = [](const std::vector<std::string>& list, const char* name) {
        return std::find(list.begin(), list.end(), name) != list.end();
    };
    if (wanted(options.backends, "cuda") && !wanted(backends, "cuda")) {
        report.blocks.emplace_back(
            Callout{Callout::Kind::note, "This run compares the CPU with itself only; it says nothing about a GPU."});
    }
    const std::vector<ParityVariant> variants = parity_variants(backends, cpu_instruction_sets());
    bool equal = true;
    for (const std::string& scene : options.scenes) {
        for (const Tier tier : tiers) {
            SceneParity parity(scene, tier, variants, options, source, report);
            parity.run();
            equal = report_parity(parity, options, report) && equal;
        }
    }
    report.properties.emplace_back("equal", equal ? "true" : "false");
    return equal;
}

}  // namespace tandem::bench
