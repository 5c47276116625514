#include "tandem/render/tiled_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/base/seconds.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

class TileRender {
  public:
    TileRender(Backend& backend, TiledFilm& film, TileCosts& costs, const std::function<bool()>& after_tile)
        : backend_(backend), film_(film), costs_(costs), after_tile_(after_tile) {}
    ~TileRender() {
        // Only after an exception: waits for the tiles that the backend still renders.
        for (const auto& tile : flying_) {
            try {
                (void)tile.second->get();
            } catch (...) {
            }
        }
    }
    TileRender(const TileRender&) = delete;
    TileRender& operator=(const TileRender&) = delete;

    /// Renders the samples of an instant, for the tiles that have `before` samples. False if after_tile stopped it.
    bool render(const Scene& scene, const FrameInstant& instant, int before) {
        std::shared_ptr<ResidentScene> resident;
        for (std::size_t i = 0; i < film_.grid().count() && goes_on_; ++i) {
            if (film_.samples(i) != before) continue;
            if (!resident) resident = load(scene, instant);
            RenderJob job = instant.job;
            job.window = film_.grid().tile(i);
            if (flying_.size() >= backend_.frames_in_flight()) take_oldest();
            if (goes_on_) flying_.emplace_back(i, backend_.submit(resident, job));
        }
        while (!flying_.empty()) take_oldest();
        return goes_on_;
    }

  private:
    std::shared_ptr<ResidentScene> load(const Scene& scene, const FrameInstant& instant) {
        const Stopwatch watch;
        const PreparedScene prepared = prepare(scene, instant.prepare);
        costs_.prepare += watch.seconds();
        auto resident = backend_.load(prepared, instant.job.tier);
        tandem::add(costs_.load, resident->load_times());
        return resident;
    }

    void take_oldest() {
        auto [index, pending] = std::move(flying_.front());
        flying_.pop_front();
        const RenderResult part = pending->get();
        film_.add(index, part.film);
        tandem::add(costs_.stats, part.stats);
        goes_on_ = after_tile_() && goes_on_;
    }

    Backend& backend_;
    TiledFilm& film_;
    TileCosts& costs_;
    const std::function<bool()>& after_tile_;
    std::deque<std::pair<std::size_t, std::unique_ptr<PendingFrame>>> flying_;
    bool goes_on_ = true;
};

/// Throws InputError unless an instant of the plan ends after the samples of each tile.
void check_ends(const FramePlan& plan, const TiledFilm& film) {
    for (std::size_t i = 0; i < film.grid().count(); ++i) {
        const int samples = film.samples(i);
        int end = 0;
        for (const FrameInstant& instant : plan.instants) {
            if (end < samples) end += instant.job.samples;
        }
        if (end != samples) {
            throw InputError(fmt::format(
                "tile {} has {} samples per pixel, but no instant of the frame ends after that many; begin it again", i,
                samples));
        }
    }
}

}  // namespace

int tile_edge_for(int samples) {
    constexpr std::int64_t most = 1 << 25;
    int edge = 512;
    while (edge > 16 && std::int64_t{edge} * edge * samples > most) edge /= 2;
    return edge;
}

bool render_tiles(Backend& backend, const Scene& scene, const FramePlan& plan, TiledFilm& film, TileCosts& costs,
                  const std::function<bool()>& after_tile) {
    const DefaultFpEnvironment guard;
    check_ends(plan, film);
    int before = 0;
    for (const FrameInstant& instant : plan.instants) {
        if (!TileRender(backend, film, costs, after_tile).render(scene, instant, before)) break;
        before += instant.job.samples;
    }
    RenderStats& stats = costs.stats;
    stats.effects |= plan.effects;
    stats.carried = stats.carried - stats.effects;
    const std::vector<int> samples = film.samples();
    int all = 0;
    for (const FrameInstant& instant : plan.instants) all += instant.job.samples;
    return std::all_of(samples.begin(), samples.end(), [&](int n) { return n == all; });
}

}  // namespace tandem
