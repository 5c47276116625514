#include "tandem/render/backend.h"

#include <fmt/format.h>

#include <utility>

#include "tandem/base/error.h"
#include "tandem/film/plane_names.h"
#include "tandem/images/tone_curve.h"
#include "tandem/render/copy_window.h"

namespace tandem {

namespace {

/// Renders a film of its own, and copies it.
class CopiedFrame final : public PendingFrame {
  public:
    CopiedFrame(std::unique_ptr<PendingFrame> inner, Film film, int left, int top)
        : inner_(std::move(inner)), film_(std::move(film)), left_(left), top_(top) {}

    RenderResult get() override {
        RenderResult result = inner_->get();
        const Film part = std::exchange(result.film, {});
        copy_window(film_, left_, top_, part, {0, 0, part.width(), part.height()});
        return result;
    }

  private:
    std::unique_ptr<PendingFrame> inner_;
    Film film_;
    int left_, top_;
};

/// Renders a film, and finds its levels on the host.
class MappedFrame final : public PendingImage {
  public:
    MappedFrame(std::unique_ptr<PendingFrame> inner, const Display& display)
        : inner_(std::move(inner)), display_(display) {}

    ImageResult get() override {
        RenderResult result = inner_->get();
        const auto mapped = std::make_shared<const ToneMapped>(tone_map(result.film, display_));
        return {mapped->image, mapped, mapped->nan_values, std::move(result.stats)};
    }

  private:
    std::unique_ptr<PendingFrame> inner_;
    Display display_;
};

}  // namespace

void check_image(const RenderJob& job) {
    if (job.planes.empty()) return;
    throw InputError(fmt::format("an image of 8 bits holds only the colour, not the planes {}; render a film",
                                 to_string(job.planes)));
}

std::unique_ptr<PendingImage> Backend::submit_image(std::shared_ptr<ResidentScene> scene, const RenderJob& job,
                                                    const Display& display) {
    check_image(job);
    return std::make_unique<MappedFrame>(submit(std::move(scene), job), display);
}

std::unique_ptr<PendingFrame> Backend::submit_to(Film film, int left, int top, std::shared_ptr<ResidentScene> scene,
                                                 const RenderJob& job) {
    return std::make_unique<CopiedFrame>(submit(std::move(scene), job), std::move(film), left, top);
}

Film Backend::make_film(int width, int height, int samples, PlaneMask planes) {
    return {width, height, samples, planes};
}

}  // namespace tandem
