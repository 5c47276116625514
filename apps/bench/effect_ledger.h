/// The cost ledger of effects: one scene, with and without each effect that it needs, timed and compared.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "backend_source.h"
#include "common/arguments.h"
#include "tandem/compile/derive.h"
#include "tandem/effects/names.h"
#include "tandem/report/report.h"

namespace tandem::bench {

struct EffectsOptions {
    std::vector<std::string> scenes;  ///< at least one
    std::vector<std::string> backends = {"cpu", "cuda"};
    std::vector<std::string> tiers = {"strict"};
    FilmSize size{256, 230};
    int samples = 16;
    std::uint64_t seed = 0;
    int threads = 0;  ///< of the CPU; 0 means one per core
    int repetitions = 7;
};

/// A way to render the scene. The first of a plan is `whole`, exactly what the scene needs; the second is `carried`.
struct LedgerArm {
    enum class Kind {
        whole,    ///< the effects that the scene needs
        carried,  ///< the same, by a kernel that carries all effects: the image is the same
        without,  ///< one effect forced off
        none,     ///< all forced off
        alone,    ///< all but one forced off
    };
    Kind kind = Kind::whole;
    std::optional<Effect> effect;  ///< of `without` and `alone`
    [[nodiscard]] ForcedEffects forced() const;
    [[nodiscard]] std::string name() const;  ///< "whole", "all effects carried", "without lens", "none", "lens alone"
};

struct LedgerPlan {
    std::vector<EffectNeed> needs;  ///< the effects that the scene needs, and why
    std::vector<LedgerArm> arms;
    std::vector<Effect> dependent;  ///< do nothing without others, as absorption without refraction: no `alone`
};

/// The arms for frame 0: without, and with only, each effect that the scene needs.
[[nodiscard]] LedgerPlan plan_ledger(const Scene& scene);

/// The result of an arm.
struct LedgerRow {
    LedgerArm arm;
    BenchmarkRow
        row;  ///< figures "RMSE" and "mean FLIP" against the whole set; phase "first compile" beside the others
    std::string hash;     ///< of the film
    double rmse = 0;      ///< of linear RGB, against the film of the whole set
    double flip = 0;      ///< mean, against the image of the whole set
    double compile = 0;   ///< seconds, in the frame before the rounds; 0 if the kernel was cached
    std::string warning;  ///< of the backend
};

/// All arms of a scene on one backend in one tier.
struct Ledger {
    std::string scene;
    std::string backend;
    Tier tier = Tier::strict;
    bool promises_bits = true;  ///< the backend is exact and the tier is not fast
    std::vector<LedgerRow> rows;
    std::vector<PictureGrid> pictures;  ///< whole, without an effect, and FLIP between them; of the first backend only
};

/// A backend, and another of its kind that never specialises.
struct LedgerBackends {
    std::string name;
    std::unique_ptr<Backend> exact;
    std::unique_ptr<Backend> unspecialised;  ///< null where that makes no difference
    [[nodiscard]] Backend& of(LedgerArm::Kind kind) const;
};

/// Times every arm on every backend in every tier, in rounds of alternating order. Before them each arm renders one
/// frame, for its hash and its differences.
[[nodiscard]] std::vector<Ledger> measure_ledgers(const EffectsOptions& options, const std::string& name,
                                                  const Scene& scene, const LedgerPlan& plan,
                                                  const std::vector<LedgerBackends>& backends,
                                                  const std::vector<Tier>& tiers);

}  // namespace tandem::bench
