// Kernels linked for a scene render the same as the CPU and the kernel with all effects.

#include <gtest/gtest.h>

#include "support/compiled_tiers.h"
#include "support/effect_scenes.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/effects/names.h"

namespace tandem {
namespace {

struct Case {
    std::size_t scene;  ///< in test::effect_scenes()
    Tier tier;
};
void PrintTo(const Case& c, std::ostream* out) {
    *out << test::effect_scenes()[c.scene].name << " " << to_string(c.tier);
}

std::vector<Case> cases() {
    std::vector<Case> list;
    for (const Tier tier : {Tier::strict, Tier::precise}) {
        for (std::size_t i = 0; i < test::effect_scenes().size(); ++i) list.push_back({i, tier});
    }
    return list;
}

std::string case_name(const ::testing::TestParamInfo<Case>& info) {
    std::string name = test::effect_scenes()[info.param.scene].name + "_" + to_string(info.param.tier);
    for (char& c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    }
    return name;
}

class SpecialisedKernel : public ::testing::TestWithParam<Case> {
  protected:
    void SetUp() override {
        if (!why_unavailable("cuda").empty()) GTEST_SKIP() << why_unavailable("cuda");
    }
    [[nodiscard]] static RenderResult render(const std::string& backend, Specialise specialise, EffectMask more = {}) {
        RenderJob job;
        job.width = 61;
        job.height = 43;
        job.samples = 4;
        job.seed = 3;
        job.tier = GetParam().tier;
        BackendOptions options;
        options.specialise = specialise;
        const auto renderer = make_backend(backend, options);
        PrepareOptions prepare_options;
        prepare_options.effects = {more, {}};
        const Scene& scene = test::effect_scenes()[GetParam().scene].scene;
        return renderer->render(renderer->load(prepare(scene, prepare_options), job.tier), job);
    }
};

TEST_P(SpecialisedKernel, DrawsWhatTheOthersDraw) {
    const RenderResult exact = render("cuda", Specialise::always);
    EXPECT_EQ(exact.stats.warning, "");
    EXPECT_TRUE(exact.stats.carried.empty());
    EXPECT_EQ(exact.stats.counters, RenderCounters{});
    const RenderResult on_cpu = render("cpu", Specialise::never);
    EXPECT_EQ(exact.stats.rays, on_cpu.stats.rays);
    const std::string expected = film_hash(on_cpu.film);
    EXPECT_EQ(film_hash(exact.film), expected);
    if (test::is_compiled(GetParam().tier)) {
        const RenderResult compiled = render("cuda", Specialise::never);
        EXPECT_EQ(film_hash(compiled.film), expected) << compiled.stats.variant;
        EXPECT_EQ(film_hash(render("cuda", Specialise::never, all_effects).film), expected) << "with all effects";
    }
    const EffectMask more = Effect::reflection | Effect::shadows;
    EXPECT_EQ(film_hash(render("cuda", Specialise::always, more).film), expected) << "with more effects";
}

INSTANTIATE_TEST_SUITE_P(Scenes, SpecialisedKernel, ::testing::ValuesIn(cases()), case_name);

}  // namespace
}  // namespace tandem
