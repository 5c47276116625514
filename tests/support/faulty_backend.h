/// A backend that is slow, or fails, where a test says so.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <latch>
#include <memory>
#include <thread>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/render/backend.h"

namespace tandem::test {

/// Calls are counted from 1; 0: none of them fails.
struct Faults {
    int load = 0, submit = 0, get = 0, trace = 0, load_times = 0;
    std::function<void()> throws = [] { throw EnvironmentError("the memory is full"); };
    std::chrono::microseconds delay{0};              ///< of each frame and each trace()
    std::shared_ptr<std::atomic<bool>> waits_for{};  ///< no frame is done before it is true
    std::shared_ptr<std::latch> start{};             ///< the first frame waits until others arrive there
};

/// Makes `other` wait until `bad` has thrown, so that `bad` gets work whatever the speed of the threads.
inline void wait_for_failure(Faults& other, Faults& bad) {
    other.waits_for = std::make_shared<std::atomic<bool>>(false);
    bad.throws = [thrown = other.waits_for, inner = bad.throws] {
        *thrown = true;
        inner();
    };
}

class FaultyBackend : public Backend {
  public:
    FaultyBackend(std::unique_ptr<Backend> inner, Faults faults)
        : inner_(std::move(inner)), faults_(std::move(faults)) {}

    [[nodiscard]] std::string name() const override { return inner_->name(); }
    [[nodiscard]] Capabilities capabilities() const override { return inner_->capabilities(); }

    [[nodiscard]] std::shared_ptr<ResidentScene> load(const PreparedScene& scene, Tier tier) override {
        count(loads_, faults_.load);
        return std::make_shared<Loaded>(inner_->load(scene, tier), *this);
    }
    double trace(ResidentScene& scene, const TraceJob& job) override {
        std::this_thread::sleep_for(faults_.delay);
        count(traces_, faults_.trace);
        return inner_->trace(*dynamic_cast<Loaded&>(scene).inner, job);
    }
    [[nodiscard]] std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                       const RenderJob& job) override {
        count_submit();
        return std::make_unique<Frame>(inner_->submit(dynamic_cast<Loaded&>(*scene).inner, job), *this);
    }
    [[nodiscard]] std::unique_ptr<PendingFrame> submit_to(Film film, int left, int top,
                                                          std::shared_ptr<ResidentScene> scene,
                                                          const RenderJob& job) override {
        count_submit();
        const auto part = dynamic_cast<Loaded&>(*scene).inner;
        return std::make_unique<Frame>(inner_->submit_to(std::move(film), left, top, part, job), *this);
    }
    [[nodiscard]] Film make_film(int width, int height, int samples, PlaneMask planes) override {
        return inner_->make_film(width, height, samples, planes);
    }

  private:
    struct Loaded final : ResidentScene {
        Loaded(std::shared_ptr<ResidentScene> of, FaultyBackend& with)
            : ResidentScene(of->tier()), inner(std::move(of)), backend(with) {}
        [[nodiscard]] PhaseTimes load_times() const override {
            backend.count(backend.times_, backend.faults_.load_times);
            return inner->load_times();
        }
        std::shared_ptr<ResidentScene> inner;
        FaultyBackend& backend;
    };
    struct Frame final : PendingFrame {
        Frame(std::unique_ptr<PendingFrame> of, FaultyBackend& with) : inner(std::move(of)), backend(with) {}
        RenderResult get() override {
            std::this_thread::sleep_for(backend.faults_.delay);
            backend.wait();
            backend.count(backend.gets_, backend.faults_.get);
            return inner->get();
        }
        std::unique_ptr<PendingFrame> inner;
        FaultyBackend& backend;
    };

    void count_submit() {
        if (submits_ == 0 && faults_.start) faults_.start->arrive_and_wait();
        count(submits_, faults_.submit);
    }
    void wait() const {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (faults_.waits_for && !*faults_.waits_for && std::chrono::steady_clock::now() < end) {
            std::this_thread::sleep_for(std::chrono::microseconds(100));
        }
    }
    void count(std::atomic<int>& calls, int bad) const {
        if (++calls == bad) faults_.throws();
    }

    std::unique_ptr<Backend> inner_;
    Faults faults_;
    std::atomic<int> loads_ = 0, submits_ = 0, gets_ = 0, traces_ = 0, times_ = 0;
};

}  // namespace tandem::test
