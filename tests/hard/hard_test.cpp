// Every hard case on every backend and tier, against tests/hard/corpus/error_bounds.def: for example
// Hard/HardCase.KeepsItsErrorBound/A1_cpu_strict.
#include <gtest/gtest.h>

#include <set>

#include "hard/corpus/error_bounds.h"
#include "hard/corpus/hard_case.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepare.h"

namespace tandem::hard {
namespace {

constexpr std::size_t rays_per_case = 5000;

constexpr Tier tiers[] = {
#define TANDEM_TIER(name, promise) Tier::name,
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
};

struct Trial {
    const HardCase* hard_case;
    std::string backend;  ///< "host" for functions
    Tier tier;
};

std::vector<Trial> all_trials() {
    std::vector<Trial> trials;
    for (const HardCase& hard_case : corpus()) {
        for (const Tier tier : tiers) {
            if (find_error_bound(hard_case.id, tier) == nullptr) continue;
            for (const char* backend : {"cpu", "cuda"}) {
                if (!hard_case.on_host()) trials.push_back({&hard_case, backend, tier});
            }
            if (hard_case.on_host()) trials.push_back({&hard_case, "host", tier});
        }
    }
    return trials;
}

std::string name_of(const Trial& trial) {
    return trial.hard_case->id + "_" + trial.backend + "_" + to_string(trial.tier);
}

void PrintTo(const Trial& trial, std::ostream* out) { *out << trial.hard_case->title; }

class HardCase : public testing::TestWithParam<Trial> {};

TEST_P(HardCase, KeepsItsErrorBound) {
    const auto& [hard_case, backend_name, tier] = GetParam();
    Score score;
    if (hard_case->on_host()) {
        score = try_functions(*hard_case, tier, rays_per_case);
    } else {
        const std::string reason = why_unavailable(backend_name);
        if (!reason.empty()) GTEST_SKIP() << backend_name << ": " << reason;
        const auto backend = make_backend(backend_name);
        const auto another = [name = backend_name](const BackendOptions& options) {
            return make_backend(name, options);
        };
        score = hard_case->has_rays()
                    ? try_rays(*hard_case, answered_batches(*hard_case, rays_per_case), *backend, tier)
                    : try_pictures(*hard_case, {backend_name, tier, *backend, another}, rays_per_case);
    }
#if defined(TANDEM_ONE_INSTRUCTION_SET)
    // Nothing is contracted across calls that are not inlined, so the errors of fast differ from the measured bounds.
    if (tier == Tier::fast) GTEST_SKIP() << "ran for the sanitizer only; the bounds are those of an optimised build";
#endif
    const ErrorBound& bound = *find_error_bound(hard_case->id, tier);
    const auto tried = static_cast<double>(score.tried);
    EXPECT_GT(score.tried, 0U);
    EXPECT_LE(score.unjudged, score.tried / 10) << "too few of the generated rays can be judged";
    EXPECT_LE(static_cast<double>(score.wrong), bound.wrong * tried)
        << hard_case->title << "; of " << score.tried << "; the first: " << score.first_failure;
    EXPECT_LE(static_cast<double>(score.leaks), bound.leaks * tried) << score.first_failure;
    EXPECT_LE(score.worst_ulps(), bound.ulps) << score.worst_description();
    EXPECT_EQ(score.nans, 0U);
}

INSTANTIATE_TEST_SUITE_P(Hard, HardCase, testing::ValuesIn(all_trials()),
                         [](const testing::TestParamInfo<Trial>& info) { return name_of(info.param); });

TEST(Corpus, NamesEachCaseOnceAndBoundsAll) {
    std::set<std::string> ids;
    for (const auto& hard_case : corpus()) {
        EXPECT_TRUE(ids.insert(hard_case.id).second) << hard_case.id;
        EXPECT_NE(find_error_bound(hard_case.id, Tier::strict), nullptr) << hard_case.id << " has no error bound";
        for (const std::string& text : {hard_case.title, hard_case.why, hard_case.oracle}) {
            EXPECT_FALSE(text.empty()) << hard_case.id;
        }
    }
    for (const ErrorBound& bound : error_bounds())
        EXPECT_TRUE(ids.contains(std::string(bound.case_id))) << bound.case_id;
    EXPECT_GE(ids.size(), 70U);
}

TEST(Corpus, MakesTheSameRaysEveryTime) {
    for (const char* id : {"A4", "B12", "D2"}) {
        const auto& hard_case = *select_cases({id}).front();
        const auto first = answered_batches(hard_case, 200), second = answered_batches(hard_case, 200);
        ASSERT_EQ(first.size(), second.size());
        for (std::size_t batch = 0; batch < first.size(); ++batch) {
            EXPECT_EQ(scene_hash(first[batch].prepared), scene_hash(second[batch].prepared));
            ASSERT_EQ(first[batch].rays.size(), second[batch].rays.size());
            for (std::size_t i = 0; i < first[batch].rays.size(); ++i) {
                EXPECT_EQ(to_literal(first[batch].rays[i]), to_literal(second[batch].rays[i]));
            }
        }
    }
}

}  // namespace
}  // namespace tandem::hard
