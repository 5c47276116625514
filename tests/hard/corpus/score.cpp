#include "hard/corpus/score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tandem/math/ulp.h"

namespace tandem::hard {

double Score::median_ulps() const {
    if (ulps_.empty()) return 0;
    std::vector<double> sorted = ulps_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
}

void Score::add(const Score& other) {
    tried += other.tried;
    unjudged += other.unjudged;
    wrong += other.wrong;
    leaks += other.leaks;
    nans += other.nans;
    refused += other.refused;
    seconds += other.seconds;
    if (first_failure.empty()) first_failure = other.first_failure;
    if (other.worst_ > worst_ || ulps_.empty()) {
        worst_ = other.worst_;
        worst_description_ = other.worst_description_;
    }
    ulps_.insert(ulps_.end(), other.ulps_.begin(), other.ulps_.end());
}

double ulps_from(float value, double right) {
    const float nearest = static_cast<float>(right);
    if (std::isinf(nearest) || !std::isfinite(value)) return nearest == value ? 0 : HUGE_VAL;
    return error_in_ulp(value, right);
}

std::string to_literal(const Ray<float>& ray) {
    const auto literal = [](const Vec3f& v) {
        return fmt::format("{{{:a}F, {:a}F, {:a}F}}", double{v.x}, double{v.y}, double{v.z});
    };
    return fmt::format("Ray<float>{{{}, {}}}", literal(ray.origin), literal(ray.direction));
}

namespace {

std::string name_of(std::uint32_t primitive) {
    if (primitive == refused_primitive) return "nothing at all";
    return primitive == no_primitive ? "a miss" : fmt::format("primitive {}", primitive);
}

std::string describe(const Ray<float>& ray, const Answer& answer, const Hit& hit) {
    return fmt::format("{}: {} at t = {:a}, but {} at t = {:a} is right", to_literal(ray), name_of(hit.primitive),
                       double{hit.t}, name_of(answer.primitive), double{answer.t});
}

}  // namespace

Score score_hits(std::span<const Ray<float>> rays, std::span<const Answer> answers, std::span<const Hit> hits,
                 bool watertight) {
    Score score;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Answer& answer = answers[i];
        const Hit& hit = hits[i];
        const auto line = [&] { return describe(rays[i], answer, hit); };
        if (std::isnan(hit.t)) ++score.nans;
        if (!(answer.judged & judged_hit)) {
            ++score.tried;
            ++score.unjudged;
            continue;
        }
        const bool should_hit = answer.primitive != no_primitive;
        const bool refused = hit.primitive == refused_primitive;
        const bool hits_something = hit.primitive != no_primitive && !refused;
        const bool another = (answer.judged & judged_primitive) && hit.primitive != answer.primitive;
        const bool wrong = refused || hits_something != should_hit || (should_hit && another);
        score.decide(wrong, line);
        score.refused += refused;
        score.leaks += watertight && should_hit && hit.primitive == no_primitive;
        if (!wrong && should_hit && (answer.judged & judged_t)) {
            score.measure(std::isnan(hit.t) ? HUGE_VAL : ulps_from(hit.t, answer.wide_t), line);
        }
    }
    return score;
}

}  // namespace tandem::hard
