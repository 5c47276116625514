/// A backend that sets a flag, as a signal would, when it has been given some frames or tiles.
#pragma once

#include <atomic>
#include <memory>
#include <utility>

#include "tandem/compile/prepared_scene.h"
#include "tandem/render/backend.h"

namespace tandem::test {

class InterruptingBackend : public Backend {
  public:
    InterruptingBackend(std::unique_ptr<Backend> inner, int after, std::atomic<bool>& flag)
        : inner_(std::move(inner)), left_(after), flag_(flag) {}

    [[nodiscard]] std::string name() const override { return inner_->name(); }
    [[nodiscard]] Capabilities capabilities() const override { return inner_->capabilities(); }
    [[nodiscard]] std::shared_ptr<ResidentScene> load(const PreparedScene& scene, Tier tier) override {
        return inner_->load(scene, tier);
    }
    double trace(ResidentScene& scene, const TraceJob& job) override { return inner_->trace(scene, job); }
    [[nodiscard]] std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                       const RenderJob& job) override {
        if (--left_ == 0) flag_ = true;
        return inner_->submit(std::move(scene), job);
    }

  private:
    std::unique_ptr<Backend> inner_;
    int left_;
    std::atomic<bool>& flag_;
};

}  // namespace tandem::test
