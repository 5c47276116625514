// Group I: sums over many samples. There are no cases for variance, resuming and filters (I4, I8, I10) yet; group L
// covers the orders of summation (I5, I6).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hard/corpus/groups.h"
#include "hard/corpus/pictures.h"
#include "hard/corpus/ray_batches.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/lights/environment.h"
#include "tandem/render/pixel_job.h"

namespace tandem::hard {

namespace {

/// Samples of the only pixel: the number of rays times 200, a million in the tests.
RenderJob long_sum(const Subject& subject, std::size_t rays) {
    const std::size_t most = std::size_t{1} << 24;
    return {.width = 1,
            .height = 1,
            .samples = static_cast<int>(std::min(most, 200 * rays)),
            .seed = 3,
            .frame = 0,
            .tier = subject.tier};
}

void measure_mean(Score& score, double sum, long double right) {
    const double error = static_cast<double>(std::abs(sum - right) / right);
    const auto line = [&] { return fmt::format("a sum of {} in place of {}", sum, static_cast<double>(right)); };
    score.decide(!(error <= 1e-6), line);
    score.measure(error * 0x1p24, line);
}

Scene sky(const Vec3f& bottom, const Vec3f& top) {
    Scene scene = scene_of({});
    scene.environment = {bottom, top, {1, 1, 1}};
    return scene;
}

Score tenths(const Subject& subject, Random&, std::size_t rays) {
    Score score;
    const RenderJob job = long_sum(subject, rays);
    const Film film = picture_of(subject.backend, prepare(sky({0.1F, 0, 0}, {0.1F, 0, 0})), job, score);
    measure_mean(score, film.sums()[0].x, static_cast<long double>(0.1F) * job.samples);
    return score;
}

/// A sky from 0 to 1: the same samples added in extended precision.
Score uniform(const Subject& subject, Random&, std::size_t rays) {
    Score score;
    const RenderJob job = long_sum(subject, rays);
    const PreparedScene scene = prepare(sky({0, 0, 0}, {1, 1, 1}));
    const Film film = picture_of(subject.backend, scene, job, score);
    const PixelJob pixel = make_pixel_job(scene.camera, job);
    long double right = 0;
    for (std::uint32_t sample = 0; sample < pixel.samples; ++sample) {
        const auto random = SampleId<float>{&pixel.keys, pixel.frame, 0, sample}.block(Dimension::film);
        const Ray<float> ray = camera_ray<float>(pixel.camera, 0, 0, to_unit_interval<float>(random.word[0]),
                                                 to_unit_interval<float>(random.word[1]));
        right += background(scene.environment, ray.direction).x;
    }
    measure_mean(score, film.sums()[0].x, right);
    return score;
}

/// A disc of radiance `bright` that fills about 1e-4 of the pixel before a sky of 1, both exact in float.
Scene firefly(float bright) {
    Scene scene = scene_of({{{0, 0, -100}, 0.475F}});
    scene.materials[0].phong = {{1, 1, 1}, {0, 0, 0}, {0, 0, 0}, 1};
    scene.environment = {{1, 1, 1}, {1, 1, 1}, {bright, bright, bright}};
    return scene;
}

/// The sum of n samples, k of them 10^4 and the others 1, is a whole number with remainder n modulo 9999.
Score fireflies(const Subject& subject, Random&, std::size_t rays) {
    Score score;
    const RenderJob job = long_sum(subject, rays);
    const double sum = picture_of(subject.backend, prepare(firefly(1e4F)), job, score).sums()[0].x;
    const double bright = (sum - job.samples) / 9999;
    const double share = bright / job.samples;
    score.decide(!(bright == std::floor(bright) && share > 0.5e-4 && share < 2e-4),
                 fmt::format("{} samples sum to {}", job.samples, sum));
    return score;
}

/// The same with 10^30: finite, and none is dropped.
Score enormous_fireflies(const Subject& subject, Random&, std::size_t rays) {
    Score score;
    const RenderJob job = long_sum(subject, rays);
    const double bright = double{1e30F};
    const double sum = picture_of(subject.backend, prepare(firefly(1e30F)), job, score).sums()[0].x;
    const double share = sum / bright / job.samples;
    score.decide(!(share > 0.5e-4 && share < 2e-4), fmt::format("{} samples sum to {}", job.samples, sum));
    return score;
}

/// A light too bright for float: every sample that hits the sphere is infinite or NaN, is dropped, and is counted; the
/// background around it does not change.
Score not_finite(const Subject& subject, Random&, std::size_t) {
    Scene scene = scene_of({{{0, 0, -5}, 1}});
    scene.nodes.push_back({.name = "lamp", .light = LightSource{.casts_shadows = false}});
    PreparedScene prepared = prepare(scene);
    prepared.lights.at(0).intensity = Vec3f{1, 1, 1} * HUGE_VALF;  // which prepare() refuses
    const PreparedScene empty = prepare(scene_of({}));
    RenderJob job = small_picture(subject);
    const auto resident = subject.backend.load(prepared, subject.tier);
    RenderResult with = subject.backend.render(resident, job);
    Score score;
    const Film without = picture_of(subject.backend, empty, job, score);
    std::size_t lost = 0;
    // kernels of two scenes may contract the sky's interpolation in two ways in the tier fast
    const double most = subject.tier == Tier::fast ? 1 + 1e-6 : 1;
    for (std::size_t i = 0; i < without.pixel_count(); ++i) {
        const Vec3d& sum = with.film.sums()[i];
        const bool finite = std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z);
        score.decide(!finite || sum.x > without.sums()[i].x * most,
                     [&] { return fmt::format("pixel {} is {}", i, sum.x); });
        lost += sum.x * most < without.sums()[i].x;
    }
    const std::uint64_t counted = with.stats.counters.invalid_samples;
    score.decide(!(counted >= lost && lost > 0), fmt::format("{} pixels lost samples, {} were counted", lost, counted));
    return score;
}

}  // namespace

std::vector<HardCase> film_cases() {
    return {
        {"I1", "A million samples of 0.1", "a float sum is off by 1 %, at 10^8 samples by 79 %", "closed form",
         RenderCase{tenths}},
        {"I2", "A million samples between 0 and 1", "a float sum stops at 2^24",
         "the same samples in extended precision", RenderCase{uniform}},
        {"I3", "Samples of 10^4, one among 10^4", "a running mean is off by 128 %", "integers", RenderCase{fireflies}},
        {"I7", "Infinite and NaN samples", "one of them fixes the pixel's value for ever", "rule: dropped and counted",
         RenderCase{not_finite}},
        {"I9", "Samples of 10^30", "they overflow, or are dropped", "rule: finite, kept",
         RenderCase{enormous_fireflies}},
    };
}

}  // namespace tandem::hard
