#include "tandem/render/combined_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "tandem/compile/prepared_scene.h"
#include "tandem/render/combined_crew.h"

namespace tandem {

namespace {

PhaseTimes longest(PhaseTimes a, const PhaseTimes& b) {
    a.build = std::max(a.build, b.build);
    a.compile = std::max(a.compile, b.compile);
    a.upload = std::max(a.upload, b.upload);
    a.render = std::max(a.render, b.render);
    a.download = std::max(a.download, b.download);
    return a;
}

class CombinedFrame final : public PendingFrame {
  public:
    CombinedFrame(Crew& crew, std::shared_ptr<SharedFrame> frame) : crew_(crew), frame_(std::move(frame)) {}
    ~CombinedFrame() override { crew_.cancel(*frame_); }
    RenderResult get() override { return crew_.wait_for(*frame_); }

  private:
    Crew& crew_;
    std::shared_ptr<SharedFrame> frame_;
};

class CombinedBackend final : public Backend {
  public:
    CombinedBackend(std::vector<CombinedMember> members, const CombinedOptions& options)
        : crew_(std::move(members), options) {
        for (std::size_t i = 0; i < crew_.size(); ++i) own_.push_back(crew_.backend(i).capabilities());
    }

    [[nodiscard]] std::string name() const override { return crew_.backend(0).name(); }

    [[nodiscard]] Capabilities capabilities() const override {
        Capabilities all;
        all.members = crew_.works();
        all.description = own_.front().description;
        for (std::size_t i = 0; i < own_.size(); ++i) {
            MemberWork& work = all.members[i];
            work.device = own_[i].device;
            all.device += fmt::format("{}{}: {}", i == 0 ? "" : "; ", work.name, work.device);
            all.exact = all.exact && own_[i].exact;
        }
        return all;
    }

    [[nodiscard]] std::shared_ptr<ResidentScene> load(const PreparedScene& scene, Tier tier) override {
        auto result = std::make_shared<CombinedScene>(tier, crew_.size(), crew_);
        crew_.on_all([&](std::size_t member) {
            auto part = crew_.backend(member).load(scene, tier);
            crew_.locked([&] { result->parts[member] = std::move(part); });
        });
        return result;
    }

    double trace(ResidentScene& scene, const TraceJob& job) override {
        check(job);
        auto& combined = dynamic_cast<CombinedScene&>(scene);
        Division rays(job.rays.size());
        std::vector<double> seconds(crew_.size());
        // again if a member fails when others are done already
        while (!rays.is_empty()) {
            crew_.on_all([&](std::size_t member) { trace_parts(combined, job, member, rays, seconds[member]); });
        }
        return *std::max_element(seconds.begin(), seconds.end());
    }

    [[nodiscard]] std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                       const RenderJob& job) override {
        check(job, scene->tier());
        auto& combined = dynamic_cast<CombinedScene&>(*scene);
        const FilmWindow window = window_of(job);
        auto frame =
            std::make_shared<SharedFrame>(std::shared_ptr<CombinedScene>(std::move(scene), &combined), job,
                                          crew_.make_film(window.width, window.height, job.samples, job.planes));
        crew_.submit(frame);
        return std::make_unique<CombinedFrame>(crew_, std::move(frame));
    }

    [[nodiscard]] Film make_film(int width, int height, int samples, PlaneMask planes) override {
        return crew_.make_film(width, height, samples, planes);
    }

    [[nodiscard]] std::size_t frames_in_flight() const override {
        std::size_t frames = 0;
        for (std::size_t i = 0; i < crew_.size(); ++i) frames += crew_.backend(i).frames_in_flight();
        return frames;
    }

  private:
    /// Traces parts of the rays with a member until none are left.
    void trace_parts(CombinedScene& scene, const TraceJob& job, std::size_t member, Division& rays, double& seconds) {
        while (true) {
            const std::optional<Division::Part> part =
                crew_.locked([&] { return crew_.take_rays(scene, member, job.rays.size(), rays); });
            if (!part) return;
            RenderCounters counters;
            TraceJob own = tandem::part(job, part->first, part->count);
            own.counters = &counters;
            const Stopwatch watch;
            try {
                seconds += crew_.backend(member).trace(*scene.parts[member], own);
            } catch (...) {
                crew_.locked([&] { rays.give_back(*part); });
                throw;
            }
            crew_.locked([&] {
                scene.ray_paces[member].add(static_cast<double>(part->count), watch.seconds());
                crew_.count_rays(member, part->count);
                if (job.counters != nullptr) *job.counters += counters;
            });
        }
    }

    mutable Crew crew_;
    std::vector<Capabilities> own_;  ///< of the members
};

}  // namespace

PhaseTimes CombinedScene::load_times() const {
    std::vector<PhaseTimes> times(parts.size());
    crew_.on_all([&](std::size_t member) {
        if (parts[member]) times[member] = parts[member]->load_times();
    });
    return std::accumulate(times.begin(), times.end(), PhaseTimes{}, longest);
}

std::unique_ptr<Backend> make_combined_backend(std::vector<CombinedMember> members, const CombinedOptions& options) {
    return std::make_unique<CombinedBackend>(std::move(members), options);
}

}  // namespace tandem
