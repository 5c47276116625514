#include <algorithm>
#include <atomic>
#include <cstring>
#include <optional>
#include <thread>

#include "hard/corpus/answer.h"
#include "support/exact_geometry.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem::hard {

namespace {

using test::Big;
using test::BigVector;

using Long = long double;

/// A bounding ball of a primitive, with a margin.
struct Ball {
    Vec3d centre;
    Long radius;
};

Ball ball_around(const Aabb& box) {
    const Vec3d lower = widen(box.lower);
    const Vec3d upper = widen(box.upper);
    const Vec3d half = (upper - lower) * 0.5;
    return {(lower + upper) * 0.5,
            1.001L * std::sqrt(Long{half.x} * half.x + Long{half.y} * half.y + Long{half.z} * half.z)};
}

/// True only if the line misses the ball by far more than the error of this arithmetic.
bool surely_misses(const Ball& ball, const Ray<float>& ray) {
    const Long f[3] = {ray.origin.x - Long{ball.centre.x}, ray.origin.y - Long{ball.centre.y},
                       ray.origin.z - Long{ball.centre.z}};
    const Long d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    const Long m[3] = {f[1] * d[2] - f[2] * d[1], f[2] * d[0] - f[0] * d[2], f[0] * d[1] - f[1] * d[0]};
    const Long reach = ball.radius + 1e-12L * (std::abs(f[0]) + std::abs(f[1]) + std::abs(f[2]));
    const auto square = [](const Long(&v)[3]) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; };
    return square(m) > reach * reach * square(d);
}

std::optional<Big> crossing_t(const BigVector& origin, const BigVector& direction, bool is_box, double size) {
    if (!is_box) return test::hit_ball(origin, direction, Big(size));
    const auto hit = test::hit_box(origin, direction, {-size, -size, -size}, {size, size, size});
    return hit ? std::optional<Big>(hit->t) : std::nullopt;
}

float rounded(const Big& t) { return mpfr_get_flt(t.backend().data(), MPFR_RNDN); }

/// The hit of one primitive.
struct Crossing {
    std::optional<Big> t;
    std::uint8_t judged = judged_all;
};

Crossing cross_placed(const Placement& placement, bool is_box, const Ray<float>& ray) {
    const BigVector origin = placement.object_from_world * (test::big(ray.origin) - test::big(placement.centre));
    const BigVector direction = placement.object_from_world * test::big(ray.direction);
    const auto smaller = crossing_t(origin, direction, is_box, 1 - 0x1p-30);
    const auto larger = crossing_t(origin, direction, is_box, 1 + 0x1p-30);
    Crossing result = {crossing_t(origin, direction, is_box, 1)};
    if (smaller.has_value() != larger.has_value() || result.t.has_value() != larger.has_value()) {
        result.judged = 0;
    } else if (result.t && abs(*smaller - *larger) > abs(*result.t) * Big(0x1p-26)) {
        result.judged = judged_hit | judged_primitive;
    }
    return result;
}

/// The exact hit, by the type of the primitive.
struct CrossExactly {
    const Ray<float>& ray;
    BigVector origin = test::big(ray.origin);
    BigVector direction = test::big(ray.direction);
    Crossing result{};

    void operator()(const Sphere& s) {
        result.t = test::hit_ball(origin - test::big(s.centre), direction, Big(s.radius));
    }
    void operator()(const Box& b) {
        const auto hit = test::hit_box(origin, direction, test::big(b.lower), test::big(b.upper));
        if (hit) result.t = hit->t;
    }
    void operator()(const Ellipsoid& e) { result = cross_placed(e, false, ray); }
    void operator()(const Parallelepiped& p) { result = cross_placed(p, true, ray); }
    void operator()(const Triangle& t) { result.t = cross_triangle(t.v0, t.v1, t.v2); }
    void operator()(const Quad& q) {
        result.t = cross_triangle(q.v0, q.v1, q.v2);
        const std::optional<Big> other = cross_triangle(q.v0, q.v2, q.v3);
        if (other && (!result.t || *other < *result.t)) result.t = other;
    }

  private:
    [[nodiscard]] std::optional<Big> cross_triangle(const Vec3f& v0, const Vec3f& v1, const Vec3f& v2) const {
        const auto hit = test::hit_triangle(origin, direction, test::big(v0), test::big(v1), test::big(v2));
        return hit ? std::optional<Big>(hit->t) : std::nullopt;
    }
};

Crossing cross(const SceneView& scene, std::uint32_t id, const Ray<float>& ray) {
    CrossExactly crossing{ray};
    visit_primitive(scene, id, [&](const auto& primitive) { crossing(primitive); });
    return crossing.result;
}

/// Whether equal hits of two primitives come from the same arithmetic, so that every program finds them equal.
bool same_arithmetic(const SceneView& scene, std::uint32_t a, std::uint32_t b) {
    if (a < scene.sphere_count && b < scene.sphere_count) {
        // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): bits, not values
        return std::memcmp(&scene.spheres[a], &scene.spheres[b], sizeof(Sphere)) == 0;
    }
    const auto is_box = [&](std::uint32_t id) {
        return id >= scene.sphere_count && id - scene.sphere_count < scene.box_count;
    };
    const std::uint32_t faces = primitive_count(scene) - scene.triangle_count - scene.quad_count;
    return (is_box(a) && is_box(b)) || (a >= faces && b >= faces);
}

/// Of consecutive equal spheres only the first can be the answer.
bool repeats_the_one_before(const SceneView& scene, std::uint32_t id) {
    return id > 0 && id < scene.sphere_count && same_arithmetic(scene, id - 1, id);
}

Answer exact_answer(const SceneView& scene, std::span<const Ball> balls, const Ray<float>& ray) {
    Answer answer;
    if (!is_traceable(ray)) return answer;
    struct Candidate {
        Big t;
        std::uint32_t primitive;
        std::uint8_t judged;
    };
    std::vector<Candidate> candidates;
    std::uint8_t judged = judged_all;
    for (std::uint32_t id = 0; id < balls.size(); ++id) {
        if (repeats_the_one_before(scene, id) || surely_misses(balls[id], ray)) continue;
        Crossing crossing = cross(scene, id, ray);
        if (crossing.judged == 0) judged = 0;  // a solid that may or may not be in front of all others
        if (crossing.t) candidates.push_back({*crossing.t, id, crossing.judged});
    }
    answer.judged = judged;
    if (candidates.empty()) return answer;
    const auto nearest = std::min_element(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
        return a.t < b.t || (a.t == b.t && a.primitive < b.primitive);
    });
    for (const Candidate& other : candidates) {
        if (other.primitive == nearest->primitive || other.t > nearest->t * Big(1 + 0x1p-48)) continue;
        const bool tie = other.t == nearest->t && same_arithmetic(scene, other.primitive, nearest->primitive);
        if (!tie) answer.judged &= static_cast<std::uint8_t>(~judged_primitive);
    }
    answer.judged &= nearest->judged;
    answer.primitive = nearest->primitive;
    answer.t = rounded(nearest->t);
    answer.wide_t = mpfr_get_d(nearest->t.backend().data(), MPFR_RNDN);
    return answer;
}

}  // namespace

std::vector<Answer> exact_answers(const PreparedScene& scene, std::span<const Ray<float>> rays) {
    const SceneView window = view(scene);
    std::vector<Ball> balls(primitive_count(window));
    for (std::uint32_t id = 0; id < balls.size(); ++id) balls[id] = ball_around(primitive_bounds(window, id));
    std::vector<Answer> answers(rays.size());
    constexpr std::size_t block = 64;
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t first = next.fetch_add(block); first < rays.size(); first = next.fetch_add(block)) {
            const std::size_t end = std::min(first + block, rays.size());
            for (std::size_t i = first; i < end; ++i) answers[i] = exact_answer(window, balls, rays[i]);
        }
        mpfr_free_cache();
    };
    std::vector<std::jthread> helpers;
    for (unsigned int i = 1; i < std::thread::hardware_concurrency(); ++i) helpers.emplace_back(work);
    work();
    helpers.clear();
    return answers;
}

}  // namespace tandem::hard
