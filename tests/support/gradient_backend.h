/// A backend for tests of the code around backends. Its films are gradients that depend on the job, unless a test
/// replaces them. Hooks let a test intervene, and calls are counted.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>

#include "support/plane_film.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/render/backend.h"
#include "tandem/render/copy_window.h"

namespace tandem::test {

/// The whole film that GradientBackend renders of a job.
inline Film whole_gradient_film(const RenderJob& job) {
    Film film(job.width, job.height, job.samples, job.planes);
    fill_planes(film, 1 + job.frame);
    const auto share = [](int i, int count) { return (i + 0.5) / count; };
    for (int y = 0; y < job.height; ++y) {
        for (int x = 0; x < job.width; ++x) {
            const auto pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(job.width) + static_cast<std::size_t>(x);
            const double third = static_cast<double>((job.seed * 7 + job.frame * 3) % 11) / 10;
            film.sums()[pixel] =
                Vec3d{share(x, job.width), share(y, job.height), third} * static_cast<double>(job.samples);
        }
    }
    return film;
}

/// The film that GradientBackend renders.
inline Film gradient_film(const RenderJob& job) {
    const FilmWindow window = window_of(job);
    Film film(window.width, window.height, job.samples, job.planes);
    copy_window(film, 0, 0, whole_gradient_film(job), window);
    return film;
}

class GradientBackend : public Backend {
  public:
    explicit GradientBackend(std::string name = "gradient") : name_(std::move(name)) {}

    std::function<void(const RenderJob&)> on_submit = [](const RenderJob&) {};
    std::function<void(const RenderJob&)> on_get = [](const RenderJob&) {};  ///< may throw
    std::function<Film(const RenderJob&)> film = gradient_film;
    int loads = 0;
    int submitted = 0;
    int in_flight = 0;
    int most_in_flight = 0;

    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] Capabilities capabilities() const override { return {"no device", "for tests", true}; }

    [[nodiscard]] std::shared_ptr<ResidentScene> load(const PreparedScene&, Tier tier) override {
        struct Loaded : ResidentScene {
            using ResidentScene::ResidentScene;
            [[nodiscard]] PhaseTimes load_times() const override { return {.build = 0.25, .upload = 0.125}; }
        };
        ++loads;
        return std::make_shared<Loaded>(tier);
    }

    double trace(ResidentScene&, const TraceJob&) override { return 0; }

    [[nodiscard]] std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene>, const RenderJob& job) override {
        struct Pending : PendingFrame {
            Pending(GradientBackend& backend, const RenderJob& job) : backend(backend), job(job) {}
            [[nodiscard]] RenderResult get() override {
                --backend.in_flight;
                backend.on_get(job);
                RenderResult result{backend.film(job), {}};
                result.stats.seconds.render = 0.5;
                result.stats.counters.invalid_samples = job.frame;
                result.stats.variant = "gradient";
                return result;
            }
            GradientBackend& backend;
            RenderJob job;
        };
        ++submitted;
        most_in_flight = std::max(most_in_flight, ++in_flight);
        on_submit(job);
        return std::make_unique<Pending>(*this, job);
    }

  private:
    std::string name_;
};

}  // namespace tandem::test
