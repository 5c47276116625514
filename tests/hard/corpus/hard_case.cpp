#include "hard/corpus/hard_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hard/corpus/groups.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem::hard {

namespace {

/// The same numbers for a case in every run, others for every case.
Random random_for(const HardCase& hard_case) {
    std::uint64_t seed = 0;
    for (const char c : hard_case.id) seed = seed * 131 + static_cast<unsigned char>(c);
    return Random(seed);
}

/// Letter and number.
std::pair<char, int> place(const HardCase& hard_case) {
    return {hard_case.id.front(), std::stoi(hard_case.id.substr(1))};
}

bool matches(const std::string& id, const std::string& pattern) {
    if (!pattern.empty() && pattern.back() == '*') return id.starts_with(pattern.substr(0, pattern.size() - 1));
    return id == pattern;
}

}  // namespace

const std::vector<HardCase>& corpus() {
    static const std::vector<HardCase> all = [] {
        std::vector<HardCase> list;
        for (const auto& group :
             {sphere_cases(), box_cases(), face_cases(), structure_cases(), leaving_cases(), dielectric_cases(),
              shading_cases(), camera_cases(), film_cases(), transform_cases(), input_cases(), parity_cases(),
              light_cases(), light_surface_cases(), light_obstacle_cases()}) {
            list.insert(list.end(), group.begin(), group.end());
        }
        // the cases of a group may stand in several files
        std::sort(list.begin(), list.end(), [](const HardCase& a, const HardCase& b) { return place(a) < place(b); });
        return list;
    }();
    return all;
}

std::vector<const HardCase*> select_cases(const std::vector<std::string>& patterns) {
    std::vector<const HardCase*> selected;
    for (const std::string& pattern : patterns) {
        const bool any = std::any_of(corpus().begin(), corpus().end(),
                                     [&](const HardCase& hard_case) { return matches(hard_case.id, pattern); });
        if (!any) {
            throw InputError(fmt::format("no hard case is named '{}'; the cases are {} to {}, A* is a group", pattern,
                                         corpus().front().id, corpus().back().id));
        }
    }
    for (const HardCase& hard_case : corpus()) {
        const bool wanted = patterns.empty() || std::any_of(patterns.begin(), patterns.end(), [&](const auto& pattern) {
                                return matches(hard_case.id, pattern);
                            });
        if (wanted) selected.push_back(&hard_case);
    }
    return selected;
}

std::vector<AnsweredBatch> answered_batches(const HardCase& hard_case, std::size_t rays) {
    Random random = random_for(hard_case);
    std::vector<AnsweredBatch> result;
    for (RayBatch& batch : std::get<RayCase>(hard_case.body).make(random, rays)) {
        PreparedScene prepared = prepare(batch.scene, {.origin = Vec3d{0, 0, 0}});  // rays are in world space
        std::vector<Answer> answers = exact_answers(prepared, batch.rays);
        result.push_back({std::move(batch.scene), std::move(prepared), std::move(batch.rays), std::move(answers)});
    }
    return result;
}

Score try_rays(const HardCase& hard_case, const std::vector<AnsweredBatch>& batches, Backend& backend, Tier tier) {
    const bool watertight = std::get<RayCase>(hard_case.body).watertight;
    Score score;
    for (const AnsweredBatch& batch : batches) {
        const auto scene = backend.load(batch.prepared, tier);
        std::vector<Hit> hits(batch.rays.size());
        const double seconds = backend.trace(*scene, TraceJob{.rays = batch.rays, .hits = hits});
        Score of_batch = score_hits(batch.rays, batch.answers, hits, watertight);
        of_batch.seconds = seconds;
        score.add(of_batch);
    }
    return score;
}

Score try_functions(const HardCase& hard_case, Tier tier, std::size_t calls) {
    Random random = random_for(hard_case);
    return std::get<FunctionCase>(hard_case.body).run(random, calls, tier);
}

Score try_pictures(const HardCase& hard_case, const Subject& subject, std::size_t rays) {
    Random random = random_for(hard_case);
    return std::get<RenderCase>(hard_case.body).run(subject, random, rays);
}

}  // namespace tandem::hard
