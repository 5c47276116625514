// Does the stated interval have the true error? Repeated renders to a target, against known images and references.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/noise_backend.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/flip.h"
#include "tandem/render/adaptive_frame.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using test::Noise;
using test::NoiseBackend;

constexpr int trials = 200;
constexpr int least_covered = 186;  // 93 %

/// Two independent estimates of the true image, or the truth twice.
struct Truth {
    std::vector<Vec3d> a, b;
};

std::vector<Vec3d> means_of(const Film& film) {
    std::vector<Vec3d> means;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        means.push_back(film.sums()[i] / static_cast<double>(film.samples_of(i)));
    }
    return means;
}

/// The FLIP between a film and the mean of the references, whose noise is much weaker.
double true_flip(const Film& film, const Truth& truth) {
    FloatImage reference{film.width(), film.height(), {}};
    for (std::size_t i = 0; i < truth.a.size(); ++i) {
        reference.pixels.push_back(narrow((truth.a[i] + truth.b[i]) * 0.5));
    }
    return flip(film_to_image(film), reference).mean;
}

/// The error of a film. The product of differences from independent references has no bias from their noise.
double true_error(const Film& film, const Truth& truth, ErrorMetric metric) {
    if (metric == ErrorMetric::flip) return true_flip(film, truth);
    const std::vector<Vec3d> means = means_of(film);
    const auto channels = [](const Vec3d& v) { return std::array{v.x, v.y, v.z}; };
    double mean = 0;
    for (const Vec3d& v : truth.a) mean += (v.x + v.y + v.z) / 3 / static_cast<double>(truth.a.size());
    double sum = 0;
    for (std::size_t i = 0; i < means.size(); ++i) {
        const auto x = channels(means[i]), a = channels(truth.a[i]), b = channels(truth.b[i]);
        for (std::size_t c = 0; c < 3; ++c) {
            const double square = (x[c] - a[c]) * (x[c] - b[c]);
            const double scale = metric == ErrorMetric::rmse ? 1 : a[c] * b[c] + relmse_floor * mean * mean;
            sum += square / scale / 3;
        }
    }
    const double result = sum / static_cast<double>(means.size());
    return metric == ErrorMetric::rmse ? std::sqrt(std::max(result, 0.0)) : result;
}

struct Coverage {
    int covered = 0, below = 0, above = 0;
    double error = 0;  ///< the mean, as a share of the target
};

/// Renders with seeds 1 to `trials`, and counts the intervals that have the true error.
Coverage cover(Backend& backend, const Scene& scene, RenderJob job, const RenderTarget& target, const Truth& truth) {
    const std::atomic<bool> never{false};
    Coverage coverage;
    for (int trial = 1; trial <= trials; ++trial) {
        job.seed = static_cast<std::uint64_t>(trial);
        const auto frame =
            render_to_target(backend, scene, plan_frame(scene, {}, job), target, never, [] { return 0.0; });
        EXPECT_EQ(frame->stopped_by, StoppedBy::target) << "seed " << trial;
        const double error = true_error(frame->frame.result.film, truth, target.metric);
        coverage.error += error / target.error / trials;
        coverage.below += error < frame->error.low ? 1 : 0;
        coverage.above += error > frame->error.high ? 1 : 0;
    }
    coverage.covered = trials - coverage.below - coverage.above;
    return coverage;
}

void expect_covered(const Coverage& coverage, const char* name, double most_error = 1) {
    EXPECT_GE(coverage.covered, least_covered) << name << ": of " << trials << " true errors " << coverage.below
                                               << " were below their interval, " << coverage.above << " above";
    EXPECT_GE(coverage.error, 0.85) << name;
    EXPECT_LE(coverage.error, most_error) << name;
    ::testing::Test::RecordProperty(std::string("covered_") + name, coverage.covered);
}

TEST(Coverage, OfKnownNoise) {
    RenderJob job;
    job.width = 48;
    job.height = 36;
    job.samples = 1 << 14;
    const Scene scene = named_scene("paper");
    const Truth ones{std::vector<Vec3d>(48 * 36, Vec3d{1, 1, 1}), std::vector<Vec3d>(48 * 36, Vec3d{1, 1, 1})};
    struct Case {
        Noise noise;
        const char* name;
        RenderTarget target;
        double most_error = 1;
    };
    for (const Case& one :
         {Case{Noise::uniform, "uniform", {.error = 0.08}}, Case{Noise::edges, "edges", {.error = 0.05}},
          Case{Noise::skewed, "skewed", {.error = 0.2}}, Case{Noise::fireflies, "fireflies", {.error = 0.2}},
          Case{Noise::glints, "glints", {.error = 0.3}, 1.1}, Case{Noise::rim, "rim", {.error = 0.01}},
          Case{Noise::rim, "rim_roughly", {.error = 0.016}},
          Case{Noise::skewed, "white_flip", {.error = 0.08, .metric = ErrorMetric::flip}, 1.1},
          Case{Noise::skewed, "skewed_relmse", {.error = 0.02, .metric = ErrorMetric::relmse}}}) {
        NoiseBackend backend(one.noise);
        expect_covered(cover(backend, scene, job, one.target, ones), one.name, one.most_error);
    }
}

TEST(Coverage, OfScenes) {
    RenderJob job;
    job.width = 48;
    job.height = 40;
    job.samples = 1 << 12;
    const auto backend = make_backend("cpu");
    struct Case {
        const char* name;
        RenderTarget target;
    };
    for (const Case& one : {Case{"paper", {.error = 0.01}}, Case{"mixed/64", {.error = 0.015}},
                            Case{"mixed/64", {.error = 0.012, .metric = ErrorMetric::flip}}}) {
        const Scene scene = named_scene(one.name);
        const auto resident = backend->load(prepare(scene));
        RenderJob reference = job;
        reference.samples = 2048;
        Truth truth;
        for (auto* half : {&truth.a, &truth.b}) {
            reference.seed = half == &truth.a ? 1'000'001 : 1'000'002;
            *half = means_of(backend->render(resident, reference).film);
        }
        expect_covered(cover(*backend, scene, job, one.target, truth), one.name);
    }
}

}  // namespace
}  // namespace tandem
