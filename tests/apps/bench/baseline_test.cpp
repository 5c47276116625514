// The baseline must be what it says: the paper's scene, drawn right, slow only where it is meant to be.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>

#include "baseline/naive_renderer.h"
#include "loop_backend.h"
#include "pictures.h"
#include "tandem/base/error.h"
#include "tandem/base/whole_file.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/compare.h"
#include "tandem/kernel/traversal/intersect.h"
#include "tandem/scene/named_scenes.h"

namespace tandem::bench {
namespace {

std::vector<float> drawn(const NaiveBuild& build, const NaiveJob& job, int threads = 1) {
    std::vector<float> rgb(3 * static_cast<std::size_t>(job.width) * static_cast<std::size_t>(job.height), -1.0F);
    naive_render(build, job, threads, rgb.data());
    return rgb;
}

Film film_from(const std::vector<float>& rgb, const NaiveJob& job) { return film_of(rgb, job.width, job.height); }

/// Mean over pixels and channels of the difference and of its square.
struct Bias {
    double mean = 0;
    double root_mean_square = 0;
};

Bias bias_between(const Film& a, const Film& b) {
    Bias bias;
    double squares = 0;
    for (std::size_t i = 0; i < a.pixel_count(); ++i) {
        const Vec3d d = widen(a.mean(i)) - widen(b.mean(i));
        bias.mean += d.x + d.y + d.z;
        squares += dot(d, d);
    }
    const double values = 3 * static_cast<double>(a.pixel_count());
    bias.mean /= values;
    bias.root_mean_square = std::sqrt(squares / values);
    return bias;
}

TEST(Baseline, EachBuildHasItsOptimisation) {
    EXPECT_FALSE(naive_o0.optimised) << "the build without optimisation was optimised";
    EXPECT_TRUE(naive_o3.optimised);
}

TEST(Baseline, OptimisationAndThreadsChangeNoMoreThanRounding) {
    const NaiveJob job{90, 81, 4, 17, 0};
    const Film slow = film_from(drawn(naive_o0, job), job);
    const Film fast = film_from(drawn(naive_o3, job), job);
    // Contraction is up to the compiler here; a flipped decision at an edge is one sample of four.
    EXPECT_LE(compare(slow, fast).residual_rate(Tolerance::one_level), 0.002);
    EXPECT_EQ(drawn(naive_o3, job), drawn(naive_o3, job, 3));
}

TEST(Baseline, EverySequenceOfRandomNumbersIsAnother) {
    NaiveJob job{60, 54, 4, 0, 0};
    const std::vector<float> first = drawn(naive_o3, job);
    job.sequence = 1;
    EXPECT_NE(first, drawn(naive_o3, job));
    job.sequence = 0;
    EXPECT_EQ(first, drawn(naive_o3, job));
}

TEST(Baseline, RaysThroughPixelCentresHitWhatTandemHits) {
    for (const int frame : {0, 13, 60, 90}) {
        const NaiveJob job{200, 180, 1, frame, 0};
        const NaiveFrame moving = naive_frame(frame);
        const PreparedScene scene = prepare(named_scene("paper"), {frame, {}});
        const LoopTracer tracer{view(scene)};
        const CameraView camera = camera_view(scene.camera, job.width, job.height);
        int differing = 0;
        int met[5] = {};
        for (int y = 0; y < job.height; ++y) {
            for (int x = 0; x < job.width; ++x) {
                const Ray<float> ray = camera_ray<float>(camera, x, y, 0.5F, 0.5F);
                const Hit hit = to_hit(tracer.closest(ray, NoSource{}, true));
                // Ids: three spheres, then the box; as the naive renderer counts them.
                const int expected = hit.primitive == no_primitive ? -1 : static_cast<int>(hit.primitive);
                const int object = naive_o3.object_at_centre(job, moving, x, y);
                ++met[object + 1];
                differing += object != expected ? 1 : 0;
                if (frame == 0) {
                    EXPECT_EQ(object, naive_o0.object_at_centre(job, moving, x, y)) << x << ' ' << y;
                }
            }
        }
        EXPECT_LE(differing, 10) << "of 36,000 rays, frame " << frame << ": only silhouettes may differ";
        for (const int count : met) EXPECT_GT(count, 100) << "something is not in the picture of frame " << frame;
    }
}

TEST(Baseline, ThePictureIsTandemsButForNoise) {
    // Two estimates of one picture: the noise of 64 + 64 samples bounds the difference, and its mean is near zero.
    const NaiveJob job{100, 90, 64, 45, 0};
    const Film naive = film_from(drawn(naive_o3, job), job);
    LoopBackend backend("cpu", false, true);
    const auto scene = backend.load(prepare(named_scene("paper"), {job.frame, {}}), Tier::strict);
    const Film ours = backend.render(scene, {job.width, job.height, job.samples, 5, 45, Tier::strict}).film;
    const Bias bias = bias_between(naive, ours);
    EXPECT_LT(std::abs(bias.mean), 2e-4);
    EXPECT_LT(bias.root_mean_square, 0.02);
}

TEST(Baseline, TheAnimationIsThePapers) {
    const NaiveFrame first = naive_frame(0);
    EXPECT_EQ(first.light[0], 2);
    EXPECT_EQ(first.light[2], -3);
    const NaiveFrame quarter = naive_frame(30);
    EXPECT_NEAR(quarter.light[0], 0, 1e-6);
    EXPECT_NEAR(quarter.light[2], -1, 1e-6);
    EXPECT_NEAR(quarter.cube[1], 0.8, 1e-6);
    EXPECT_EQ(naive_frame(120).cube[1], first.cube[1]);
}

TEST(Baseline, TextFilesAreP3) {
    const std::string path = testing::TempDir() + "naive.ppm";
    const std::vector<float> rgb = {0, 0.5F, 1, 2, -1, 0.25F};
    naive_write_ppm(path, 2, 1, rgb.data());
    const Bytes bytes = read_file(path);
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
              "P3\n2 1\n255\n0 127 255\n255 0 63\n");
    EXPECT_THROW(naive_write_ppm(testing::TempDir() + "no/such/folder.ppm", 2, 1, rgb.data()), EnvironmentError);
    std::remove(path.c_str());
}

TEST(Baseline, TheKernelDrawsTheSamePicture) {
    const std::string reason = naive_gpu_why_unavailable();
    const NaiveJob job{200, 180, 16, 77, 0};
    std::vector<float> rgb(3 * static_cast<std::size_t>(job.width) * static_cast<std::size_t>(job.height));
    if (!reason.empty()) {
        EXPECT_THROW((void)naive_gpu_render(job, rgb.data()), EnvironmentError);
        GTEST_SKIP() << reason;
    }
    const NaiveGpuTimes times = naive_gpu_render(job, rgb.data());
    EXPECT_GT(times.kernel, 0);
    const Film gpu = film_from(rgb, job);
    const Film cpu = film_from(drawn(naive_o3, job), job);
    // The same random numbers; contraction and powf differ.
    EXPECT_LE(compare(cpu, gpu).residual_rate(Tolerance::one_level), 0.01);
    EXPECT_LT(std::abs(bias_between(cpu, gpu).mean), 1e-4);
}

}  // namespace
}  // namespace tandem::bench
