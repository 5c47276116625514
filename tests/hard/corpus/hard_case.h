/// A hard case: what it is, why naive code fails, and how it is run. docs/hard-corpus.md lists the cases with their
/// sources, tests/hard/corpus/error_bounds.def their error bounds.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "hard/corpus/score.h"
#include "support/random.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/render/backend.h"
#include "tandem/scene/scene.h"

namespace tandem::hard {

using test::Random;

/// Rays against one scene.
struct RayBatch {
    Scene scene;
    std::vector<Ray<float>> rays;
};

/// Rays whose answers exact arithmetic knows (answer.h).
struct RayCase {
    std::function<std::vector<RayBatch>(Random& random, std::size_t rays)> make;
    bool watertight = false;  ///< a miss where something is hit is a leak
};

/// Kernel functions, or host-side rules. They run on the host, on single rays and on packets. A GPU runs the same
/// source; the films of group L compare it. Functions that do not depend on the tier run as in strict.
struct FunctionCase {
    std::function<Score(Random& random, std::size_t calls, Tier tier)> run;

    FunctionCase(Score (*of_strict)(Random&, std::size_t))
        : run([of_strict](Random& random, std::size_t calls, Tier) { return of_strict(random, calls); }) {}
    FunctionCase(Score (*of_tier)(Random&, std::size_t, Tier)) : run(of_tier) {}
};

/// The backend and tier under test.
struct Subject {
    std::string name;
    Tier tier;
    Backend& backend;
    std::function<std::unique_ptr<Backend>(const BackendOptions& options)> make;  ///< another one of the same kind
};

/// Whole images and traces: transformations that must not change them, closed forms, backends compared.
struct RenderCase {
    std::function<Score(const Subject& subject, Random& random, std::size_t rays)> run;
};

struct HardCase {
    std::string id;      ///< letter of the group, number
    std::string title;   ///< what is tested
    std::string why;     ///< why naive code fails
    std::string oracle;  ///< the source of the correct answer
    std::variant<RayCase, FunctionCase, RenderCase> body;

    [[nodiscard]] bool has_rays() const { return std::holds_alternative<RayCase>(body); }
    [[nodiscard]] bool on_host() const { return std::holds_alternative<FunctionCase>(body); }
};

/// All cases, by group and number.
[[nodiscard]] const std::vector<HardCase>& corpus();

/// The cases that match one of the patterns, such as "A1", or "B*" for a group; all cases if there are no patterns.
/// Throws InputError for a pattern that matches nothing.
[[nodiscard]] std::vector<const HardCase*> select_cases(const std::vector<std::string>& patterns);

/// Rays of a ray case with their exact answers; made once for all backends and tiers.
struct AnsweredBatch {
    Scene scene;
    PreparedScene prepared;
    std::vector<Ray<float>> rays;
    std::vector<Answer> answers;
};
[[nodiscard]] std::vector<AnsweredBatch> answered_batches(const HardCase& hard_case, std::size_t rays);

/// Runs a ray case; `batches` come from answered_batches().
[[nodiscard]] Score try_rays(const HardCase& hard_case, const std::vector<AnsweredBatch>& batches, Backend& backend,
                             Tier tier);
/// Runs a case without a backend, or with one.
[[nodiscard]] Score try_functions(const HardCase& hard_case, Tier tier, std::size_t calls);
[[nodiscard]] Score try_pictures(const HardCase& hard_case, const Subject& subject, std::size_t rays);

}  // namespace tandem::hard
