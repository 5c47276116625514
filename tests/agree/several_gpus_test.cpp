// Several GPUs as one backend. A machine with one GPU is tested with two backends on it.
#include <gtest/gtest.h>

#include "support/compiled_tiers.h"
#include "support/effect_scenes.h"
#include "support/faulty_backend.h"
#include "support/input_error.h"
#include "support/thrown_message.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/film/plane_names.h"
#include "tandem/render/combined_backend.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using test::contains;
using test::Faults;

class SeveralGpus : public testing::Test {
  protected:
    void SetUp() override {
        if (!why_unavailable("cuda").empty()) GTEST_SKIP() << why_unavailable("cuda");
        job.width = 131;
        job.height = 117;
        job.samples = 3;
        job.planes = parse_planes("all");
    }
    /// Two backends, on different GPUs if there are several.
    static std::unique_ptr<Backend> pair(const std::vector<Faults>& faults = std::vector<Faults>(2)) {
        const std::size_t gpus = gpu_names().size();
        std::vector<CombinedMember> members;
        for (std::size_t i = 0; i < faults.size(); ++i) {
            BackendOptions options;
            const bool all = test::is_compiled(Tier::strict) && test::is_compiled(Tier::precise);
            options.specialise = all ? Specialise::never : Specialise::always;
            auto gpu = make_backend("cuda:" + std::to_string(i % gpus), options);
            members.push_back(
                {"GPU " + std::to_string(i), std::make_unique<test::FaultyBackend>(std::move(gpu), faults[i])});
        }
        return make_combined_backend(std::move(members), {.least_pixels = 1, .least_rays = 100, .least_seconds = 0});
    }
    void expect_bits_of_the_cpu(Backend& backend, const PreparedScene& scene, const std::string& name) {
        const auto cpu = make_backend("cpu");
        for (const Tier tier : {Tier::strict, Tier::precise}) {
            job.tier = tier;
            const Film expected = cpu->render(cpu->load(scene, tier), job).film;
            const Film film = backend.render(backend.load(scene, tier), job).film;
            EXPECT_EQ(film_hash(film), film_hash(expected)) << name << ", " << to_string(tier);
            for (const PlaneInfo& info : plane_infos()) {
                EXPECT_EQ(plane_hash(film, info.plane), plane_hash(expected, info.plane)) << name << ", " << info.name;
            }
        }
    }
    RenderJob job;
};

TEST_F(SeveralGpus, DrawTheBitsOfTheCpu) {
    const auto both = pair();
    for (const test::EffectScene& scene : test::effect_scenes()) {
        expect_bits_of_the_cpu(*both, prepare(scene.scene), scene.name);
    }
    expect_bits_of_the_cpu(*both, prepare(named_scene("paper")), "paper");
    expect_bits_of_the_cpu(*both, prepare(named_scene("mixed/3000")), "mixed");
    for (const FilmWindow& window :
         {FilmWindow{40, 3, 1, 110}, FilmWindow{7, 60, 100, 1}, FilmWindow{130, 116, 1, 1}}) {
        job.window = window;
        expect_bits_of_the_cpu(*both, prepare(named_scene("mixed/3000")), "window");
    }
}

TEST_F(SeveralGpus, TraceTheHitsOfTheCpu) {
    const PreparedScene scene = prepare(named_scene("mixed/3000"));
    std::vector<Ray<float>> rays;
    for (int i = 0; i < 5000; ++i) {
        const auto x = static_cast<float>(i), y = static_cast<float>(i % 997);
        rays.push_back({{0, 0, 3.2F}, {0.0001F * x - 0.25F, 0.0003F * y - 0.15F, -1}});
    }
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    const auto cpu = make_backend("cpu"), both = pair();
    (void)cpu->trace(*cpu->load(scene), rays, expected);
    (void)both->trace(*both->load(scene), rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(hits[i].primitive, expected[i].primitive) << i;
        ASSERT_EQ(hits[i].t, expected[i].t) << i;
    }
}

TEST_F(SeveralGpus, OneThatFailsIsSurvived) {
    const PreparedScene scene = prepare(named_scene("mixed/3000"));
    for (const Faults& faults : {Faults{.load = 1}, Faults{.submit = 1}, Faults{.submit = 4}, Faults{.get = 2}}) {
        for (const std::size_t bad : {std::size_t{0}, std::size_t{1}}) {
            std::vector<Faults> members(2);
            members[bad] = faults;
            test::wait_for_failure(members[1 - bad], members[bad]);
            const auto both = pair(members);
            expect_bits_of_the_cpu(*both, scene, "GPU " + std::to_string(bad) + " failed");
            EXPECT_EQ(both->capabilities().members[bad].failure, "the memory is full");
        }
    }
}

TEST_F(SeveralGpus, MissingOnesAreNamed) {
    const std::size_t gpus = gpu_names().size();
    const std::string missing = "cuda:" + std::to_string(gpus);
    const std::string message = test::thrown_message<EnvironmentError>([&] { (void)make_backend(missing); });
    EXPECT_TRUE(contains(message, "there is no GPU " + std::to_string(gpus)));
    EXPECT_TRUE(contains(message, gpu_names().front()));
    const auto all = make_backend("cuda:all");
    EXPECT_EQ(all->capabilities().members.size(), gpus > 1 ? gpus : 0);
    EXPECT_EQ(all->name(), "cuda");
}

}  // namespace
}  // namespace tandem
