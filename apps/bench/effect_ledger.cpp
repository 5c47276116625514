#include "effect_ledger.h"

#include <fmt/format.h>

#include <utility>

#include "frame_timing.h"
#include "output.h"
#include "pictures.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/compare.h"
#include "tandem/images/flip.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

constexpr int picture_width = 480;

/// Compares the film of each arm's first frame with that of the whole set, as soon as it is rendered.
class FirstFrames {
  public:
    FirstFrames(Ledger& ledger, const Display& display, bool with_pictures)
        : ledger_(ledger), display_(display), with_pictures_(with_pictures) {}

    void add(LedgerRow row, TimedFrame first) {
        row.hash = film_hash(first.film);
        row.compile = first.stats.seconds.compile;
        row.warning = first.stats.warning;
        phase(row.row, "first compile").seconds = {row.compile};
        FloatImage image = film_to_image(first.film);
        if (row.arm.kind == LedgerArm::Kind::whole) {
            whole_film_ = std::move(first.film);
            whole_image_ = std::move(image);
        } else {
            const FlipDifference difference = flip(whole_image_, image, {.display = display_});
            row.rmse = compare(whole_film_, first.film).rms;
            row.flip = difference.mean;
            row.row.figures = {{"RMSE", row.rmse}, {"mean FLIP", row.flip}};
            if (with_pictures_ && row.arm.effect) add_pictures(row, image, difference);
        }
        ledger_.rows.push_back(std::move(row));
    }

  private:
    void add_pictures(const LedgerRow& row, const FloatImage& image, const FlipDifference& difference) {
        const auto small = [](const FloatImage& of, const std::string& caption, const Display& display) {
            return small_picture(of, picture_width, caption, display);
        };
        ledger_.pictures.push_back(PictureGrid{
            {small(whole_image_, "The whole set", display_),
             small(image, fmt::format("{}: RMSE {}", row.arm.name(), format_number(row.rmse)), display_),
             small(flip_map(difference),
                   fmt::format("FLIP between the two: mean {}; black is 0, light is 1", format_number(row.flip)),
                   {TransferFunction::linear})}});
    }

    Ledger& ledger_;
    const Display& display_;
    bool with_pictures_;
    Film whole_film_;
    FloatImage whole_image_;
};

BenchmarkRow row_of(const Ledger& ledger, const LedgerArm& arm, const RenderJob& job, int threads) {
    BenchmarkRow row;
    row.label = fmt::format("{} {}, {}", ledger.backend, to_string(ledger.tier), arm.name());
    row.scene = ledger.scene;
    row.backend = ledger.backend;
    row.tier = to_string(ledger.tier);
    row.samples = sample_count(job);
    if (row.backend != "cuda") row.threads = threads;
    return row;
}

/// Compares each row with its baseline: the whole set, or, for one effect alone, no effects.
void add_factors(Ledger& ledger) {
    const BenchmarkRow& whole = ledger.rows.front().row;
    const BenchmarkRow* none = &whole;
    for (const LedgerRow& row : ledger.rows) {
        if (row.arm.kind == LedgerArm::Kind::none) none = &row.row;
    }
    for (LedgerRow& row : ledger.rows) {
        if (row.arm.kind == LedgerArm::Kind::whole) continue;
        row.row.factor = factor_over(row.arm.kind == LedgerArm::Kind::alone ? *none : whole, row.row);
    }
}

}  // namespace

ForcedEffects LedgerArm::forced() const {
    switch (kind) {
        case Kind::whole:
            return {};
        case Kind::carried:
            return {all_effects, {}};
        case Kind::without:
            return {{}, *effect};
        case Kind::none:
            return {{}, all_effects};
        case Kind::alone:
            return {{}, all_effects - *effect};
    }
    return {};
}

std::string LedgerArm::name() const {
    switch (kind) {
        case Kind::whole:
            return "whole";
        case Kind::carried:
            return "all effects carried";
        case Kind::without:
            return fmt::format("without {}", to_string(*effect));
        case Kind::none:
            return "none";
        case Kind::alone:
            return fmt::format("{} alone", to_string(*effect));
    }
    return {};
}

LedgerPlan plan_ledger(const Scene& scene) {
    using Kind = LedgerArm::Kind;
    LedgerPlan plan{derive_effects(scene, prepare(scene)), {{Kind::whole, {}}, {Kind::carried, {}}}, {}};
    if (plan.needs.empty()) return plan;
    for (const EffectNeed& need : plan.needs) plan.arms.push_back({Kind::without, need.effect});
    plan.arms.push_back({Kind::none, {}});
    for (const EffectNeed& need : plan.needs) {
        const LedgerArm alone{Kind::alone, need.effect};
        const bool stands = prepare(scene, {.effects = alone.forced()}).effects.has(need.effect);
        if (stands) {
            plan.arms.push_back(alone);
        } else {
            plan.dependent.push_back(need.effect);
        }
    }
    return plan;
}

Backend& LedgerBackends::of(LedgerArm::Kind kind) const {
    return kind == LedgerArm::Kind::carried && unspecialised ? *unspecialised : *exact;
}

std::vector<Ledger> measure_ledgers(const EffectsOptions& options, const std::string& name, const Scene& scene,
                                    const LedgerPlan& plan, const std::vector<LedgerBackends>& backends,
                                    const std::vector<Tier>& tiers) {
    struct Entry {
        Backend* backend;
        RenderJob job;
        std::size_t ledger, row;
    };
    std::vector<Ledger> ledgers;
    std::vector<Entry> entries;
    log_progress(fmt::format("{}: {} rounds of {} renders", name, options.repetitions,
                             plan.arms.size() * backends.size() * tiers.size()));
    for (const LedgerBackends& backend : backends) {
        for (const Tier tier : tiers) {
            const bool exact = backend.exact->capabilities().exact && tier != Tier::fast;
            Ledger& ledger = ledgers.emplace_back(Ledger{name, backend.name, tier, exact, {}, {}});
            const RenderJob job{options.size.width, options.size.height, options.samples, options.seed, 0, tier};
            FirstFrames first(ledger, scene.display, &backend == &backends.front());
            for (const LedgerArm& arm : plan.arms) {
                Backend& runs = backend.of(arm.kind);
                entries.push_back({&runs, job, ledgers.size() - 1, ledger.rows.size()});
                LedgerRow row{arm, row_of(ledger, arm, job, options.threads), {}, 0, 0, 0, {}};
                first.add(std::move(row), render_timed(runs, scene, job, arm.forced()));
            }
        }
    }
    for (int round = 0; round < options.repetitions; ++round) {
        for (const std::size_t i : interleaved_order(entries.size(), static_cast<std::size_t>(round))) {
            const Entry& entry = entries[i];
            LedgerRow& row = ledgers[entry.ledger].rows[entry.row];
            const TimedFrame timed = render_timed(*entry.backend, scene, entry.job, row.arm.forced());
            record(row.row, round, timed.stats.seconds.render, timed);
        }
    }
    for (Ledger& ledger : ledgers) add_factors(ledger);
    return ledgers;
}

}  // namespace tandem::bench
