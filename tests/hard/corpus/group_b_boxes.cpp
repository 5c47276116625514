// Group B: rays and boxes. The oracle is exact arithmetic on the same floats. Most rays are the kinds of
// support/adversarial_rays.h, traced by whole backends.
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "hard/corpus/groups.h"
#include "hard/corpus/ray_batches.h"
#include "support/adversarial_rays.h"
#include "support/exact_geometry.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem::hard {

namespace {

using test::any_unit;

constexpr const char* exact = "exact arithmetic";
const Box unit = {{-1, -1, -1}, {1, 1, 1}};

int kind_named(const std::string& name) {
    for (int kind = 0; kind < static_cast<int>(std::size(test::box_kinds)); ++kind) {
        if (name == test::box_kinds[kind]) return kind;
    }
    throw std::logic_error("no kind of box is called " + name);
}

/// The rays of a kind of adversarial_rays.h, sorted by their boxes.
std::vector<RayBatch> of_kind(const std::string& name, std::size_t rays) {
    const int kind = kind_named(name);
    std::vector<Box> boxes;
    std::vector<std::vector<Ray<float>>> rays_of;
    for (std::uint64_t number = 0; number < rays; ++number) {
        const test::BoxCase c = test::box_case(kind, number);
        std::size_t at = 0;
        // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): bits, not values
        while (at < boxes.size() && std::memcmp(&boxes[at], &c.box, sizeof(Box)) != 0) ++at;
        if (at == boxes.size()) {
            boxes.push_back(c.box);
            rays_of.emplace_back();
        }
        rays_of[at].push_back(c.ray);
    }
    std::vector<RayBatch> batches;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        Random random(i);
        const double reach = static_cast<double>(norm1(boxes[i].lower) + norm1(boxes[i].upper));
        std::size_t next = 0;
        add_batches(batches, random, {}, {boxes[i]}, 64 * reach, rays_of[i].size(), [&] { return rays_of[i][next++]; });
    }
    return batches;
}

std::function<std::vector<RayBatch>(Random&, std::size_t)> kind(const char* name) {
    return [name](Random&, std::size_t rays) { return of_kind(name, rays); };
}

/// The four rays known from the literature, along both faces of every axis, with both zeros.
std::vector<RayBatch> along_faces(Random&, std::size_t rays) {
    std::vector<RayBatch> batches = of_kind("zero direction components", rays);
    RayBatch& first = batches.front();
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0F, 1.0F}) {
            for (const float zero : {0.0F, -0.0F}) {
                Ray<float> ray = {{0.25F, 0.25F, 0.25F}, {zero, zero, zero}};
                ray.origin[axis] = side;
                ray.origin[(axis + 1) % 3] = -3;
                ray.direction[(axis + 1) % 3] = 1;
                first.rays.push_back(ray);
            }
        }
    }
    return batches;
}

/// Inside, with components of the direction that are zeros of either sign.
std::vector<RayBatch> inside_with_zeros(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    add_batches(batches, random, {}, {unit}, 16, rays, [&] {
        Ray<float> ray = {{random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)}, {}};
        for (int i = 0; i < 3; ++i) ray.direction[i] = random.coin() ? 0.0F : -0.0F;
        ray.direction[static_cast<int>(random.below(3))] = random.coin() ? 1.0F : -1.0F;
        return ray;
    });
    return batches;
}

/// Sixteen boxes of various shapes, with rays at their faces, edges and corners from all distances.
std::vector<RayBatch> last_bits(Random&, std::size_t rays) {
    std::vector<RayBatch> batches;
    const int kind = kind_named("edges, by the last bits");
    for (std::uint64_t number = 0; number < std::min<std::size_t>(rays, 64); ++number) {
        const test::BoxCase c = test::box_case(kind, number);
        batches.push_back({scene_of({}, {c.box}), {c.ray}});
    }
    return batches;
}

/// The axis of the face, where no other is within 2^-50; exactly on edges and corners the lowest axis.
Score face_normals(Random&, std::size_t calls) {
    using test::big;
    Score score;
    for (const char* name : {"corners, exact", "edges, dyadic", "inside and outside", "on a face"}) {
        for (std::uint64_t number = 0; number < calls / 4; ++number) {
            const test::BoxCase c = test::box_case(kind_named(name), number);
            const auto exact_hit =
                test::hit_box(big(c.ray.origin), big(c.ray.direction), big(c.box.lower), big(c.box.upper));
            if (!exact_hit || !is_traceable(c.ray)) continue;
            const auto crossing = cross_box(c.box, c.ray);
            const Vec3d normal = face_normal(record_hit<float>(crossing, widen(c.ray.direction), false));
            const double along = normal[exact_hit->axis] * static_cast<double>(c.ray.direction[exact_hit->axis]);
            const bool right = norm1(normal) == 1.0 && (exact_hit->entering ? along < 0 : along > 0);
            const bool open = !right && test::nearly_tied(big(c.ray.origin), big(c.ray.direction), big(c.box.lower),
                                                          big(c.box.upper), *exact_hit);
            score.unjudged += open;
            score.decide(!right && !open, [&] { return to_literal(c.ray); });
        }
    }
    return score;
}

/// 32 x 32 touching boxes; rays from in front of the wall at shared edges and corners. The lowest id of the boxes that
/// share the point is correct.
std::vector<RayBatch> wall(Random& random, std::size_t rays) {
    std::vector<Box> boxes;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
            boxes.push_back({{fx, fy, 0}, {fx + 1, fy + 1, 1}});
        }
    }
    RayBatch batch = {scene_of({}, boxes), {}};
    batch.rays = make_rays(rays, [&] {
        const auto grid = [&] { return static_cast<float>(1 + random.below(31)); };
        const auto place = [&] { return static_cast<float>(random.below(32 * 256)) / 256; };
        Vec3f target = {grid(), random.coin() ? grid() : place(), 0};
        if (random.coin()) std::swap(target.x, target.y);
        const Vec3f origin = {place(), place(), -1 - static_cast<float>(random.below(256)) / 16};
        return Ray<float>{origin, target - origin};
    });
    return {batch};
}

/// Rotated and scaled by 1 : 1000 : 1,000,000; judged in object space, through the prepared matrix.
std::vector<RayBatch> placed(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (int i = 0; i < 8; ++i) {
        Scene scene = scene_of(shell(random, {0, 0, 0}, 1e4));
        Node node{.name = "body"};
        node.trs.translation = any_unit(random) * random.uniform(0.0, 100.0);
        node.trs.rotation = test::any_turn(random);
        node.trs.scale = {1e-3, 1, 1e3};
        node.geometry.push_back({i % 2 == 0 ? Shape(BoxShape{{2, 2, 2}}) : SphereShape{1}, 0, {}});
        const Transform world_from_body = to_transform(node.trs);
        scene.nodes.push_back(node);
        batches.push_back({scene, make_rays(rays / 8, [&] {
                               const Vec3d target = transform_point(world_from_body, any_unit(random) * 0.9);
                               const Vec3d origin = any_unit(random) * random.uniform(0.0, 3000.0);
                               return Ray<float>{narrow(origin), narrow(target - origin)};
                           })});
    }
    return batches;
}

/// Inverted boxes, and boxes with numbers that are not finite, never become primitives.
Score bad_boxes(Random&, std::size_t) {
    Score score;
    const double nan = std::nan(""), infinity = HUGE_VAL;
    for (const double bad : {-1.0, nan, infinity, -infinity, 2e18}) {
        for (int axis = 0; axis < 3; ++axis) {
            Scene scene = scene_of({}, {unit});
            std::get<BoxShape>(scene.nodes[1].geometry[0].shape).size[axis] = bad;
            bool refused = false;
            try {
                (void)prepare(scene);
            } catch (const InputError& error) {
                refused = std::string(error.what()).find("primitive 0") != std::string::npos;
            }
            score.decide(!refused, fmt::format("a box of size {} along axis {} was taken", bad, axis));
        }
    }
    return score;
}

}  // namespace

std::vector<HardCase> box_cases() {
    return {
        {"B1", "Along a face, direction components of 0 and -0",
         "0 times infinity is NaN, and the result then depends on the argument order of min and max", exact,
         RayCase{along_faces}},
        {"B2", "From inside, direction components of 0 and -0", "b inv - o inv is infinity - infinity", exact,
         RayCase{inside_with_zeros}},
        {"B3", "Subnormal direction components", "their reciprocal is infinite", exact,
         RayCase{kind("subnormal direction components")}},
        {"B4", "Corners, hit exactly", "a strict comparison loses three of four rays", exact,
         RayCase{kind("corners, exact")}},
        {"B5", "Edges, hit exactly", "the reciprocal is rounded, and one ray in twenty is lost", exact,
         RayCase{kind("edges, dyadic")}},
        {"B6", "Edges, within 1e-6", "rounding in float decides", exact, RayCase{kind("edges, close")}},
        {"B7", "Boxes of zero thickness, and of one ulp", "a strict comparison loses them", exact,
         RayCase{kind("flat and thin")}},
        {"B8", "From inside a box of size 1e-3 at distance 1000", "b inv - o inv cancels", exact,
         RayCase{kind("small and far out")}},
        {"B9", "From up to 10^6 away", "the rounding error of the distance is as large as the edges of the box", exact,
         RayCase{kind("from far away")}},
        {"B10", "Which face, at edges and corners", "the largest component of the point is rounding noise there", exact,
         FunctionCase{face_normals}},
        {"B11", "From a face: outward, along it, inward", "the face is hit again near t = 0", exact,
         RayCase{kind("on a face")}},
        {"B12", "A wall of 32 x 32 touching boxes, at shared edges",
         "each box rounds on its own, so light leaks between them, and the id is random",
         "exact arithmetic; the lowest id at equal t", RayCase{wall, true}},
        {"B13", "Rotated and scaled by 1 : 10^3 : 10^6", "the inverse matrix and the position are rounded to float",
         "exact arithmetic in object space", RayCase{placed}},
        {"B14", "Inverted boxes, and boxes that are not finite", "always or never hit, unpredictably",
         "rule: refused at load", FunctionCase{bad_boxes}},
        {"B15", "Edges that rays pass within 2^-70", "different quotients round to the same double", exact,
         RayCase{last_bits}},
    };
}

}  // namespace tandem::hard
