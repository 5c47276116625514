// Every filter of the picture draws equal bits everywhere; near the oracle's film; and what it draws is the scene's
// image, convolved with the filter's definition.
#include <gtest/gtest.h>

#include <cmath>

#include "agree/varied_jobs.h"
#include "support/filter_forms.h"
#include "support/pixel_index.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/render/pixel_filter_names.h"

namespace tandem {
namespace {

using test::VariedJob;

/// One for each filter but box, and one with another sampler too.
std::vector<VariedJob> jobs_with_filters(Tier tier) {
    std::vector<VariedJob> jobs;
    for (const PixelFilterInfo& info : pixel_filter_infos()) {
        if (info.filter == PixelFilter::box) continue;
        jobs.push_back({info.name, test::small_job(tier)});
        jobs.back().job.filter = info.filter;
    }
    jobs.push_back(jobs.back());
    jobs.back().name += " with sobol";
    jobs.back().job.sampler = Sampler::sobol;
    return jobs;
}

/// Solids that end next to the borders of tiles of 8 x 4 pixels (cuda/block_shape.h) of a film of 61 x 43, on both
/// sides of them and within the reach of filters. Few, and without effects: so a GPU culls them per tile.
Scene at_the_borders_of_tiles() {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[0].phong = {{0.3F, 0.2F, 0.1F}, {0.5F, 0.6F, 0.7F}, {0.4F, 0.4F, 0.4F}, 20};
    scene.materials[1].phong = {{0.1F, 0.2F, 0.4F}, {0.7F, 0.3F, 0.1F}, {0, 0, 0}, 1};
    scene.environment = {{0.1F, 0.1F, 0.4F}, {0.9F, 0.8F, 0.7F}};
    constexpr double away = 40;  // metres; the plane of the solids is 2 high on the film
    scene.nodes.push_back({.trs = {.translation = {0, 0, away}}, .camera = PerspectiveCamera{2 * std::atan(1 / away)}});
    scene.nodes.push_back({.trs = {.translation = {-3, 5, 8}}, .light = LightSource{.casts_shadows = false}});
    const double pixel = 2.0 / 43;
    const auto add = [&](const Shape& shape, double x, double y, std::uint32_t material) {  // in pixels of the film
        const Vec3d at = {(x - 61 / 2.0) * pixel, (43 / 2.0 - y) * pixel, 0};
        scene.nodes.push_back({.trs = {.translation = at}, .geometry = {{shape, material, {}}}});
    };
    const double radius = 1.5;  // in pixels
    int number = 1;
    for (const double beyond : {-1.3, -0.7, -0.2, 0.2, 0.7, 1.3}) {
        // right of a border between columns, and above one between rows, or a little across it
        add(SphereShape{radius * pixel}, 8 * number + beyond + radius, 6, 0);
        if (number <= 4) {
            const Vec3d size = {3 * pixel, 2 * radius * pixel, pixel};
            add(BoxShape{size}, 8 * number + 4, 4 * (number + 4) + beyond - radius, 1);
        }
        ++number;
    }
    return scene;
}

class FilterBits : public test::VariedJobs {
  protected:
    [[nodiscard]] static std::vector<VariedJob> jobs() { return jobs_with_filters(GetParam().tier); }
};

TEST_P(FilterBits, AreThoseOfTheLeastProcessor) { expect_bits_of_the_least_processor(jobs()); }
TEST_P(FilterBits, OfWindowsAndPartsOfSamplesAreThoseOfTheWhole) { expect_bits_of_the_whole_in_parts(jobs()); }
TEST_P(FilterBits, AreNearTheOracle) { expect_films_near_the_oracle(jobs()); }

TEST_P(FilterBits, OfSolidsAtTheBordersOfTilesAreThoseOfTheLeastProcessorAndNearTheOracle) {
    const auto least = make_backend("cpu", {.threads = 1, .instruction_set = "x86-64-v2"});
    const auto oracle = make_backend("oracle");
    // nine samples of at most 2.1 each, a few roundings to float in every one; precise rounds nothing to float
    const double bound = GetParam().tier == Tier::precise ? 2e-11 : 8e-6;
    for (const Scene& authored : {at_the_borders_of_tiles(), named_scene("mixed/64")}) {
        const PreparedScene scene = prepare(authored);
        for (VariedJob varied : jobs()) {
            varied.job.samples = 9;  // so that tiles are culled
            const Film film = backend_->render(load(scene), varied.job).film;
            EXPECT_EQ(film_hash(film), film_hash(least->render(least->load(scene, varied.job.tier), varied.job).film))
                << varied.name;
            const Film expected = oracle->render(oracle->load(scene, varied.job.tier), varied.job).film;
            for (std::size_t i = 0; i < film.pixel_count(); ++i) {
                const Vec3d difference = film.sums()[i] - expected.sums()[i];
                ASSERT_LE(norm1(difference), bound) << varied.name << ", pixel " << i % 61 << ", " << i / 61;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, FilterBits, ::testing::ValuesIn(test::exact_renderers()), test::test_name);

/// The image that a filter makes of a film `fine` times as wide and as high, drawn with box, in the middle of the
/// small film: at each pixel, the weights of the fine pixels are those of the filter's definition. Nearer than `margin`
/// pixels to the border of the film it is 0.
std::vector<Vec3d> convolved(const Film& film, int fine, int margin, PixelFilter filter) {
    const int width = film.width() / fine, height = film.height() / fine, reach = margin * fine;
    std::vector<double> weights;  // of fine pixels, from `reach` before the pixel's corner on
    for (int i = -reach; i < reach + fine; ++i) {
        const double from = static_cast<double>(i) / fine - 0.5, to = static_cast<double>(i + 1) / fine - 0.5;
        weights.push_back(test::weight_below(filter, to) - test::weight_below(filter, from));
    }
    std::vector<Vec3d> result(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), Vec3d{0, 0, 0});
    for (int y = margin; y < height - margin; ++y) {
        for (int x = margin; x < width - margin; ++x) {
            Vec3d& sum = result[test::pixel_index(x, y, width)];
            for (int j = 0; j < static_cast<int>(weights.size()); ++j) {
                for (int i = 0; i < static_cast<int>(weights.size()); ++i) {
                    const int at = (y * fine - reach + j) * film.width() + x * fine - reach + i;
                    sum = sum + film.sums()[static_cast<std::size_t>(at)] *
                                    (weights[static_cast<std::size_t>(i)] * weights[static_cast<std::size_t>(j)]);
                }
            }
            sum = sum / static_cast<double>(film.samples());
        }
    }
    return result;
}

/// The root of the mean square difference of a film's means from an image, without a margin.
double rmse(const Film& film, const std::vector<Vec3d>& image, int margin) {
    double squares = 0, count = 0;
    for (int y = margin; y < film.height() - margin; ++y) {
        for (int x = margin; x < film.width() - margin; ++x) {
            const auto i = test::pixel_index(x, y, film.width());
            const Vec3d difference = film.sums()[i] / static_cast<double>(film.samples()) - image[i];
            squares += dot(difference, difference);
            count += 3;
        }
    }
    return std::sqrt(squares / count);
}

TEST(FilteredImages, AreTheSceneConvolvedWithTheFilter) {
    constexpr int fine = 16, margin = 2;
    const auto cpu = make_backend("cpu");
    const auto scene = cpu->load(prepare(at_the_borders_of_tiles()), Tier::strict);
    RenderJob job = test::small_job();
    job.sampler = Sampler::sobol;
    RenderJob large = job;
    large.width *= fine;
    large.height *= fine;
    large.samples = 32;
    job.samples = 16384;
    const Film detailed = cpu->render(scene, large).film;
    std::vector<Film> films;
    for (const PixelFilterInfo& info : pixel_filter_infos()) {
        job.filter = info.filter;
        films.push_back(cpu->render(scene, job).film);
    }
    for (const PixelFilterInfo& expected : pixel_filter_infos()) {
        const std::vector<Vec3d> image = convolved(detailed, fine, margin, expected.filter);
        for (const PixelFilterInfo& info : pixel_filter_infos()) {
            const double error = rmse(films[static_cast<std::size_t>(info.filter)], image, margin);
            if (info.filter == expected.filter) {
                EXPECT_LE(error, 6e-5) << info.name;
            } else {
                EXPECT_GE(error, 1.8e-4) << info.name << " for " << expected.name;
            }
        }
    }
}

// Kernels that are linked for a scene and its filter.
TEST(FiltersOnTheGpu, DrawWhatTheCpuDraws) {
    if (!why_unavailable("cuda").empty()) GTEST_SKIP() << why_unavailable("cuda");
    for (const Tier tier : {Tier::strict, Tier::precise}) {
        const std::vector<VariedJob> jobs = jobs_with_filters(tier);
        test::expect_the_gpu_to_draw_what_the_cpu_draws(prepare(at_the_borders_of_tiles()), "borders of tiles", jobs);
        test::expect_the_gpu_to_draw_what_the_cpu_draws({jobs.back()});  // linking larger kernels takes seconds each
    }
}

// The tier fast promises no bits. Its film is that of strict but for what float decides.
TEST(FiltersOnTheGpu, OfTheTierFastAreNearStrict) {
    if (!why_unavailable("cuda").empty()) GTEST_SKIP() << why_unavailable("cuda");
    const auto gpu = make_backend("cuda");
    const PreparedScene scene = prepare(at_the_borders_of_tiles());
    for (const auto& [name, job] : jobs_with_filters(Tier::fast)) {
        RenderJob strict = job;
        strict.tier = Tier::strict;
        const Film fast = gpu->render(gpu->load(scene, Tier::fast), job).film;
        const FilmDifference difference = compare(fast, gpu->render(gpu->load(scene, Tier::strict), strict).film);
        EXPECT_LE(difference.residual_rate(Tolerance::one_level), 2e-2) << name;
        EXPECT_LE(difference.mean, 1e-3) << name;
    }
}

}  // namespace
}  // namespace tandem
