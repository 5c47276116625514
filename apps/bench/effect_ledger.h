/// The cost ledger of effects: one scene, with and without each effect that it calls for, timed and compared.
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

/// A way to draw the scene. The first of a plan is `whole`, what the scene calls for and no more; the second `carried`.
struct LedgerArm {
    enum class Kind {
        whole,    ///< what the scene calls for
        carried,  ///< the same by a kernel with all effects: the picture is the same
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
    std::vector<EffectNeed> needs;  ///< what the scene calls for, and why
    std::vector<LedgerArm> arms;
    std::vector<Effect> dependent;  ///< do nothing without others, as absorption without refraction: have no `alone`
};

/// At frame 0. Leaves one out and adds one in for each effect that the scene calls for.
[[nodiscard]] LedgerPlan plan_ledger(const Scene& scene);

/// What became of an arm.
struct LedgerRow {
    LedgerArm arm;
    BenchmarkRow
        row;  ///< figures "RMSE" and "mean FLIP" against the whole set; phase "first compile" beside the others
    std::string hash;     ///< of the film
    double rmse = 0;      ///< of linear RGB, against the film of the whole set
    double flip = 0;      ///< mean, against the picture of the whole set
    double compile = 0;   ///< seconds, in the frame before the rounds; 0 if the kernel was there
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

/// A backend, and the same one told never to specialise.
struct LedgerBackends {
    std::string name;
    std::unique_ptr<Backend> exact;
    std::unique_ptr<Backend> unspecialised;  ///< none where that makes no difference
    [[nodiscard]] Backend& of(LedgerArm::Kind kind) const;
};

/// Times every arm on every backend in every tier, in rounds that go forth and back over all of them, after a frame
/// each from which hash and differences come.
[[nodiscard]] std::vector<Ledger> measure_ledgers(const EffectsOptions& options, const std::string& name,
                                                  const Scene& scene, const LedgerPlan& plan,
                                                  const std::vector<LedgerBackends>& backends,
                                                  const std::vector<Tier>& tiers);

}  // namespace tandem::bench
