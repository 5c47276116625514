/// A backend whose samples are random numbers of known distributions, so that the true image is known exactly.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "support/random.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/render/backend.h"
#include "tandem/render/ready_frame.h"

namespace tandem::test {

/// How the samples of a pixel are distributed. All have the mean 1 where they have noise.
enum class Noise {
    uniform,    ///< from 0 to 2 in the left half, no noise in the right half
    edges,      ///< 0 or 2 in each eighth column, no noise elsewhere
    skewed,     ///< exponential of a normal number, with sigma 1
    fireflies,  ///< 0.9, and 20.9 in one of 200 samples
    glints,     ///< 0.9, and 200.9 in one of 2000 samples: in 16 samples half of the tiles of 8 x 8 pixels have none
    rim,        ///< from 0.9 to 1.1, but in three pixels 0, or 5 in one of 5 samples
    none
};

class NoiseBackend : public Backend {
  public:
    explicit NoiseBackend(Noise noise) : noise_(noise) {}

    int submitted = 0;

    [[nodiscard]] std::string name() const override { return "noise"; }
    [[nodiscard]] Capabilities capabilities() const override { return {"no device", "for tests", true}; }
    [[nodiscard]] std::shared_ptr<ResidentScene> load(const PreparedScene&, Tier tier) override {
        struct Loaded : ResidentScene {
            using ResidentScene::ResidentScene;
            [[nodiscard]] PhaseTimes load_times() const override { return {}; }
        };
        return std::make_shared<Loaded>(tier);
    }
    double trace(ResidentScene&, const TraceJob&) override { return 0; }

    [[nodiscard]] std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene>, const RenderJob& job) override {
        ++submitted;
        const FilmWindow window = window_of(job);
        RenderResult result{Film(window.width, window.height, job.samples, job.planes), {}};
        const FilmPlanes planes = result.film.planes();
        std::size_t i = 0;
        for (int y = window.top; y < window.top + window.height; ++y) {
            for (int x = window.left; x < window.left + window.width; ++x, ++i) {
                for (int s = job.first_sample; s < job.first_sample + job.samples; ++s) {
                    const double value = sample(job, x, y, s);
                    const Vec3d colour{value, value, value};
                    result.film.sums()[i] += colour;
                    if (planes.variance != nullptr) planes.variance[i] += colour * colour;
                }
            }
        }
        return std::make_unique<ReadyFrame>(std::move(result));
    }

  private:
    [[nodiscard]] double sample(const RenderJob& job, int x, int y, int number) const {
        const auto pixel = static_cast<std::uint64_t>(y) * 65536 + static_cast<std::uint64_t>(x);
        // mixed twice: streams of neighbouring seeds overlap
        const std::uint64_t key = (job.seed * 0x9E3779B97F4A7C15U) ^ (pixel << 28) ^ static_cast<std::uint64_t>(number);
        Random random(Random(key).bits());
        const double u = random.uniform(0.0, 1.0), v = random.uniform(0.0, 1.0);
        switch (noise_) {
            case Noise::uniform:
                return x < job.width / 2 ? 2 * u : 1;
            case Noise::edges:
                return x % 8 == 0 ? (u < 0.5 ? 0 : 2) : 1;
            case Noise::skewed:
                return std::exp(std::sqrt(-2 * std::log(1 - u)) * std::cos(6.283185307179586 * v) - 0.5);
            case Noise::fireflies:
                return u < 0.005 ? 20.9 : 0.9;
            case Noise::glints:
                return u < 0.0005 ? 200.9 : 0.9;
            case Noise::rim:
                if (x == 5 && y >= 7 && y < 10) return u < 0.2 ? 5 : 0;
                return 0.9 + 0.2 * u;
            case Noise::none:
                return 1;
        }
        return 0;
    }

    Noise noise_;
};

}  // namespace tandem::test
