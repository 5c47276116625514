// Every sampler draws equal bits everywhere, whatever part of a film is drawn; the same image; near the oracle's.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/backend_list.h"
#include "support/effect_scenes.h"
#include "support/estimate.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepare.h"
#include "tandem/film/plane_names.h"
#include "tandem/images/compare.h"
#include "tandem/render/sampler_names.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using test::effect_scenes;
using test::EffectScene;
using test::Estimate;

RenderJob small_job(Sampler sampler, Tier tier = Tier::strict) {
    RenderJob job;
    job.sampler = sampler;
    job.tier = tier;
    job.width = 61;
    job.height = 43;
    job.samples = 4;
    job.seed = 3;
    return job;
}

std::vector<Sampler> low_discrepancy() {
    std::vector<Sampler> list;
    for (const SamplerInfo& info : sampler_infos()) {
        if (info.sampler != Sampler::random) list.push_back(info.sampler);
    }
    return list;
}

std::unique_ptr<Backend> least_processor() {
    BackendOptions least;
    least.instruction_set = "x86-64-v2";
    least.threads = 1;
    return make_backend("cpu", least);
}

class SamplerBits : public test::ExactBackend {
  protected:
    [[nodiscard]] static RenderJob job(Sampler sampler) { return small_job(sampler, GetParam().tier); }
};

TEST_P(SamplerBits, AreThoseOfTheLeastProcessor) {
    const auto reference = least_processor();
    const auto expect_equal = [&](const PreparedScene& scene, const std::string& name) {
        for (const Sampler sampler : low_discrepancy()) {
            RenderJob planes = job(sampler);
            planes.planes = parse_planes("albedo,normal,depth,primitive");
            const Film ours = backend_->render(load(scene), planes).film;
            const Film theirs = reference->render(reference->load(scene, GetParam().tier), planes).film;
            const std::string what = name + ", " + to_string(sampler);
            EXPECT_EQ(film_hash(ours), film_hash(theirs)) << what;
            EXPECT_EQ(plane_hash(ours, FilmPlane::normal), plane_hash(theirs, FilmPlane::normal)) << what;
            RenderJob random = planes;
            random.sampler = Sampler::random;
            EXPECT_NE(film_hash(backend_->render(load(scene), random).film), film_hash(ours)) << what;
        }
    };
    for (const EffectScene& entry : effect_scenes()) expect_equal(prepare(entry.scene), entry.name);
    for (const char* name : {"paper", "spheres/7", "mixed/500"}) expect_equal(prepare(named_scene(name)), name);
}

TEST_P(SamplerBits, OfWindowsAndPartsOfSamplesAreThoseOfTheWhole) {
    const auto scene = load(prepare(named_scene("paper")));
    for (const Sampler sampler : low_discrepancy()) {
        RenderJob whole = job(sampler);
        const Film all = backend_->render(scene, whole).film;
        RenderJob part = whole;
        part.window = FilmWindow{13, 9, 20, 31};
        const Film window = backend_->render(scene, part).film;
        for (int y = 0; y < 31; ++y) {
            for (int x = 0; x < 20; ++x) {
                const Vec3d& a = window.sums()[static_cast<std::size_t>(y * 20 + x)];
                const Vec3d& b = all.sums()[static_cast<std::size_t>((y + 9) * 61 + x + 13)];
                ASSERT_EQ(bits_of(a.x), bits_of(b.x)) << to_string(sampler) << " " << x << ", " << y;
            }
        }
        RenderJob first = whole, second = whole;
        first.samples = 3;
        second.first_sample = 3;
        second.samples = 1;
        Film sum = backend_->render(scene, first).film;
        sum.add(backend_->render(scene, second).film);
        EXPECT_EQ(film_hash(sum), film_hash(all)) << to_string(sampler);
    }
}

TEST_P(SamplerBits, AreNearTheOracle) {
    const auto oracle = make_backend("oracle");
    const bool precise = GetParam().tier == Tier::precise;
    for (const EffectScene& entry : effect_scenes()) {
        if (entry.effects.has_any(Effect::area_lights | Effect::environment_light | Effect::indirect |
                                  Effect::microfacets)) {
            continue;  // the oracle estimates these in another way
        }
        const PreparedScene scene = prepare(entry.scene);
        for (const Sampler sampler : low_discrepancy()) {
            const Film expected = oracle->render(oracle->load(scene, GetParam().tier), job(sampler)).film;
            const FilmDifference difference = compare(backend_->render(load(scene), job(sampler)).film, expected);
            EXPECT_LE(difference.residual_rate(Tolerance::one_level), precise ? 5e-4 : 1e-2) << entry.name;
            EXPECT_LE(difference.mean, precise ? 1e-5 : 2e-4) << entry.name;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, SamplerBits, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

/// The mean of a film over pixels and channels.
double mean_of(const Film& film) {
    double sum = 0;
    for (const Vec3d& c : film.sums()) sum += c.x + c.y + c.z;
    return sum / (3.0 * film.samples() * static_cast<double>(film.pixel_count()));
}

/// Means over seeds of the film's mean, and of a pixel's squared distance from its mean over seeds.
struct Seen {
    Estimate mean;
    double noise = 0;
};
Seen look(Backend& backend, const PreparedScene& scene, Sampler sampler, int samples, std::uint64_t first_seed) {
    constexpr int films = 16;
    const auto resident = backend.load(scene, Tier::strict);
    RenderJob job = small_job(sampler);
    job.samples = samples;
    Seen seen;
    std::vector<Estimate> pixels(61 * 43);
    for (int i = 0; i < films; ++i) {
        job.seed = first_seed + static_cast<std::uint64_t>(i);
        const Film film = backend.render(resident, job).film;
        seen.mean.add(mean_of(film));
        for (std::size_t p = 0; p < pixels.size(); ++p) pixels[p].add(film.sums()[p].y / samples);
    }
    for (const Estimate& pixel : pixels)
        seen.noise += pixel.variance_of_mean() * films / static_cast<double>(pixels.size());
    return seen;
}

// No sampler has a bias. Over all scenes, Sobol's has less noise; in none has it notably more.
TEST(SamplerMeans, AreThoseOfIndependentNumbersWithLessNoise) {
    const auto cpu = make_backend("cpu");
    double logarithms = 0, scenes = 0;
    for (const EffectScene& entry : effect_scenes()) {
        const PreparedScene scene = prepare(entry.scene);
        const Seen random = look(*cpu, scene, Sampler::random, 16, 1000);
        for (const Sampler sampler : low_discrepancy()) {
            const Seen seen = look(*cpu, scene, sampler, 16, 5000);
            const double off = std::abs(seen.mean.mean() - random.mean.mean());
            const double error = std::sqrt(seen.mean.variance_of_mean() + random.mean.variance_of_mean());
            EXPECT_LE(off, 6 * error + 1e-9) << entry.name << ", " << to_string(sampler);
            EXPECT_LE(seen.noise, 1.25 * random.noise + 1e-12) << entry.name << ", " << to_string(sampler);
            if (random.noise < 1e-9) continue;
            logarithms += std::log(seen.noise / random.noise);
            scenes += 1;
        }
    }
    EXPECT_LT(std::exp(logarithms / scenes), 0.6) << "of the variance of random";
}

// Kernels that are linked for a scene and its sampler.
TEST(SamplersOnTheGpu, DrawWhatTheCpuDraws) {
    if (!why_unavailable("cuda").empty()) GTEST_SKIP() << why_unavailable("cuda");
    const auto gpu = make_backend("cuda");
    const auto cpu = make_backend("cpu");
    const auto expect_equal = [&](const PreparedScene& scene, const std::string& name, Tier tier) {
        for (const SamplerInfo& info : sampler_infos()) {
            RenderJob job = small_job(info.sampler, tier);
            job.samples = 9;  // so that tiles are culled
            const RenderResult ours = gpu->render(gpu->load(scene, tier), job);
            EXPECT_EQ(ours.stats.warning, "");
            EXPECT_EQ(film_hash(ours.film), film_hash(cpu->render(cpu->load(scene, tier), job).film))
                << name << ", " << info.name << ", " << to_string(tier);
        }
    };
    const std::vector<std::string> some = {"five blades",
                                           "mirrors",
                                           "glass",
                                           "lamps, indirect",
                                           "microfacets, lamps, indirect",
                                           "pictured lamps, indirect"};
    for (const Tier tier : {Tier::strict, Tier::precise}) {
        expect_equal(prepare(named_scene("paper")), "paper", tier);
        for (const EffectScene& entry : effect_scenes()) {
            if (std::find(some.begin(), some.end(), entry.name) != some.end()) {
                expect_equal(prepare(entry.scene), entry.name, tier);
            }
        }
    }
}

}  // namespace
}  // namespace tandem
