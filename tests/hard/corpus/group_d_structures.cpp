// Group D: bounds and hierarchies, which may only propose candidates. The oracle tests every primitive exactly.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hard/corpus/groups.h"
#include "hard/corpus/ray_batches.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/scene/named_scenes.h"

namespace tandem::hard {

namespace {

using test::any_unit;

constexpr const char* brute_force = "exact arithmetic, every primitive";

Vec3d in_cube(Random& random, double half) {
    return {random.uniform(-half, half), random.uniform(-half, half), random.uniform(-half, half)};
}

std::vector<Sphere> spheres_around(Random& random, const Vec3d& middle, double half, float radius, int count) {
    std::vector<Sphere> spheres;
    spheres.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) spheres.push_back({narrow(middle + in_cube(random, half)), radius});
    return spheres;
}

/// Along an axis, past a sphere at (1 - 2^-24) of its radius, where its bounds are exactly as wide as the sphere.
std::vector<RayBatch> poles(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (const double place : {1e2, 1e4, 1e6}) {
        const std::vector<Sphere> spheres = spheres_around(random, {place, place, place}, 64, 1, 128);
        batches.push_back({scene_of(spheres), make_rays(rays / 3, [&] {
                               const Sphere& s = spheres[random.below(128)];
                               const int along = static_cast<int>(random.below(3));
                               const int side = (along + 1 + static_cast<int>(random.below(2))) % 3;
                               const float sign = random.coin() ? 1.0F : -1.0F;
                               Ray<float> ray = {s.centre, {0, 0, 0}};
                               ray.origin[side] += sign * s.radius;
                               if (random.coin()) ray.origin[side] = std::nextafter(ray.origin[side], s.centre[side]);
                               ray.origin[along] -= static_cast<float>(std::exp2(random.uniform(2.0, 20.0)));
                               ray.direction[along] = 1;
                               return ray;
                           })});
    }
    return batches;
}

/// Just inside the edges of 64 cubes, from 10^3 to 10^6 away.
std::vector<RayBatch> edges_from_far(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    std::vector<Box> boxes;
    for (int i = 0; i < 64; ++i) {
        const Vec3f corner = {static_cast<float>(3 * (i % 4)), static_cast<float>(3 * (i / 4 % 4)),
                              static_cast<float>(3 * (i / 16))};
        boxes.push_back({corner, corner + Vec3f{2, 2, 2}});
    }
    for (const double distance : {1e3, 1e4, 1e5, 1e6}) {
        batches.push_back({scene_of({}, boxes), make_rays(rays / 4, [&] {
                               const Box& box = boxes[random.below(64)];
                               const Vec3d middle = (widen(box.lower) + widen(box.upper)) * 0.5;
                               Vec3d at = {random.coin() ? 1.0 : -1.0, random.coin() ? 1.0 : -1.0, 0};
                               at.z = random.uniform(-1.0, 1.0);
                               const int turn = static_cast<int>(random.below(3));
                               at = {at[turn], at[(turn + 1) % 3], at[(turn + 2) % 3]};
                               const Vec3d target = middle + at * (1 - std::exp2(random.uniform(-30.0, -10.0)));
                               const Vec3d origin = middle + any_unit(random) * distance;
                               return Ray<float>{narrow(origin), narrow(target - origin)};
                           })});
    }
    return batches;
}

/// At the corners of the bounds of 512 spheres: most of these rays run along the borders of node boxes.
std::vector<RayBatch> corners_of_bounds(Random& random, std::size_t rays) {
    const std::vector<Sphere> spheres = spheres_around(random, {3, -2, 7}, 10, 0.25F, 512);
    return {{scene_of(spheres), make_rays(rays, [&] {
                 const Aabb box = bounds(spheres[random.below(512)]);
                 const auto pick = [&](int i) { return random.coin() ? box.lower[i] : box.upper[i]; };
                 const Vec3f target = {pick(0), pick(1), pick(2)};
                 const Vec3f origin = narrow(in_cube(random, 30));
                 return Ray<float>{origin, target - origin};
             })}};
}

/// Components of 1e-19, -1e-19, 0 and -0 beside one of ordinary size.
std::vector<RayBatch> almost_along_axes(Random& random, std::size_t rays) {
    std::vector<Sphere> spheres = spheres_around(random, {0, 0, 0}, 8, 0.5F, 64);
    std::vector<Box> boxes;
    for (int i = 0; i < 64; ++i) {
        const Vec3f corner = {static_cast<float>(random.below(16)) - 8, static_cast<float>(random.below(16)) - 8,
                              static_cast<float>(random.below(16)) - 8};
        boxes.push_back({corner, corner + Vec3f{1, 1, 1}});
    }
    return {{scene_of(spheres, boxes), make_rays(rays, [&] {
                 static constexpr float small[] = {0.0F, -0.0F, 1e-19F, -1e-19F, 1e-30F, -1e-38F};
                 Ray<float> ray;
                 for (int i = 0; i < 3; ++i) {
                     ray.origin[i] =
                         random.coin() ? static_cast<float>(random.below(17)) - 8 : random.uniform(-8.0F, 8.0F);
                     ray.direction[i] = small[random.below(6)];
                 }
                 const int axis = static_cast<int>(random.below(3));
                 ray.direction[axis] = random.coin() ? 1.0F : -1.0F;
                 ray.origin[axis] = -20 * ray.direction[axis];
                 return ray;
             })}};
}

/// Sixteen equal spheres each, at eight places, in shuffled order: the lowest id.
std::vector<RayBatch> coincident(Random& random, std::size_t rays) {
    const std::vector<Sphere> places = spheres_around(random, {0, 0, 0}, 4, 1, 8);
    std::vector<Sphere> spheres(std::size_t{16} * 8);
    for (std::size_t i = 0; i < spheres.size(); ++i) spheres[i] = places[i * 5 % 8];
    return {{scene_of(spheres), make_rays(rays, [&] {
                 return test::aim(random, widen(places[random.below(8)].centre), 1, 20, random.uniform(0.0, 1.0)).ray;
             })}};
}

/// 256 boxes of all sizes whose lower faces lie in one plane: many candidates at the same t, among which culling by the
/// best so far must not lose the lowest id.
std::vector<RayBatch> coplanar(Random& random, std::size_t rays) {
    std::vector<Box> boxes;
    for (int i = 0; i < 256; ++i) {
        const Vec3f corner = {static_cast<float>(random.below(64)) / 4, static_cast<float>(random.below(64)) / 4, 5};
        const auto size = [&] { return static_cast<float>(1 + random.below(32)) / 4; };
        boxes.push_back({corner, corner + Vec3f{size(), size(), size()}});
    }
    return {{scene_of({}, boxes), make_rays(rays, [&] {
                 const Vec3f target = {random.uniform(0.0F, 20.0F), random.uniform(0.0F, 20.0F), 5};
                 const Vec3f origin = {random.uniform(0.0F, 20.0F), random.uniform(0.0F, 20.0F), -7};
                 return Ray<float>{origin, target - origin};
             })}};
}

/// The same rays all at once, one by one, and backwards: the same bits.
Score alone_and_together(const Subject& subject, Random& random, std::size_t count) {
    const std::vector<Sphere> spheres = spheres_around(random, {0, 0, 0}, 10, 0.5F, 512);
    const PreparedScene prepared = prepare(scene_of(spheres), {.origin = Vec3d{0, 0, 0}});
    const auto scene = subject.backend.load(prepared, subject.tier);
    std::vector<Ray<float>> rays = make_rays(count, [&] {
        const Vec3d origin = any_unit(random) * 30.0;
        return Ray<float>{narrow(origin), narrow(widen(spheres[random.below(512)].centre) - origin)};
    });
    const auto trace = [&](std::span<const Ray<float>> some) {
        std::vector<Hit> hits(some.size());
        subject.backend.trace(*scene, TraceJob{.rays = some, .hits = hits});
        return hits;
    };
    const std::vector<Hit> together = trace(rays);
    std::vector<Hit> alone;
    for (std::size_t i = 0; i < std::min<std::size_t>(count, 500); ++i) alone.push_back(trace({&rays[i], 1}).front());
    std::vector<Ray<float>> turned(rays.rbegin(), rays.rend());
    std::vector<Hit> backwards = trace(turned);
    std::reverse(backwards.begin(), backwards.end());
    const auto same = [](const Hit& a, const Hit& b) {
        return a.primitive == b.primitive && bits_of(a.t) == bits_of(b.t);
    };
    Score score;
    for (std::size_t i = 0; i < count; ++i) {
        const bool differs = !same(together[i], backwards[i]) || (i < alone.size() && !same(together[i], alone[i]));
        score.decide(differs, [&] { return to_literal(rays[i]); });
    }
    return score;
}

/// As many equal spheres as rays, at most a million: no plane separates them.
std::vector<RayBatch> one_point(Random& random, std::size_t rays) {
    const std::size_t count = std::clamp<std::size_t>(rays, 2000, 1'000'000);
    const std::vector<Sphere> spheres(count, {{1, 2, 3}, 0.5F});
    return {{scene_of(spheres), make_rays(std::min<std::size_t>(rays, 32), [&] {
                 return test::aim(random, {1, 2, 3}, 0.5, 5, random.uniform(0.0, 1.2)).ray;
             })}};
}

/// One sphere, whose bounds are not tested, and the same with 64 others behind it: the same bits.
Score one_or_many(const Subject& subject, Random& random, std::size_t count) {
    const Sphere body = {{1e4F, 0, 0}, 1};
    std::vector<Sphere> many = {body};
    for (int i = 0; i < 64; ++i) many.push_back({{3e4F, static_cast<float>(100 * i), 0}, 1});
    const std::vector<Ray<float>> rays = make_rays(count, [&] {
        const double impact = random.coin() ? 1 - std::exp2(random.uniform(-24.0, -4.0)) : random.uniform(0.0, 1.1);
        return test::aim(random, widen(body.centre), 1, std::exp2(random.uniform(2.0, 13.0)), impact).ray;
    });
    const auto trace = [&](const std::vector<Sphere>& spheres) {
        std::vector<Hit> hits(rays.size());
        subject.backend.trace(
            *subject.backend.load(prepare(scene_of(spheres), {.origin = Vec3d{0, 0, 0}}), subject.tier),
            TraceJob{.rays = rays, .hits = hits});
        return hits;
    };
    const std::vector<Hit> lone = trace({body});
    const std::vector<Hit> crowd = trace(many);
    Score score;
    for (std::size_t i = 0; i < count; ++i) {
        if (crowd[i].primitive != 0 && crowd[i].primitive != no_primitive) continue;  // behind it
        score.decide(lone[i].primitive != crowd[i].primitive || bits_of(lone[i].t) != bits_of(crowd[i].t),
                     [&] { return to_literal(rays[i]); });
    }
    return score;
}

/// Rays from outside of the bounds whose directions are small integers times down to 2^-140: the same hits as with the
/// direction of ordinary length, with t 2^k times as large, which may be beyond float.
Score minute_directions(const Subject& subject, Random& random, std::size_t count) {
    const PreparedScene prepared =
        prepare(scene_of(spheres_around(random, {0, 0, 0}, 10, 1, 64)), {.origin = Vec3d{0, 0, 0}});
    const auto resident = subject.backend.load(prepared, subject.tier);
    Score score;
    for (const int k : {0, 40, 100, 128, 140}) {
        const auto scale = static_cast<float>(std::exp2(-k));
        std::vector<Ray<float>> rays = make_rays(count / 5, [&] {
            const auto step = [&] { return static_cast<float>(random.below(17)) - 8; };
            const Vec3f direction = {step(), step(), step() + 0.5F};
            const Vec3f target = narrow(in_cube(random, 10));
            return Ray<float>{target - direction * static_cast<float>(8 << random.below(12)), direction};
        });
        const auto trace = [&](std::vector<double>& t) {
            std::vector<Hit> hits(rays.size());
            t.resize(rays.size());
            subject.backend.trace(*resident, TraceJob{.rays = rays, .hits = hits, .wide_t = t});
            return hits;
        };
        std::vector<double> right_t, t;
        const std::vector<Hit> right = trace(right_t);
        for (Ray<float>& ray : rays) ray.direction = ray.direction * scale;
        const std::vector<Hit> hits = trace(t);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            score.decide(hits[i].primitive != right[i].primitive || t[i] != right_t[i] * std::exp2(k),
                         [&] { return fmt::format("2^-{}: {}", k, to_literal(rays[i])); });
        }
    }
    return score;
}

/// Scattered frames of an animation, each compared with its own solids.
std::vector<RayBatch> frames(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (const std::int32_t frame : {0, 17, 63, 119}) {
        const PreparedScene prepared = prepare(named_scene("paper"), {.frame = frame, .camera = ""});
        batches.push_back(
            {scene_of(prepared.spheres, {}), make_rays(rays / 4, [&] {
                 const Sphere& s = prepared.spheres[random.below(static_cast<std::uint32_t>(prepared.spheres.size()))];
                 return test::aim(random, widen(s.centre), double{s.radius}, 6, random.uniform(0.0, 1.1)).ray;
             })});
    }
    return batches;
}

}  // namespace

std::vector<HardCase> structure_cases() {
    return {
        {"D1", "Poles of spheres at 100 to 10^6", "centre + radius rounds inward and cuts off the pole", brute_force,
         RayCase{poles}},
        {"D2", "Just inside the edges of cubes, from 10^3 to 10^6",
         "the error of the box test is the origin's last bit, which padding by the box's own size does not cover",
         brute_force, RayCase{edges_from_far, true}},
        {"D3", "Corners of the bounds of 512 spheres", "the rounding of 1/d makes the ray miss a box by one bit",
         brute_force, RayCase{corners_of_bounds}},
        {"D4", "Direction components of 0, -0 and 1e-19", "code replaces a small component and loses its sign",
         brute_force, RayCase{almost_along_axes}},
        {"D5", "Sixteen identical spheres", "the first one found wins, which is accidental",
         "exact arithmetic; the lowest id at equal t", RayCase{coincident}},
        {"D6", "256 boxes with a face in one plane",
         "culling by the best t so far drops a hit at equal t with a lower id",
         "exact arithmetic; the lowest id at equal t", RayCase{coplanar}},
        {"D7", "Rays together, alone and in reverse order", "packets use different instructions than single rays",
         "metamorphosis: equal bits", RenderCase{alone_and_together}},
        {"D9", "Thousands of spheres at one point",
         "no plane separates them: a stack overflows, or the build never ends", brute_force, RayCase{one_point}},
        {"D10", "One sphere, and the same one among 64",
         "a root that is a leaf has no bounds, which hides errors in them", "metamorphosis: equal bits",
         RenderCase{one_or_many}},
        {"D11", "Frames of an animation", "the structure has the bounds of another frame", brute_force,
         RayCase{frames}},
        {"D12", "Directions down to 2^-140, from outside",
         "distance over length is beyond float, the ray starts at infinity, and Embree aborts",
         "metamorphosis: the same direction, 2^k times as long", RenderCase{minute_directions}},
    };
}

}  // namespace tandem::hard
