/// What holds of the films of a job whatever its sampler and its filter.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/backend_list.h"
#include "support/effect_scenes.h"
#include "support/film_of_the_oracle.h"
#include "support/pixel_index.h"
#include "support/small_job.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/film/plane_names.h"
#include "tandem/images/compare.h"
#include "tandem/scene/named_scenes.h"

namespace tandem::test {

/// small_job() with something else.
struct VariedJob {
    std::string name;
    RenderJob job;
};

/// The lights of these are estimated in another way by the oracle.
inline constexpr EffectMask otherwise_in_the_oracle =
    Effect::area_lights | Effect::environment_light | Effect::indirect | Effect::microfacets;

class VariedJobs : public ExactBackend {
  protected:
    /// The films, whose bits are not those of small_job() unless the scene looks the same everywhere.
    void expect_bits_of_the_least_processor(const std::vector<VariedJob>& jobs) {
        const auto reference = make_backend("cpu", {.threads = 1, .instruction_set = "x86-64-v2"});
        const auto expect_equal = [&](const PreparedScene& scene, const std::string& name) {
            const auto ours = load(scene), theirs = reference->load(scene, GetParam().tier);
            const std::string plain = film_hash(backend_->render(ours, small_job(GetParam().tier)).film);
            for (VariedJob varied : jobs) {
                const std::string what = name + ", " + varied.name;
                varied.job.planes = parse_planes("albedo,normal,depth,primitive");
                const Film film = backend_->render(ours, varied.job).film;
                const Film expected = reference->render(theirs, varied.job).film;
                EXPECT_EQ(film_hash(film), film_hash(expected)) << what;
                EXPECT_EQ(plane_hash(film, FilmPlane::normal), plane_hash(expected, FilmPlane::normal)) << what;
                EXPECT_NE(film_hash(film), plain) << what;
            }
        };
        for (const EffectScene& entry : effect_scenes()) expect_equal(prepare(entry.scene), entry.name);
        for (const char* name : {"paper", "spheres/7", "mixed/500"}) expect_equal(prepare(named_scene(name)), name);
    }

    void expect_bits_of_the_whole_in_parts(const std::vector<VariedJob>& jobs) {
        const auto scene = load(prepare(named_scene("paper")));
        for (const auto& [name, whole] : jobs) {
            const Film all = backend_->render(scene, whole).film;
            RenderJob part = whole;
            part.window = FilmWindow{13, 9, 20, 31};
            const Film window = backend_->render(scene, part).film;
            for (int y = 0; y < 31; ++y) {
                for (int x = 0; x < 20; ++x) {
                    const Vec3d& a = window.sums()[pixel_index(x, y, 20)];
                    const Vec3d& b = all.sums()[pixel_index(x + 13, y + 9, 61)];
                    ASSERT_EQ(bits_of(a.x), bits_of(b.x)) << name << " " << x << ", " << y;
                }
            }
            RenderJob first = whole, second = whole;
            first.samples = 3;
            second.first_sample = 3;
            second.samples = 1;
            Film sum = backend_->render(scene, first).film;
            sum.add(backend_->render(scene, second).film);
            EXPECT_EQ(film_hash(sum), film_hash(all)) << name;
        }
    }

    void expect_films_near_the_oracle(const std::vector<VariedJob>& jobs) {
        const bool precise = GetParam().tier == Tier::precise;
        for (const EffectScene& entry : effect_scenes()) {
            if (entry.effects.has_any(otherwise_in_the_oracle)) continue;
            const PreparedScene scene = prepare(entry.scene);
            for (const auto& [name, job] : jobs) {
                const Film& expected = film_of_the_oracle(scene, name, job);
                const FilmDifference difference = compare(backend_->render(load(scene), job).film, expected);
                const std::string what = entry.name + ", " + name;
                EXPECT_LE(difference.residual_rate(Tolerance::one_level), precise ? 5e-4 : 1e-2) << what;
                EXPECT_LE(difference.mean, precise ? 1e-5 : 2e-4) << what;
            }
        }
    }
};

/// Kernels that are linked for a scene and its job draw what the CPU draws, in culled tiles too.
inline void expect_the_gpu_to_draw_what_the_cpu_draws(const PreparedScene& scene, const std::string& name,
                                                      const std::vector<VariedJob>& jobs) {
    const auto gpu = make_backend("cuda"), cpu = make_backend("cpu");
    for (VariedJob varied : jobs) {
        varied.job.samples = 9;  // so that tiles are culled
        const RenderResult ours = gpu->render(gpu->load(scene, varied.job.tier), varied.job);
        EXPECT_EQ(ours.stats.warning, "");
        EXPECT_EQ(film_hash(ours.film), film_hash(cpu->render(cpu->load(scene, varied.job.tier), varied.job).film))
            << name << ", " << varied.name << ", " << to_string(varied.job.tier);
    }
}
inline void expect_the_gpu_to_draw_what_the_cpu_draws(const std::vector<VariedJob>& jobs) {
    const std::vector<std::string> some = {"five blades",
                                           "mirrors",
                                           "glass",
                                           "lamps, indirect",
                                           "microfacets, lamps, indirect",
                                           "pictured lamps, indirect"};
    expect_the_gpu_to_draw_what_the_cpu_draws(prepare(named_scene("paper")), "paper", jobs);
    for (const EffectScene& entry : effect_scenes()) {
        if (std::find(some.begin(), some.end(), entry.name) == some.end()) continue;
        expect_the_gpu_to_draw_what_the_cpu_draws(prepare(entry.scene), entry.name, jobs);
    }
}

}  // namespace tandem::test
