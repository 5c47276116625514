#include "tandem/render/backend.h"

#include <utility>

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

}  // namespace

std::unique_ptr<PendingFrame> Backend::submit_to(Film film, int left, int top, std::shared_ptr<ResidentScene> scene,
                                                 const RenderJob& job) {
    return std::make_unique<CopiedFrame>(submit(std::move(scene), job), std::move(film), left, top);
}

Film Backend::make_film(int width, int height, int samples, PlaneMask planes) {
    return {width, height, samples, planes};
}

}  // namespace tandem
