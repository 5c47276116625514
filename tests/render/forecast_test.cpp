// Forecasts against the renders that they are of.
#include "tandem/render/forecast.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/input_error.h"
#include "support/noise_backend.h"
#include "tandem/render/tile_grid.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using test::Noise;
using test::NoiseBackend;

class ForecastTest : public testing::Test {
  protected:
    ForecastTest() {
        job.width = 128;
        job.height = 96;
        job.samples = 4096;
    }
    /// The samples that a clock has seen: a microsecond each.
    struct TimedBackend : NoiseBackend {
        using NoiseBackend::NoiseBackend;
        double samples = 0;
        std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene, const RenderJob& job) override {
            samples += static_cast<double>(pixel_count(window_of(job))) * job.samples;
            return NoiseBackend::submit(std::move(scene), job);
        }
        [[nodiscard]] std::function<double()> clock() const {
            return [this] { return 1e-6 * samples; };
        }
    };
    [[nodiscard]] FramePlan plan() const { return plan_frame(scene, {}, job); }

    Scene scene = named_scene("paper");
    RenderJob job;
    std::atomic<bool> never{false};
};

TEST_F(ForecastTest, IsNearTheRender) {
    for (const Noise noise : {Noise::uniform, Noise::edges, Noise::skewed}) {
        const RenderTarget target{.error = 0.06};
        TimedBackend probed(noise), rendered(noise);
        const Forecast expected = forecast(probed, scene, plan(), target, probed.clock());
        const auto frame = render_to_target(rendered, scene, plan(), target, never, rendered.clock());
        EXPECT_LE(expected.samples.low, frame->mean_samples);
        EXPECT_GE(expected.samples.high, frame->mean_samples);
        EXPECT_LE(expected.seconds.low, 1.0001e-6 * rendered.samples);
        EXPECT_GE(expected.seconds.high, 0.9999e-6 * rendered.samples);
        EXPECT_LE(expected.samples.high, 4 * expected.samples.low);  // it says something
        EXPECT_TRUE(expected.can_reach);
        EXPECT_GE(probed.samples, 16.0 * job.width * job.height);
        EXPECT_LE(probed.samples, 20.0 * job.width * job.height);
    }
}

TEST_F(ForecastTest, SaysWhatCannotBeReached) {
    TimedBackend backend(Noise::uniform);
    job.samples = 64;
    const Forecast expected = forecast(backend, scene, plan(), {.error = 0.01}, backend.clock());
    EXPECT_FALSE(expected.can_reach);
    const double least = std::sqrt(1.0 / 3 / 64 / 2);  // half of the pixels have no error
    EXPECT_NEAR(expected.least_error.value, least, 0.05 * least);
    EXPECT_LT(expected.least_error.low, least);
    EXPECT_GT(expected.least_error.high, least);
    EXPECT_EQ(expected.samples.value, (64.0 * 9 + 24 * 7) / 16) << "with the tiles beside the noise";
}

TEST_F(ForecastTest, OfAGivenNumberOfSamplesIsOfTimeAlone) {
    TimedBackend backend(Noise::skewed);
    job.samples = 1000;
    const Forecast expected = forecast(backend, scene, plan(), {}, backend.clock());
    EXPECT_EQ(expected.samples.low, 1000);
    EXPECT_EQ(expected.samples.high, 1000);
    EXPECT_NEAR(expected.seconds.value, 1e-3 * job.width * job.height, 1e-6);
    EXPECT_EQ(fits(expected, 1), Fits::no);
    EXPECT_EQ(fits(expected, 100), Fits::yes);
    job.samples = 1;
    EXPECT_NEAR(forecast(backend, scene, plan(), {}, backend.clock()).seconds.value, 1e-6 * job.width * job.height,
                1e-9);
}

TEST(Fits, IsUndecidedWithinTheInterval) {
    const Forecast expected{.samples = {}, .seconds = {10, 8, 13}};
    EXPECT_EQ(fits(expected, 7.9), Fits::no);
    EXPECT_EQ(fits(expected, 10), Fits::perhaps);
    EXPECT_EQ(fits(expected, 13), Fits::yes);
}

}  // namespace
}  // namespace tandem
