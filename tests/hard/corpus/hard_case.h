/// A hard case: what it is, why naive code fails, and how it is tried. The catalogue with its sources is
/// docs/hard-corpus.md; the marks are tests/hard/corpus/marks.def.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "hard/corpus/score.h"
#include "support/random.h"
#include "tandem/render/backend.h"
#include "tandem/scene/scene.h"

namespace tandem::hard {

using test::Random;

/// Rays against one scene.
struct Lot {
    Scene scene;
    std::vector<Ray<float>> rays;
};

/// Rays whose answers exact arithmetic knows (answer.h).
struct RayCase {
    std::function<std::vector<Lot>(Random& random, std::size_t rays)> make;
    bool watertight = false;  ///< every miss of what is there lets light through
};

/// Functions of the kernel side, or rules of the host. Tried on the host: on one ray and on packets. A GPU runs the
/// same source, which the films of group L compare. Those that do not look at the tier are tried as strict has them.
struct FunctionCase {
    std::function<Score(Random& random, std::size_t calls, Tier tier)> run;

    FunctionCase(Score (*of_strict)(Random&, std::size_t))
        : run([of_strict](Random& random, std::size_t calls, Tier) { return of_strict(random, calls); }) {}
    FunctionCase(Score (*of_tier)(Random&, std::size_t, Tier)) : run(of_tier) {}
};

/// What a render case may use.
struct Subject {
    std::string name;
    Tier tier;
    Backend& backend;
    std::function<std::unique_ptr<Backend>(const BackendOptions& options)> make;  ///< another one of the same kind
};

/// Whole pictures and traces: transformations that must not change them, closed forms, backends against each other.
struct RenderCase {
    std::function<Score(const Subject& subject, Random& random, std::size_t rays)> run;
};

struct HardCase {
    std::string id;      ///< letter of the group, number
    std::string title;   ///< what is tried
    std::string why;     ///< why naive code fails
    std::string oracle;  ///< where the right answer comes from
    std::variant<RayCase, FunctionCase, RenderCase> body;

    [[nodiscard]] bool has_rays() const { return std::holds_alternative<RayCase>(body); }
    [[nodiscard]] bool on_host() const { return std::holds_alternative<FunctionCase>(body); }
};

/// All cases, by group and number.
[[nodiscard]] const std::vector<HardCase>& corpus();

/// The cases that one of the patterns names: "A1", or "B*" for a group; all if there are none. Throws InputError for a
/// pattern that names nothing.
[[nodiscard]] std::vector<const HardCase*> select_cases(const std::vector<std::string>& patterns);

/// The rays of a ray case with their answers; made once, tried by every backend and tier.
struct AnsweredLot {
    Scene scene;
    PreparedScene prepared;
    std::vector<Ray<float>> rays;
    std::vector<Answer> answers;
};
[[nodiscard]] std::vector<AnsweredLot> answered_lots(const HardCase& hard_case, std::size_t rays);

/// Tries a ray case; `lots` are those of answered_lots().
[[nodiscard]] Score try_rays(const HardCase& hard_case, const std::vector<AnsweredLot>& lots, Backend& backend,
                             Tier tier);
/// Tries a case without a backend, or with one.
[[nodiscard]] Score try_functions(const HardCase& hard_case, Tier tier, std::size_t calls);
[[nodiscard]] Score try_pictures(const HardCase& hard_case, const Subject& subject, std::size_t rays);

}  // namespace tandem::hard
