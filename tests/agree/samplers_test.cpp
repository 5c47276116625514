// Every sampler draws equal bits everywhere, whatever part of a film is drawn; the same image; near the oracle's.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "agree/varied_jobs.h"
#include "support/estimate.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/render/sampler_names.h"

namespace tandem {
namespace {

using test::effect_scenes;
using test::EffectScene;
using test::Estimate;
using test::VariedJob;

std::vector<Sampler> low_discrepancy() {
    std::vector<Sampler> list;
    for (const SamplerInfo& info : sampler_infos()) {
        if (info.sampler != Sampler::random) list.push_back(info.sampler);
    }
    return list;
}

RenderJob job_with(Sampler sampler, Tier tier) {
    RenderJob job = test::small_job(tier);
    job.sampler = sampler;
    return job;
}

/// One for each sampler.
std::vector<VariedJob> jobs_with(const std::vector<Sampler>& samplers, Tier tier) {
    std::vector<VariedJob> jobs;
    jobs.reserve(samplers.size());
    for (const Sampler sampler : samplers) jobs.push_back({to_string(sampler), job_with(sampler, tier)});
    return jobs;
}

class SamplerBits : public test::VariedJobs {
  protected:
    [[nodiscard]] static std::vector<VariedJob> jobs() { return jobs_with(low_discrepancy(), GetParam().tier); }
};

TEST_P(SamplerBits, AreThoseOfTheLeastProcessor) { expect_bits_of_the_least_processor(jobs()); }
TEST_P(SamplerBits, OfWindowsAndPartsOfSamplesAreThoseOfTheWhole) { expect_bits_of_the_whole_in_parts(jobs()); }
TEST_P(SamplerBits, AreNearTheOracle) { expect_films_near_the_oracle(jobs()); }

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
    RenderJob job = job_with(sampler, Tier::strict);
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
    std::vector<Sampler> all = low_discrepancy();
    all.push_back(Sampler::random);
    for (const Tier tier : {Tier::strict, Tier::precise}) {
        test::expect_the_gpu_to_draw_what_the_cpu_draws(jobs_with(all, tier));
    }
}

}  // namespace
}  // namespace tandem
