// Group E: rays that leave surfaces. An offset of the origin that is too small gives false shadows (acne), one that is
// too large lets light leak through touching surfaces, and no offset is right at every scale. The host makes the rays
// like the path loop (kernel/spawn_ray.h); the backend traces them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "hard/corpus/groups.h"
#include "hard/corpus/ray_batches.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/bsdf/reflect.h"
#include "tandem/kernel/bsdf/refract.h"
#include "tandem/kernel/spawn_ray.h"
#include "tandem/kernel/traversal/intersect.h"
#include "tandem/scene/icosphere.h"

namespace tandem::hard {

namespace {

using test::any_across;
using test::any_unit;
using Point = SurfacePoint<float>;

PreparedScene in_world(const Scene& scene) { return prepare(scene, {.origin = Vec3d{0, 0, 0}}); }

Vec3d with_cosine(const Vec3d& axis, double cosine, Random& random) {
    return axis * cosine + any_across(random, axis) * std::sqrt((1 - cosine) * (1 + cosine));
}

/// Rays that leave surfaces, with their sources and ends.
struct Departures {
    std::vector<Ray<float>> rays;
    std::vector<RaySource> sources;
    std::vector<RayEnd> ends;  ///< of shadow rays

    void add(const SpawnedRay<float>& spawned) {
        rays.push_back(spawned.ray);
        sources.push_back(spawned.source);
    }
    void add(const ShadowRay<float>& shadow) {
        rays.push_back(shadow.ray);
        sources.push_back(shadow.source);
        ends.push_back({shadow.t_max, shadow.source.light});
    }

    [[nodiscard]] std::vector<Hit> trace(const Subject& subject, ResidentScene& scene, Score& score,
                                         std::vector<double>* wide_t = nullptr) const {
        std::vector<Hit> hits(rays.size());
        if (wide_t != nullptr) wide_t->resize(rays.size());
        RenderCounters counters;
        score.seconds +=
            subject.backend.trace(scene, {.rays = rays,
                                          .hits = hits,
                                          .sources = sources,
                                          .ends = ends,
                                          .wide_t = wide_t != nullptr ? std::span(*wide_t) : std::span<double>{},
                                          .counters = &counters});
        return hits;
    }
};

/// Shadow rays with the correct answers.
class Shadows {
  public:
    void add(const ShadowRay<float>& shadow, bool blocked) {
        departures_.add(shadow);
        blocked_.push_back(blocked);
    }
    void judge(const Subject& subject, const PreparedScene& prepared, Score& score) const {
        const auto hits = departures_.trace(subject, *subject.backend.load(prepared, subject.tier), score);
        for (std::size_t i = 0; i < hits.size(); ++i) {
            const bool blocked = hits[i].primitive != no_primitive;
            score.leaks += blocked_[i] && !blocked;
            score.decide(blocked != blocked_[i], [&] {
                return fmt::format("{}: a shadow ray {}, from primitive {}{}", to_literal(departures_.rays[i]),
                                   blocked ? "is blocked" : "goes through", departures_.sources[i].primitive,
                                   departures_.sources[i].inside ? ", inward" : "");
            });
        }
    }

  private:
    Departures departures_;
    std::vector<bool> blocked_;
};

/// The first hit point of a ray; empty for a miss. The host decides, in the tier `strict`.
std::optional<Point> seen_point(const SceneView& scene, const Ray<float>& ray) {
    const Closest<float> hit = LoopTracer{scene}.closest(ray, NoSource{}, true);
    if (hit.primitive == no_primitive) return std::nullopt;
    return surface_point(scene, ray, NoSource{}, hit, true);
}

/// The size and distance of a sphere that a camera at the world's origin looks at.
struct Place {
    double radius;
    double distance;  ///< of the centre
};

/// A sphere at a position, and its points that the camera sees.
class SeenSphere {
  public:
    SeenSphere(const Place& place, Random& random)
        : sphere{narrow(any_unit(random) * place.distance), static_cast<float>(place.radius)},
          alone_(in_world(scene_of({sphere}))) {}

    [[nodiscard]] Point any_point(Random& random) const {
        while (true) {
            const Vec3d aside = any_unit(random) * (double{sphere.radius} * random.uniform(0.0, 1.0));
            if (const auto point = seen_point(view(alone_), {{0, 0, 0}, narrow(widen(sphere.centre) + aside)})) {
                return *point;
            }
        }
    }

    const Sphere sphere;

  private:
    PreparedScene alone_;
};

/// A point light in a direction from a point, 3 to 10^4 radii away.
Vec3f light_towards(const Point& point, const Vec3d& direction, double radius, Random& random) {
    return narrow(widen(point.position) + direction * (radius * std::pow(10.0, random.uniform(0.5, 4.0))));
}

/// Lights above the horizon are visible and lights below are not, down to a cosine of 1e-4. Balls inside the sphere,
/// which no ray above the horizon can hit, make the backend build an acceleration structure.
void try_horizon(const Subject& subject, const Place& place, Random& random, std::size_t rays, Score& score) {
    const SeenSphere seen(place, random);
    Shadows shadows;
    for (std::size_t i = 0; i < rays; ++i) {
        const Point point = seen.any_point(random);
        const double cosine = std::pow(10.0, random.uniform(-4.0, 0.0)) * (random.coin() ? 1 : -1);
        const Vec3f light = light_towards(point, with_cosine(point.normal, cosine, random), place.radius, random);
        // a light that rounding brings below the horizon is below
        const auto shadow = spawn_shadow_ray(point, light, no_primitive);
        shadows.add(shadow, shadow.source.inside);
    }
    std::vector<Sphere> spheres = {seen.sphere};
    for (const Sphere& ball : shell(random, widen(seen.sphere.centre), 0.5 * place.radius)) spheres.push_back(ball);
    shadows.judge(subject, in_world(scene_of(spheres)), score);
}

/// 64 balls at a gap of 1e-5 radii from the sphere: none of them lets light through to the point below it.
void try_contact(const Subject& subject, const Place& place, Random& random, std::size_t rays, Score& score) {
    const SeenSphere seen(place, random);
    const double size = 0.1 * place.radius;
    std::vector<Sphere> spheres = {seen.sphere};
    std::vector<Point> below;
    while (below.size() < 64) {
        const Point point = seen.any_point(random);
        const Vec3d ball = widen(point.position) + point.normal * (size + 1e-5 * place.radius);
        spheres.push_back({narrow(ball), static_cast<float>(size)});
        below.push_back(point);
    }
    Shadows shadows;
    for (std::size_t i = 0; i < rays; ++i) {
        const Point& point = below[i % below.size()];
        const Vec3d up = with_cosine(point.normal, random.uniform(0.9, 1.0), random);
        shadows.add(spawn_shadow_ray(point, light_towards(point, up, place.radius, random), no_primitive), true);
    }
    shadows.judge(subject, in_world(scene_of(spheres)), score);
}

Score horizon(const Subject& subject, Random& random, std::size_t rays) {
    Score score;
    try_horizon(subject, {1, 3}, random, rays, score);
    return score;
}

Score contact(const Subject& subject, Random& random, std::size_t rays) {
    Score score;
    try_contact(subject, {1, 3}, random, rays, score);
    return score;
}

Score both_at(const Subject& subject, Random& random, std::size_t rays, std::initializer_list<Place> places) {
    Score score;
    const std::size_t share = rays / (2 * places.size());
    for (const Place& place : places) {
        try_horizon(subject, place, random, share, score);
        try_contact(subject, place, random, share, score);
    }
    return score;
}

Score tiny(const Subject& subject, Random& random, std::size_t rays) {
    return both_at(subject, random, rays, {{1e-3, 1}});
}
Score seen_from_far(const Subject& subject, Random& random, std::size_t rays) {
    return both_at(subject, random, rays, {{1, 1000}});
}
Score planet(const Subject& subject, Random& random, std::size_t rays) {
    return both_at(subject, random, rays, {{6.4e6, 6.400001e6}});
}
/// Neighbouring floats are 6e-5 and 8e-3 radii apart.
Score far_from_origin(const Subject& subject, Random& random, std::size_t rays) {
    return both_at(subject, random, rays, {{1, 1e3}, {1, 1e5}});
}

/// A square of 8 x 8 cells of edge 0.25, of triangles or of quads.
Mesh grid(bool quads) {
    Mesh mesh;
    for (int i = 0; i < 81; ++i) {
        mesh.positions.push_back({0.25F * static_cast<float>(i % 9) - 1, 0.25F * static_cast<float>(i / 9) - 1, 0});
    }
    for (std::uint32_t i = 0; i < 64; ++i) {
        const std::uint32_t a = 9 * (i / 8) + i % 8;
        if (quads) {
            mesh.quads.insert(mesh.quads.end(), {a, a + 1, a + 10, a + 9});
        } else {
            mesh.triangles.insert(mesh.triangles.end(), {a, a + 1, a + 10, a, a + 10, a + 9});
        }
    }
    return mesh;
}

/// A mesh, rotated, around (0, 0, -3) times `scale`, translated by `offset`.
Scene one_mesh(const Mesh& mesh, double scale, const Vec3d& offset) {
    Scene scene = scene_of({});
    scene.meshes.push_back(mesh);
    scene.nodes.push_back({.name = "mesh",
                           .trs = {Vec3d{0, 0, -3} * scale + offset, {0.1, 0.2, 0.3, 1}, Vec3d{1, 1, 1} * scale},
                           .geometry = {{MeshShape{0}, 0, {}}}});
    return scene;
}

std::vector<Vec3f> corners(const PreparedScene& scene, std::uint32_t id) {
    if (id < scene.triangles.size()) {
        const Triangle& t = scene.triangles[id];
        return {t.v0, t.v1, t.v2};
    }
    const Quad& q = scene.quads[id - scene.triangles.size()];
    return {q.v0, q.v1, q.v2, q.v3};
}

bool share_a_corner(const PreparedScene& scene, std::uint32_t a, std::uint32_t b) {
    const auto of_a = corners(scene, a), of_b = corners(scene, b);
    return std::find_first_of(of_a.begin(), of_a.end(), of_b.begin(), of_b.end()) != of_a.end();
}

/// Rays that leave the faces of a flat or convex mesh hit no neighbour, and those that leave a closed one inward hit
/// another face. Far from the origin rounding makes a flat mesh bumpy, so that a grazing ray may hit its far faces.
void try_mesh(const Subject& subject, const Scene& scene, const Vec3d& middle, double size, bool closed, Random& random,
              std::size_t rays, Score& score) {
    const PreparedScene prepared = in_world(scene);
    Departures departures;
    while (departures.rays.size() < rays) {
        const Vec3f origin = narrow(middle + any_unit(random) * (3 * size));
        const Vec3d aim = middle + any_unit(random) * (0.7 * size * random.uniform(0.0, 1.0));
        const auto point = seen_point(view(prepared), {origin, narrow(aim - widen(origin))});
        if (!point) continue;
        const bool inward = random.coin();
        const double cosine = std::pow(10.0, random.uniform(-6.0, 0.0)) * (inward ? -1 : 1);
        const auto spawned = spawn_ray(*point, narrow(with_cosine(point->normal, cosine, random)));
        if (spawned.source.inside == inward) departures.add(spawned);  // else it grazes, and was rounded to float
    }
    const auto hits = departures.trace(subject, *subject.backend.load(prepared, subject.tier), score);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const std::uint32_t from = departures.sources[i].primitive, met = hits[i].primitive;
        const bool must_meet = closed && departures.sources[i].inside;
        const bool lost = must_meet && met == no_primitive;
        const bool acne = !must_meet && met != no_primitive && share_a_corner(prepared, from, met);
        score.leaks += lost;
        score.decide(lost || acne, [&] {
            return fmt::format("{}: from face {}, meets {}", to_literal(departures.rays[i]), from,
                               lost ? "nothing" : "face " + std::to_string(met));
        });
    }
}

Score meshes(const Subject& subject, Random& random, std::size_t rays) {
    Score score;
    for (const double scale : {1.0, 1e-3, 1e6}) {
        for (const Vec3d& offset : {Vec3d{0, 0, 0}, Vec3d{1000, 2000, -500} * scale}) {
            const Vec3d middle = Vec3d{0, 0, -3} * scale + offset;
            const auto mesh = [&](const Mesh& m, bool closed) {
                try_mesh(subject, one_mesh(m, scale, offset), middle, scale, closed, random, rays / 18, score);
            };
            mesh(grid(false), false);
            mesh(grid(true), false);
            mesh(icosphere(2), true);
        }
    }
    return score;
}

/// Shadow rays from spheres to points of an emissive ball: its own surface does not hide it, but a ball at a gap of
/// 1e-5 of its radius does.
Score to_surfaces(const Subject& subject, Random& random, std::size_t rays) {
    Score score;
    for (const double distance : {3.0, 1000.0}) {
        const std::vector<Sphere> pair = {{narrow(any_unit(random) * distance), 1}, {{0, 0, 0}, 0.5F}};
        const PreparedScene alone = in_world(scene_of(pair));
        Shadows open, hidden;
        std::vector<Sphere> covers = pair;
        for (std::size_t i = 0; i < rays / 4; ++i) {
            const Vec3d eye = any_unit(random) * 0.6;
            const Vec3d aim = widen(pair[0].centre) + any_unit(random) * random.uniform(0.0, 1.0);
            const auto from = seen_point(view(alone), {narrow(eye), narrow(aim - eye)});
            const Vec3f sample = narrow(any_unit(random) * 0.5);
            if (!from || from->primitive != 0) continue;
            const auto shadow = spawn_shadow_ray(*from, sample, 1);
            if (shadow.source.inside) continue;
            open.add(shadow, false);
            if (covers.size() >= 66) continue;
            const Vec3d back = normalize(widen(from->position) - widen(sample));
            covers.push_back({narrow(widen(sample) + back * 0.01001), 0.01F});
            for (int k = 0; k < 16; ++k) hidden.add(shadow, true);
        }
        open.judge(subject, alone, score);
        hidden.judge(subject, in_world(scene_of(covers)), score);
    }
    return score;
}

/// A light exactly at the point, inside the sphere, and so near that the vector to it is subnormal: no NaN, and no
/// untraceable ray.
Score light_at_the_point(const Subject& subject, Random& random, std::size_t rays) {
    Score score;
    const SeenSphere seen({1, 5}, random);
    Shadows shadows;
    for (std::size_t i = 0; i < rays; ++i) {
        const Point point = seen.any_point(random);
        const auto none = spawn_shadow_ray(point, point.position, no_primitive);
        score.decide(none.active, "a light at the very point is a light");
        shadows.add(none, false);  // a ray without direction is a miss
        shadows.add(spawn_shadow_ray(point, seen.sphere.centre, no_primitive), false);
        Vec3f next = point.position;
        next.z = std::nextafter(next.z, point.normal.z > 0 ? 10.0F : -10.0F);
        const auto near = spawn_shadow_ray(point, next, no_primitive);
        if (!near.source.inside) shadows.add(near, false);
    }
    shadows.judge(subject, in_world(scene_of({seen.sphere})), score);
    return score;
}

/// Shadow rays from 1e-8 to 1e8 long: surfaces in between block, surfaces behind do not, and neither does a surface
/// exactly at the light, along an axis where all numbers are exact.
Score long_and_short(const Subject& subject, Random& random, std::size_t rays) {
    Score score;
    for (const float length : {1e-8F, 1.0F, 1e8F}) {
        Shadows shadows;
        // everything else is within half a length of the origin
        std::vector<Sphere> spheres = {{{0, 0, 2 * length}, length}};
        Point start;
        start.position = {0, 0, 0};
        start.normal = {0, 0, 1};
        for (const auto& [t, blocked] : {std::pair{1.0, false}, {1 + 0x1p-52, true}, {1 - 0x1p-53, false}}) {
            ShadowRay<float> exact = spawn_shadow_ray(start, {0, 0, length}, no_primitive);
            exact.t_max = t;
            shadows.add(exact, blocked);
        }
        ShadowRay<float> to_it = spawn_shadow_ray(start, {0, 0, 4 * length}, 0);
        shadows.add(to_it, false);
        while (spheres.size() < 65) {  // off the axis
            const Vec3d towards = any_unit(random);
            if (towards.z < 0.9) spheres.push_back({narrow(towards * (0.4 * double{length})), 0.01F * length});
        }
        for (std::size_t i = 0; i < rays / 3; ++i) {
            const Vec3d ball = widen(spheres[1 + i % 64].centre);
            // from the middle, past the side of the others, straight through this one or ending before it
            const bool through = random.coin();
            const Vec3f light = narrow(ball * (through ? random.uniform(1.1, 1.2) : random.uniform(0.1, 0.9)));
            bool clear = true;
            for (std::size_t k = 1; k < spheres.size(); ++k) {
                const Vec3d other = widen(spheres[k].centre);
                if (k != 1 + i % 64 && dot(normalize(other), normalize(ball)) > 0.99) clear = false;
            }
            start.normal = normalize(ball);
            if (through || clear) shadows.add(spawn_shadow_ray(start, light, no_primitive), through);
        }
        shadows.judge(subject, in_world(scene_of(spheres)), score);
    }
    return score;
}

/// Many paths at once; each trace advances all of them by a step.
struct Path {
    SpawnedRay<float> next;
    std::string crossed;  ///< a letter for every surface
    bool ended = false;
};

/// Traces all paths that have not ended. `step` gets the path and its hit point, null for a miss.
template <class Step>
void advance(const Subject& subject, const PreparedScene& prepared, ResidentScene& resident, std::vector<Path>& paths,
             Score& score, const Step& step) {
    Departures departures;
    std::vector<Path*> going;
    for (Path& path : paths) {
        if (path.ended) continue;
        departures.add(path.next);
        going.push_back(&path);
    }
    std::vector<double> t;
    const auto hits = departures.trace(subject, resident, score, &t);
    for (std::size_t i = 0; i < going.size(); ++i) {
        const SpawnedRay<float>& last = going[i]->next;
        if (hits[i].primitive == no_primitive) {
            step(*going[i], nullptr);
            continue;
        }
        const Closest<float> hit = {t[i], hits[i].primitive};
        const Point point = surface_point(view(prepared), last.ray, last.source, hit, true);
        step(*going[i], &point);
    }
}

/// A straight ray through two concentric spheres, 4e-5 of the radius apart, crosses four surfaces.
void try_straight(const Subject& subject, const Place& place, Random& random, std::size_t rays, Score& score) {
    const Vec3f centre = narrow(any_unit(random) * place.distance);
    std::vector<Sphere> spheres = {{centre, static_cast<float>(place.radius)},
                                   {centre, static_cast<float>(place.radius * (1 + 4e-5))}};
    for (const Sphere& far : shell(random, widen(centre) * -10.0, place.radius)) spheres.push_back(far);
    const PreparedScene prepared = in_world(scene_of(spheres));
    const auto resident = subject.backend.load(prepared, subject.tier);
    std::vector<Path> paths(rays);
    for (Path& path : paths) {
        const Vec3d aim = widen(centre) + any_unit(random) * (0.99 * place.radius * random.uniform(0.0, 1.0));
        path.next = {{{0, 0, 0}, narrow(aim)}, {}};
    }
    for (int i = 0; i < 6; ++i) {
        advance(subject, prepared, *resident, paths, score, [](Path& path, const Point* point) {
            path.ended = point == nullptr;
            if (path.ended) return;
            path.crossed += point->primitive == 0 ? 'i' : 'o';
            path.next = spawn_ray(*point, path.next.ray.direction);
        });
    }
    for (const Path& path : paths) {
        score.decide(path.crossed != "oiio", [&] {
            return fmt::format("radius {} at {}: {} instead of oiio", place.radius, place.distance, path.crossed);
        });
    }
}

/// A dielectric solid: light is refracted in, mirrored three times inside, and leaves straight; it must not hit the
/// solid again. If a grazing direction is rounded to the other side the path is not judged.
void try_glass(const Subject& subject, const Shape& shape, const Trs& trs, Random& random, std::size_t rays,
               Score& score) {
    Scene scene = scene_of({});
    scene.nodes.push_back({.name = "glass", .trs = trs, .geometry = {{shape, 0, {}}}});
    const PreparedScene prepared = in_world(scene);
    const auto resident = subject.backend.load(prepared, subject.tier);
    std::vector<Path> paths(rays);
    for (Path& path : paths) {
        const Vec3d aim = trs.translation + any_unit(random) * (0.5 * random.uniform(0.0, 1.0));
        path.next = {{{0, 0, 0}, narrow(aim)}, {}};
    }
    constexpr int mirrors = 3;
    for (int i = 0; i < mirrors + 3; ++i) {
        advance(subject, prepared, *resident, paths, score, [&](Path& path, const Point* point) {
            path.ended = point == nullptr;
            if (path.ended) return;
            const bool entering = path.crossed.empty(), leaving = path.crossed.size() == 1 + mirrors;
            path.crossed += 'x';
            const Vec3d direction = normalize(widen(path.next.ray.direction));
            Vec3d onward = direction;
            if (entering) {
                onward = refract<float>(direction, point->normal, 1 / 1.5).direction;
            } else if (!leaving) {
                onward = reflect(direction, point->normal);
            }
            path.next = spawn_ray(*point, narrow(onward));
            if (path.next.source.inside == leaving) {
                path.crossed = "?";
                path.ended = true;
            }
        });
    }
    for (const Path& path : paths) {
        if (path.crossed.empty() || path.crossed == "?") {
            ++score.unjudged;
            continue;
        }
        score.leaks += path.crossed.size() < 2 + mirrors;
        score.decide(path.crossed.size() != 2 + mirrors, [&] {
            return fmt::format("{} crossings instead of {}, {}", path.crossed.size(), 2 + mirrors,
                               to_literal(path.next.ray));
        });
    }
}

Score crossings(const Subject& subject, Random& random, std::size_t rays) {
    Score score;
    // the gap must be wider than the distance of floats there
    for (const Place& place : {Place{1, 3}, Place{1e-3, 0.01}, Place{1, 100}, Place{6.4e6, 1e8}}) {
        try_straight(subject, place, random, rays / 8, score);
    }
    const Trs upright = {{0.3, -0.4, -5}, {}, {1, 1, 1}};
    const Trs turned = {{0.3, -0.4, -5}, {0.3, -0.2, 0.5, 0.7}, {1, 0.2, 0.6}};
    for (const Trs& trs : {upright, turned}) {
        try_glass(subject, SphereShape{1}, trs, random, rays / 8, score);
        try_glass(subject, BoxShape{{1, 2, 1.5}}, trs, random, rays / 8, score);
    }
    return score;
}

constexpr const char* by_angle = "closed form: the sign of the cosine";
constexpr const char* both_rules = "closed form: the sign of the cosine; a sphere in contact blocks";

}  // namespace

std::vector<HardCase> leaving_cases() {
    return {
        {"E1", "From a sphere to lights at its horizon",
         "without an offset, 39 % of the lights are blocked by the sphere itself; with an offset of 1e-4, 8.5 %",
         by_angle, RenderCase{horizon}},
        {"E2", "Under spheres with a gap of 1e-5",
         "every usual offset starts the ray behind the other sphere: all light leaks",
         "closed form: a sphere in contact blocks", RenderCase{contact}},
        {"E3", "E1 and E2 with radius 10^-3", "an offset that suits radius 1 is as large as the sphere", both_rules,
         RenderCase{tiny}},
        {"E4", "E1 and E2 seen from 1000 radii", "the hit point itself is 1.7e-4 off the surface", both_rules,
         RenderCase{seen_from_far}},
        {"E5", "E1 and E2 on a planet", "an offset that suits radius 1 rounds away", both_rules, RenderCase{planet}},
        {"E6", "E1 and E2, 10^3 and 10^5 radii from the origin", "floats are 6e-5 and 8e-3 apart: no offset suits both",
         both_rules, RenderCase{far_from_origin}},
        {"E7", "From faces of meshes, with coplanar neighbours",
         "the neighbour is another primitive, and is hit near t = 0", "topology: flat, convex, closed",
         RenderCase{meshes}},
        {"E8", "To points on a spherical light",
         "the light blocks itself; a shadow ray that ends 10^-4 short misses what touches the light", "closed form",
         RenderCase{to_surfaces}},
        {"E9", "To a light exactly at the point, and inside the sphere", "normalising a vector of length 0 gives NaN",
         "rule: no light, no NaN", RenderCase{light_at_the_point}},
        {"E10", "Shadow rays with lengths from 10^-8 to 10^8", "a minimum t of 1e-4 is beyond the light",
         "closed form: between, behind, exactly there", RenderCase{long_and_short}},
        {"E11", "Interface crossings of shells and dielectrics",
         "the origin is put on the wrong side, and the side is lost", "counting", RenderCase{crossings}},
    };
}

}  // namespace tandem::hard
