#include "tandem/backends/backend_ahead.h"

#include <chrono>
#include <future>
#include <utility>

#include "tandem/backends/make_backend.h"

namespace tandem {

namespace {

class Ahead final : public BackendAhead {
  public:
    Ahead(const std::string& name, const BackendOptions& options)
        : made_(std::async(std::launch::async,
                           [name, options] { return std::shared_ptr<Backend>(make_backend(name, options)); })) {}

    void check_so_far() const override {
        if (made_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) (void)get();
    }

    [[nodiscard]] std::string name() const override { return get().name(); }
    [[nodiscard]] Capabilities capabilities() const override { return get().capabilities(); }
    [[nodiscard]] std::shared_ptr<ResidentScene> load(const PreparedScene& scene, Tier tier) override {
        return get().load(scene, tier);
    }
    [[nodiscard]] std::shared_ptr<ResidentScene> load_shared(const std::shared_ptr<const PreparedScene>& scene,
                                                             Tier tier) override {
        return get().load_shared(scene, tier);
    }
    double trace(ResidentScene& scene, const TraceJob& job) override { return get().trace(scene, job); }
    [[nodiscard]] std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                       const RenderJob& job) override {
        return get().submit(std::move(scene), job);
    }
    [[nodiscard]] std::unique_ptr<PendingFrame> submit_to(Film film, int left, int top,
                                                          std::shared_ptr<ResidentScene> scene,
                                                          const RenderJob& job) override {
        return get().submit_to(std::move(film), left, top, std::move(scene), job);
    }
    [[nodiscard]] Film make_film(int width, int height, int samples, PlaneMask planes) override {
        return get().make_film(width, height, samples, planes);
    }
    [[nodiscard]] std::size_t frames_in_flight() const override { return get().frames_in_flight(); }

  private:
    [[nodiscard]] Backend& get() const { return *made_.get(); }

    std::shared_future<std::shared_ptr<Backend>> made_;
};

}  // namespace

std::unique_ptr<BackendAhead> make_backend_ahead(const std::string& name, const BackendOptions& options) {
    return std::make_unique<Ahead>(name, options);
}

}  // namespace tandem
