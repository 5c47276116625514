#include "effects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "rate_plot.h"
#include "tandem/base/error.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/report/format_number.h"
#include "tiers.h"

namespace tandem::bench {

namespace {

using Kind = LedgerArm::Kind;

std::vector<LedgerBackends> make_backends(const EffectsOptions& options, const BackendSource& source, Report& report) {
    std::vector<LedgerBackends> backends;
    for (const std::string& name : available_backends(source, options.backends, report)) {
        LedgerBackends& made = backends.emplace_back();
        made.name = name;
        made.exact = source.make(name, {.threads = options.threads, .instruction_set = {}});
        describe_backend(*made.exact, report);
        if (name == "cuda") {
            made.unspecialised =
                source.make(name, {.threads = options.threads, .instruction_set = {}, .specialise = Specialise::never});
        }
    }
    if (backends.empty()) throw EnvironmentError("none of the requested backends can run on this machine");
    return backends;
}

Table needs_table(const LedgerPlan& plan) {
    Table table{"What the scene needs", {{"Effect"}, {"Reason"}, {"Adds"}}, {}};
    for (const EffectNeed& need : plan.needs) {
        const char* adds = effect_names()[static_cast<std::size_t>(need.effect)].adds;
        table.rows.push_back({to_string(need.effect), need.reason, adds});
    }
    return table;
}

std::string signed_seconds(double seconds) { return (seconds > 0 ? "+" : "") + format_seconds(seconds); }

/// `seconds` of the row against the baseline's, as two cells: difference and ratio of the medians.
std::vector<std::string> price_cells(const BenchmarkRow& slow, const BenchmarkRow& fast) {
    return {signed_seconds(median(slow.seconds) - median(fast.seconds)),
            format_ratio(ratio_of_medians(slow.seconds, fast.seconds))};
}

std::vector<std::string> cells_of(const LedgerRow& row, std::vector<std::string> price, EffectMask also_gone) {
    const BenchmarkRow& b = row.row;
    std::vector<std::string> cells = {row.arm.name(), format_summary(summarize(b.seconds))};
    cells.insert(cells.end(), price.begin(), price.end());
    const bool compared = row.arm.kind != Kind::whole;
    cells.insert(cells.end(),
                 {b.rays > 0 ? format_count(b.rays) : "", b.registers > 0 ? fmt::format("{}", b.registers) : "",
                  b.occupancy > 0 ? format_share(b.occupancy) : "", row.compile > 0 ? format_seconds(row.compile) : "",
                  compared ? format_number(row.rmse) : "", compared ? format_number(row.flip) : "",
                  also_gone.empty() ? "" : to_string(also_gone), b.variant});
    return cells;
}

Table empty_table(std::string caption, std::string difference, std::string ratio) {
    return {std::move(caption),
            {{"Effects"},
             {"Render", true},
             {std::move(difference), true},
             {std::move(ratio), true},
             {"Rays", true},
             {"Registers", true},
             {"Occupancy", true},
             {"Compile", true},
             {"RMSE", true},
             {"Mean FLIP", true},
             {"Also removed"},
             {"Code"}},
            {}};
}

std::string label(const Ledger& ledger) { return fmt::format("{} {}", ledger.backend, to_string(ledger.tier)); }

Table leave_one_out(const Ledger& ledger) {
    Table table = empty_table(
        fmt::format("{}: without one effect. RMSE and FLIP measure the change of the image, relative to the whole set",
                    label(ledger)),
        "Cost", "Whole over this");
    const LedgerRow& whole = ledger.rows.front();
    for (const LedgerRow& row : ledger.rows) {
        if (row.arm.kind == Kind::whole) {
            table.rows.push_back(cells_of(row, {"", ""}, {}));
        } else if (row.arm.kind == Kind::without) {
            const EffectMask also_gone = whole.row.effects - row.row.effects - *row.arm.effect;
            table.rows.push_back(cells_of(row, price_cells(whole.row, row.row), also_gone));
        }
    }
    return table;
}

Table add_one_in(const Ledger& ledger) {
    Table table =
        empty_table(fmt::format("{}: one effect alone. RMSE and FLIP are relative to the whole set", label(ledger)),
                    "Cost", "This over none");
    const LedgerRow* none = nullptr;
    for (const LedgerRow& row : ledger.rows) {
        if (row.arm.kind == Kind::none) {
            none = &row;
            table.rows.push_back(cells_of(row, {"", ""}, {}));
        } else if (row.arm.kind == Kind::alone) {
            table.rows.push_back(cells_of(row, price_cells(row.row, none->row), {}));
        }
    }
    return table;
}

/// Compares films that must be equal; reports each one that differs.
class BitCheck {
  public:
    explicit BitCheck(Report& report) : report_(report) {}

    void demand(const Ledger& a, const LedgerRow& row, const Ledger& b, const LedgerRow& other) {
        if (row.hash == other.hash) return;
        holds_ = false;
        report_.blocks.emplace_back(
            Callout{Callout::Kind::bad, fmt::format("{}: the films of {}, {} and {}, {} differ.", a.scene, label(a),
                                                    row.arm.name(), label(b), other.arm.name())});
    }
    [[nodiscard]] bool holds() const { return holds_; }

  private:
    Report& report_;
    bool holds_ = true;
};

/// The first of `ledgers` that must have the same bits as `ledger`; may be itself.
const Ledger& first_like(const Ledger& ledger, const std::vector<Ledger>& ledgers) {
    return *std::find_if(ledgers.begin(), ledgers.end(),
                         [&](const Ledger& one) { return one.promises_bits && one.tier == ledger.tier; });
}

/// False if films differ that must be equal; reports each of them.
bool bits_hold(const std::vector<Ledger>& ledgers, Report& report) {
    BitCheck check(report);
    std::string held;
    for (const Ledger& ledger : ledgers) {
        if (!ledger.promises_bits) continue;
        check.demand(ledger, ledger.rows[0], ledger, ledger.rows[1]);
        held += fmt::format(" {}: carrying all effects changes no bit.", label(ledger));
        const Ledger& first = first_like(ledger, ledgers);
        if (&first == &ledger) continue;
        for (std::size_t i = 0; i < ledger.rows.size(); ++i) check.demand(first, first.rows[i], ledger, ledger.rows[i]);
        held += fmt::format(" {} renders the same {} films as {}.", label(ledger), ledger.rows.size(), label(first));
    }
    if (check.holds() && !held.empty()) {
        report.blocks.emplace_back(Callout{Callout::Kind::good, ledgers.front().scene + ":" + held});
    }
    return check.holds();
}

Table price_table() {
    return {"The price of not specialising: the time of the kernel that carries all effects over that of the exact one",
            {{"Scene"},
             {"Backend and tier"},
             {"Exact", true},
             {"All effects", true},
             {"Price", true},
             {"Exact code"},
             {"Other code"}},
            {}};
}

void add_price(Ledger& ledger, Table& prices, Report& report) {
    const BenchmarkRow& exact = ledger.rows[0].row;
    BenchmarkRow& carried = ledger.rows[1].row;
    const Ratio price = ratio_of_medians(carried.seconds, exact.seconds);
    carried.figures.emplace_back("price of not specialising", price.value);
    prices.rows.push_back({ledger.scene, label(ledger), format_summary(summarize(exact.seconds)),
                           format_summary(summarize(carried.seconds)), format_ratio(price), exact.variant,
                           carried.variant});
    report.properties.emplace_back(fmt::format("price of not specialising {} {}", ledger.scene, label(ledger)),
                                   fmt::format("{}", price.value));
}

void add_ledger(Ledger& ledger, const LedgerPlan& plan, Report& report) {
    report.properties.emplace_back(fmt::format("film {} {}", ledger.scene, label(ledger)), ledger.rows.front().hash);
    if (!plan.needs.empty()) {
        report.blocks.emplace_back(leave_one_out(ledger));
        report.blocks.emplace_back(add_one_in(ledger));
    }
    std::vector<const BenchmarkRow*> rows;
    for (const LedgerRow& row : ledger.rows) {
        rows.push_back(&row.row);
        if (row.warning.empty()) continue;
        report.blocks.emplace_back(
            Callout{Callout::Kind::note, fmt::format("{}, {}: {}.", row.row.label, ledger.scene, row.warning)});
    }
    report.blocks.emplace_back(rate_plot(fmt::format("{}, {}: samples per second", ledger.scene, label(ledger)),
                                         "samples/s", rows, samples_per_second));
    for (PictureGrid& grid : ledger.pictures) report.blocks.emplace_back(std::move(grid));
}

bool ledger_of_scene(const EffectsOptions& options, const std::string& name, const std::vector<Tier>& tiers,
                     const std::vector<LedgerBackends>& backends, Table& prices, Report& report) {
    const Scene scene = load_scene(name, nullptr, {.aspect = aspect_of(options.size)});
    const LedgerPlan plan = plan_ledger(scene);
    std::vector<Ledger> ledgers = measure_ledgers(options, name, scene, plan, backends, tiers);
    report.blocks.emplace_back(Heading{name});
    if (plan.needs.empty()) {
        report.blocks.emplace_back(Paragraph{"The scene needs no effects: there is nothing to leave out."});
    } else {
        report.blocks.emplace_back(needs_table(plan));
    }
    for (const EffectNeed& need : plan.needs) {
        report.properties.emplace_back(fmt::format("reason {} {}", name, to_string(need.effect)), need.reason);
    }
    if (!plan.dependent.empty()) {
        std::vector<std::string> names;
        for (const Effect effect : plan.dependent) names.emplace_back(to_string(effect));
        report.blocks.emplace_back(Paragraph{
            fmt::format("Not shown alone, because it does nothing here without others: {}.", fmt::join(names, ", "))});
    }
    for (Ledger& ledger : ledgers) {
        add_price(ledger, prices, report);
        add_ledger(ledger, plan, report);
    }
    const bool hold = bits_hold(ledgers, report);
    for (Ledger& ledger : ledgers) {
        for (LedgerRow& row : ledger.rows) report.rows.push_back(std::move(row.row));
    }
    return hold;
}

}  // namespace

bool run_effects(const EffectsOptions& options, const BackendSource& source, Report& report) {
    if (options.scenes.empty()) {
        throw InputError("effects needs a scene: name glTF files, such as assets/scenes/glass.gltf, or named:NAME");
    }
    report.title = "Effects: what each costs and how it changes the image";
    report.summary = fmt::format(
        "Frame 0 at {} x {} with {} samples per pixel, with and without each effect that the scene needs; {} rounds "
        "in alternating order.",
        options.size.width, options.size.height, options.samples, options.repetitions);
    const std::vector<Tier> tiers = parse_tiers(options.tiers);
    const std::vector<LedgerBackends> backends = make_backends(options, source, report);
    Table prices = price_table();
    bool equal = true;
    for (const std::string& name : options.scenes) {
        equal = ledger_of_scene(options, name, tiers, backends, prices, report) && equal;
    }
    report.blocks.emplace_back(Heading{"The price of not specialising"});
    report.blocks.emplace_back(std::move(prices));
    report.properties.emplace_back("equal", equal ? "true" : "false");
    return equal;
}

}  // namespace tandem::bench
