#include "tandem/render/motion_blur.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <utility>

#include "tandem/base/seconds.h"
#include "tandem/base/sha256.h"
#include "tandem/compile/derive.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/math/fp_environment.h"
#include "tandem/scene/camera_node.h"
#include "tandem/scene/motion.h"

namespace tandem {

namespace {

constexpr std::size_t most_in_flight = 2;

/// The instants of one frame in a backend.
class Exposure {
  public:
    Exposure(Backend& backend, const FramePlan& plan) : backend_(backend), plan_(plan) {}
    ~Exposure() {
        // Only after an exception: waits for the frames that the backend still renders.
        for (const auto& frame : flying_) {
            try {
                (void)frame->get();
            } catch (...) {
            }
        }
    }
    Exposure(const Exposure&) = delete;
    Exposure& operator=(const Exposure&) = delete;

    RenderedFrame render(const Scene& scene, FrameHash* hash) {
        for (const FrameInstant& instant : plan_.instants) {
            const Stopwatch watch;
            const PreparedScene prepared = prepare(scene, instant.prepare);
            if (hash != nullptr) hash->add(prepared);
            frame_.prepare += watch.seconds();
            if (flying_.size() == most_in_flight) take_oldest();
            auto resident = backend_.load(prepared, instant.job.tier);
            add(frame_.load, resident->load_times());
            flying_.push_back(backend_.submit(std::move(resident), instant.job));
        }
        while (!flying_.empty()) take_oldest();
        RenderStats& stats = frame_.result.stats;
        stats.effects |= plan_.effects;
        stats.carried = stats.carried - stats.effects;
        return std::move(frame_);
    }

  private:
    void take_oldest() {
        const std::unique_ptr<PendingFrame> pending = std::move(flying_.front());
        flying_.pop_front();
        RenderResult part = pending->get();
        add(frame_.result.stats, part.stats);
        Film& film = frame_.result.film;
        if (film.pixel_count() == 0) {
            film = std::move(part.film);
        } else {
            film.add(part.film);
        }
    }

    Backend& backend_;
    const FramePlan& plan_;
    std::deque<std::unique_ptr<PendingFrame>> flying_;
    RenderedFrame frame_;
};

}  // namespace

FramePlan plan_frame(const Scene& scene, const PrepareOptions& options, const RenderJob& job) {
    const DefaultFpEnvironment guard;
    const EffectMask forced = options.effects.on & host_effects;
    FramePlan at_once{{{options, job}}, forced};
    if (options.time || options.effects.off.has(Effect::motion_blur)) return at_once;
    const std::size_t camera = camera_node(scene, options.camera);
    const Shutter& shutter = shutter_of(*scene.nodes[camera].camera);
    if (!is_open(shutter)) return at_once;
    check(scene);
    check(job);
    const double time = time_of_frame(scene, options.frame);
    if (nodes_in_motion(scene, camera, time).empty()) return at_once;

    FramePlan plan{{}, forced | Effect::motion_blur};
    const int count = std::min(shutter.instants, job.samples);
    const auto first_of = [&](int instant) { return static_cast<int>(std::int64_t{job.samples} * instant / count); };
    for (int i = 0; i < count; ++i) {
        FrameInstant& instant = plan.instants.emplace_back(FrameInstant{options, job});
        const int first = first_of(i), end = first_of(i + 1);
        const double part = (0.5 * first + 0.5 * end) / job.samples;
        instant.prepare.time = time + (shutter.open + (shutter.close - shutter.open) * part);
        instant.job.first_sample = job.first_sample + first;
        instant.job.samples = end - first;
    }
    return plan;
}

void FrameHash::add(const PreparedScene& instant) { hashes_.push_back(scene_hash(instant)); }

std::string FrameHash::get() const {
    if (!is_blurred(plan_)) return hashes_.front();
    Sha256 hash;
    for (std::size_t i = 0; i < hashes_.size(); ++i) {
        hash.update(hashes_[i].data(), hashes_[i].size());
        hash.update_value(std::int32_t{plan_.instants[i].job.samples});
    }
    return hash.hex();
}

std::string frame_hash(const Scene& scene, const FramePlan& plan) {
    FrameHash hash(plan);
    for (const FrameInstant& instant : plan.instants) hash.add(prepare(scene, instant.prepare));
    return hash.get();
}

RenderedFrame render_frame(Backend& backend, const Scene& scene, const FramePlan& plan, FrameHash* hash) {
    const DefaultFpEnvironment guard;
    return Exposure(backend, plan).render(scene, hash);
}

RenderedFrame render_frame(Backend& backend, const Scene& scene, const PrepareOptions& options, const RenderJob& job) {
    return render_frame(backend, scene, plan_frame(scene, options, job));
}

}  // namespace tandem
