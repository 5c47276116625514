// Rendering to a target: where samples go, what ends it, and equal bits.
#include "tandem/render/adaptive_frame.h"

#include <gtest/gtest.h>

#include "support/input_error.h"
#include "support/noise_backend.h"
#include "support/pixel_index.h"
#include "tandem/backends/make_backend.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/film/plane_names.h"
#include "tandem/render/tile_windows.h"
#include "tandem/render/tiled_film.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using test::contains;
using test::input_error;
using test::Noise;
using test::NoiseBackend;

const std::function<double()> no_clock = [] { return 0.0; };

class AdaptiveFrame : public testing::Test {
  protected:
    AdaptiveFrame() {
        job.width = 128;
        job.height = 70;  // no multiple of the tile
        job.samples = 4096;
    }
    [[nodiscard]] FramePlan plan() const { return plan_frame(scene, {}, job); }
    [[nodiscard]] TargetFrame render(Backend& backend, const std::function<double()>& clock = no_clock) const {
        std::optional<TargetFrame> frame = render_to_target(backend, scene, plan(), target, interrupted, clock);
        EXPECT_TRUE(frame);
        return *std::move(frame);
    }

    Scene scene = named_scene("paper");
    RenderJob job;
    RenderTarget target{.error = 0.05};
    std::atomic<bool> interrupted{false};
};

TEST_F(AdaptiveFrame, SamplesTheTilesThatHaveNoise) {
    NoiseBackend backend(Noise::uniform);
    const TargetFrame frame = render(backend);
    EXPECT_EQ(frame.stopped_by, StoppedBy::target);
    // The left half has the variance 1/3, so the film has the error 0.05 with 67 samples there. The right half gets the
    // first round and the part without which its last round would show nothing.
    const TileSamples tiles = parse_tile_samples(frame.tile_samples, job.width, job.height);
    ASSERT_EQ(tiles.grid.edge, 8);  // 12 tiles of 32 pixels, or 40 of 16, would be few
    for (std::size_t i = 0; i < tiles.samples.size(); ++i) {
        if (i % 16 < 8) {
            EXPECT_TRUE(tiles.samples[i] == 64 || tiles.samples[i] == 96) << tiles.samples[i];
        } else {
            EXPECT_EQ(tiles.samples[i], 24);
        }
    }
    const Film& film = frame.frame.result.film;
    EXPECT_EQ(film.samples(), 96);
    EXPECT_EQ(film.samples_of(64), 24U);
    EXPECT_EQ(film.mean(64).x, 1.0F);
    EXPECT_EQ(film.plane_mask(), PlaneMask());
    EXPECT_LE(frame.error.low, 0.05);
    EXPECT_NEAR(frame.error.value, 0.05, 0.1 * 0.05);
    EXPECT_GT(frame.error.high, 0.9 * 0.05);
    EXPECT_LT(frame.error.low, 0.05);
}

TEST_F(AdaptiveFrame, TheSamplesOfATileAreThoseOfAFrameWithAsMany) {
    const auto cpu = make_backend("cpu");
    job.planes = FilmPlane::count | FilmPlane::normal;
    target.error = 0.004;
    const TargetFrame frame = render(*cpu);
    const TileSamples tiles = parse_tile_samples(frame.tile_samples, job.width, job.height);
    ASSERT_GT(*std::max_element(tiles.samples.begin(), tiles.samples.end()), 32);
    const Film& film = frame.frame.result.film;
    EXPECT_EQ(film.plane_mask(), job.planes);
    const auto resident = cpu->load(prepare(scene));
    std::size_t tile = 0;
    for (const int samples : tiles.samples) {
        RenderJob alone = job;
        alone.samples = samples;
        alone.window = tiles.grid.tile(tile++);
        const Film expected = cpu->render(resident, alone).film;
        Film part(alone.window->width, alone.window->height, samples, job.planes);
        copy_window(part, 0, 0, film, *alone.window);
        for (std::size_t i = 0; i < part.pixel_count(); ++i) {
            // rounds add partial sums, so the last bits may differ
            ASSERT_NEAR(part.sums()[i].x, expected.sums()[i].x, 1e-12 * samples);
            ASSERT_EQ(part.planes().count[i], static_cast<std::uint32_t>(samples));
        }
    }
}

TEST_F(AdaptiveFrame, HasTheSameBitsWithAnyThreadsAndInstructions) {
    target = {.error = 0.01, .metric = ErrorMetric::relmse};
    BackendOptions least;
    least.instruction_set = "x86-64-v2";
    least.threads = 1;
    BackendOptions other;
    other.threads = 2;
    other.tile_size = 5;
    const TargetFrame a = render(*make_backend("cpu", least)), b = render(*make_backend("cpu", other));
    EXPECT_EQ(film_hash(a.frame.result.film), film_hash(b.frame.result.film));
    EXPECT_EQ(a.tile_samples, b.tile_samples);
    EXPECT_EQ(a.error.value, b.error.value);
    EXPECT_EQ(a.error.high, b.error.high);
}

TEST_F(AdaptiveFrame, WantsIndependentSamples) {
    NoiseBackend backend(Noise::uniform);
    for (const Sampler sampler : {Sampler::sobol, Sampler::sobol_blue}) {
        job.sampler = sampler;
        EXPECT_TRUE(contains(input_error([&] { (void)render(backend); }), "use --sampler random"));
        const RenderTarget in_time{.error = 0, .seconds = 10};
        EXPECT_TRUE(contains(input_error([&] { check(in_time, job); }), "use --sampler random"));
        EXPECT_NO_THROW(check(RenderTarget{}, job)) << "the time of all samples is no estimate of errors";
    }
}

TEST_F(AdaptiveFrame, StopsAtTheMostSamples) {
    NoiseBackend backend(Noise::uniform);
    job.samples = 100;  // the last part is shorter than the one before
    target.error = 0.03;
    const TargetFrame frame = render(backend);
    EXPECT_EQ(frame.stopped_by, StoppedBy::samples);
    // the tiles beside those with noise get as many
    EXPECT_EQ(
        frame.tile_samples, "8: 100*9 24*7" + [] {
            std::string rows;
            for (int i = 1; i < 9; ++i) rows += " 100*9 24*7";
            return rows;
        }());
    const double expected = std::sqrt(1.0 / 3 / 100 / 2);  // half of the pixels have no error
    EXPECT_NEAR(frame.error.value, expected, 0.05 * expected);
    EXPECT_LT(frame.error.low, expected);
    EXPECT_GT(frame.error.high, expected);
}

TEST_F(AdaptiveFrame, AFilmWithoutNoiseNeedsTwoRounds) {
    NoiseBackend backend(Noise::none);
    const TargetFrame frame = render(backend);
    EXPECT_EQ(frame.stopped_by, StoppedBy::target);
    EXPECT_EQ(frame.tile_samples, "8: 24*144");
    EXPECT_EQ(frame.error.high, 0);
}

TEST_F(AdaptiveFrame, StartsNoRoundThatWouldEndTooLate) {
    NoiseBackend backend(Noise::skewed);
    target = {.error = 0, .seconds = 10};
    // a second for each part: rounds of two parts end after 2, 4, 6, ... s, though they double
    const auto clock = [&] { return static_cast<double>(backend.submitted); };
    const TargetFrame frame = render(backend, clock);
    EXPECT_EQ(frame.stopped_by, StoppedBy::time);
    // predicted: 2 + 2, 4 + 4, and 6 + 6 is too late
    EXPECT_EQ(frame.tile_samples, "8: 64*144");
    EXPECT_EQ(backend.submitted, 6);
}

TEST_F(AdaptiveFrame, AnInterruptStartsNoWindow) {
    NoiseBackend backend(Noise::uniform);
    interrupted = true;
    EXPECT_FALSE(render_to_target(backend, scene, plan(), target, interrupted, no_clock));
    EXPECT_EQ(backend.submitted, 0);
    interrupted = false;
    const auto stop_at_once = [&] {
        interrupted = backend.submitted > 0;
        return 0.0;
    };
    const TargetFrame frame = render(backend, stop_at_once);
    EXPECT_EQ(frame.stopped_by, StoppedBy::interrupt);
    EXPECT_EQ(frame.tile_samples, "8: 16*144");
}

TEST_F(AdaptiveFrame, GoesOnWhereTheLastRoundShowsMoreThanWasKnown) {
    // one sample in 200 is a firefly: 16 samples per pixel show too little, and the error that is stated is near its
    // target
    NoiseBackend backend(Noise::fireflies);
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
        job.seed = seed;
        target.error = 0.1;
        const TargetFrame frame = render(backend);
        EXPECT_EQ(frame.stopped_by, StoppedBy::target);
        EXPECT_LE(frame.error.low, 0.1);
        EXPECT_NEAR(frame.error.value, 0.1, 0.02);
    }
}

TEST_F(AdaptiveFrame, FlipHasTheSameBitsWithAnyThreadsAndInstructions) {
    target = {.error = 0.02, .metric = ErrorMetric::flip};
    BackendOptions least;
    least.instruction_set = "x86-64-v2";
    least.threads = 1;
    const TargetFrame a = render(*make_backend("cpu", least)), b = render(*make_backend("cpu"));
    EXPECT_EQ(a.stopped_by, StoppedBy::target);
    EXPECT_LE(a.error.low, 0.02);
    EXPECT_EQ(film_hash(a.frame.result.film), film_hash(b.frame.result.film));
    EXPECT_EQ(a.error.value, b.error.value);
    job.samples = 15;
    EXPECT_TRUE(contains(input_error([&] { (void)render(*make_backend("cpu")); }), "FLIP"));
}

TEST_F(AdaptiveFrame, RefusesWhatItCannotJudge) {
    NoiseBackend backend(Noise::uniform);
    const auto refusal = [&] { return input_error([&] { (void)render(backend); }); };
    job.samples = 1;
    EXPECT_TRUE(contains(refusal(), "allow 2 or more"));
    job.samples = 64;
    target.error = -1;
    EXPECT_TRUE(contains(refusal(), "-1"));
    target = {.error = 0.1, .seconds = 0};
    EXPECT_TRUE(contains(refusal(), "time budget"));
    target = {.error = 0.1};
    for (Node& node : scene.nodes) {
        if (node.camera) shutter_of(*node.camera) = Shutter{0, 0.5, 3};
    }
    EXPECT_TRUE(contains(refusal(), "motion blur"));
    EXPECT_TRUE(contains(input_error([] { (void)parse_metric("psnr"); }), "rmse, relmse and flip"));
}

TEST(RenderTarget, IsInWords) {
    EXPECT_EQ(to_string(RenderTarget{.error = 0.01}), "rmse 0.01");
    EXPECT_EQ(to_string(RenderTarget{.error = 2, .metric = ErrorMetric::relmse, .seconds = 60}),
              "relmse 2 within 60 s");
    EXPECT_EQ(to_string(RenderTarget{.seconds = 1.5}), "within 1.5 s");
    EXPECT_EQ(to_string(RenderTarget{}), "");
}

TEST(WindowsOf, CoverTheMarkedTilesOnce) {
    const TileGrid grid{100, 70, 32};  // 4 x 3 tiles
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        test::Random random(seed);
        std::vector<bool> marked(grid.count());
        for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = random.coin();
        std::vector<int> covered(std::size_t{100} * 70);
        for (const FilmWindow& window : windows_of(grid, marked)) {
            for (int y = window.top; y < window.top + window.height; ++y) {
                for (int x = window.left; x < window.left + window.width; ++x) {
                    ++covered[test::pixel_index(x, y, 100)];
                }
            }
        }
        for (int y = 0; y < 70; ++y) {
            for (int x = 0; x < 100; ++x) {
                const bool is_marked = marked[test::pixel_index(x / 32, y / 32, 4)];
                ASSERT_EQ(covered[test::pixel_index(x, y, 100)], is_marked ? 1 : 0)
                    << "seed " << seed << " at " << x << ", " << y;
            }
        }
    }
    EXPECT_EQ(windows_of(grid, std::vector<bool>(grid.count(), true)).size(), 1U);
    EXPECT_TRUE(windows_of(grid, std::vector<bool>(grid.count(), false)).empty());
}

TEST(Cut, LeavesWindowsOfWholeTilesThatAreSmall) {
    for (const std::size_t most : {1U, 1024U, 3000U, 100000U}) {
        std::vector<int> covered(std::size_t{100} * 70);
        for (const FilmWindow& window : cut({{0, 0, 100, 64}, {32, 64, 68, 6}}, 32, most)) {
            EXPECT_LE(pixel_count(window), std::max<std::size_t>(most, 1024));
            EXPECT_EQ(window.left % 32, 0);
            EXPECT_EQ(window.top % 32, 0);
            for (int y = window.top; y < window.top + window.height; ++y) {
                for (int x = window.left; x < window.left + window.width; ++x) {
                    ++covered[test::pixel_index(x, y, 100)];
                }
            }
        }
        for (int y = 0; y < 70; ++y) {
            for (int x = 0; x < 100; ++x) {
                ASSERT_EQ(covered[test::pixel_index(x, y, 100)], y < 64 || x >= 32 ? 1 : 0) << x << ", " << y;
            }
        }
    }
}

}  // namespace
}  // namespace tandem
