// Acceleration structures only propose: with them and without, the same bits. The hierarchy of the CUDA backend is
// tried here on the host, where every machine can.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/bundles.h"
#include "support/hair.h"
#include "support/hard_scenes.h"
#include "support/huge_primitive.h"
#include "support/needles.h"
#include "support/random.h"
#include "support/structure.h"
#include "tandem/compile/prepare.h"
#include "tandem/kernel/spawn_ray.h"
#include "tandem/kernel/traversal/constant_memory_tracer.h"
#include "tandem/kernel/traversal/make_node.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

using test::in_pieces;
using test::Structure;

/// Limits to ask with around a hit at t: before it, at it and just behind it; then one near and one far, whatever t is.
std::array<double, 5> distances_around(double t) { return {0.5 * t, t, t * (1 + 1e-15), 1.0, 1e300}; }

/// What the loop over all primitives says of a ray: its nearest hit, what lies behind it as if all were masked there,
/// and the nearest hit and the shadow of a ray that leaves the surface.
struct Answers {
    Answers(const LoopTracer& one_by_one, const Ray<float>& asked)
        : ray(asked), nearest(one_by_one.closest(ray, NoSource{}, true)) {
        if (nearest.primitive == no_primitive) return;
        PathSource<float> path;
        for (path.last_masked = nearest; path.last_masked.primitive != no_primitive;) {
            behind.push_back(path.last_masked = one_by_one.closest(ray, path, true));
        }
        precise = one_by_one.closest(to_real<double>(ray), NoSource{}, true);
        const SurfacePoint<float> point = surface_point(one_by_one.scene, ray, NoSource{}, nearest, true);
        const SpawnedRay<float> out = spawn_ray(point, Vec3f{ray.direction.y, -ray.direction.x, ray.direction.z});
        if (!is_traceable(out.ray)) return;
        spawned = out;
        onwards = one_by_one.closest(out.ray, out.source, true);
        onwards_as_path = one_by_one.closest(out.ray, PathSource<float>{out.source}, true);
        ShadowSource<float> source;
        static_cast<RaySource&>(source) = out.source;
        const std::array distances = distances_around(onwards.t);
        for (std::size_t i = 0; i < distances.size(); ++i) {
            occluded[i] = one_by_one.occluded(out.ray, distances[i], source, true);
        }
        source.light = onwards.primitive;
        occluded_to_light = one_by_one.occluded(out.ray, 1e300, source, true);
    }

    Ray<float> ray;
    Closest<float> nearest;
    std::vector<Closest<float>> behind;  ///< from near to far, the last one without a primitive
    Closest<double> precise;
    std::optional<SpawnedRay<float>> spawned;  ///< what follows is of this ray
    Closest<float> onwards, onwards_as_path;
    std::array<bool, 5> occluded{};  ///< up to each of distances_around(onwards.t)
    bool occluded_to_light = false;
};

/// In the place of MaskedHits (kernel/masked_hits.h): any hit blocks.
struct AnyHit {
    bool block(std::uint32_t id, bool /*open*/) const {
        Closest<float> best = closest_starting_at<float>(t_max);
        visit_primitive(scene, id,
                        [&](const auto& primitive) { test_primitive(primitive, id, ray, NoSource{}, true, best); });
        return best.t < t_max;
    }
    void begin_again() { ++begun_again; }

    const SceneView& scene;
    Ray<float> ray;
    double t_max;
    int begun_again = 0;
};

template <class Real>
void expect_equal(const Closest<Real>& actual, const Closest<Real>& expected, const std::string& what) {
    ASSERT_EQ(actual.primitive, expected.primitive) << what;
    ASSERT_EQ(bits_of(actual.t), bits_of(expected.t)) << what;
}

template <class Tracer>
void expect_same(const Tracer& tracer, const Answers& expected, const std::string& what) {
    const Ray<float>& ray = expected.ray;
    ASSERT_NO_FATAL_FAILURE(expect_equal(tracer.closest(ray, NoSource{}, true), expected.nearest, what));
    if (expected.nearest.primitive == no_primitive) return;
    PathSource<float> path;
    path.last_masked = expected.nearest;
    for (const Closest<float>& next : expected.behind) {
        ASSERT_NO_FATAL_FAILURE(expect_equal(tracer.closest(ray, path, true), next, what + ", through masks"));
        path.last_masked = next;
    }
    ASSERT_NO_FATAL_FAILURE(
        expect_equal(tracer.closest(to_real<double>(ray), NoSource{}, true), expected.precise, what + ", precise"));
    if (!expected.spawned) return;
    const Ray<float>& out = expected.spawned->ray;
    const RaySource& from = expected.spawned->source;
    ASSERT_NO_FATAL_FAILURE(expect_equal(tracer.closest(out, from, true), expected.onwards, what + ", onwards"));
    const PathSource<float> onwards = {from};
    const Closest<float> found = tracer.closest(out, onwards, true);
    ASSERT_EQ(found.primitive, expected.onwards_as_path.primitive) << what << ", onwards as a path";
    for (const double farthest : distances_around(found.t)) {
        const Closest<float> bounded = tracer.closest(out, onwards, true, farthest);
        if (found.t < farthest) {
            ASSERT_EQ(bounded.primitive, found.primitive) << what << ", up to " << farthest;
            ASSERT_EQ(bits_of(bounded.t), bits_of(found.t)) << what << ", up to " << farthest;
        } else {
            ASSERT_EQ(bits_of(bounded.t), bits_of(farthest)) << what << ", up to " << farthest;
        }
    }
    ShadowSource<float> source;
    static_cast<RaySource&>(source) = from;
    const std::array distances = distances_around(expected.onwards.t);
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const double t_max = distances[i];
        ASSERT_EQ(tracer.occluded(out, t_max, source, true), expected.occluded[i]) << what << ", until " << t_max;
        ASSERT_EQ(expected.occluded[i], expected.onwards.t < t_max) << what << ", until " << t_max;
    }
    source.light = expected.onwards.primitive;
    ASSERT_EQ(tracer.occluded(out, 1e300, source, true), expected.occluded_to_light) << what << ", to a light";
}

/// For a scene of these kinds alone, a tracer that knows no other.
template <std::uint32_t kinds>
void expect_same_of_kinds(const Structure& structure, const Answers& expected, const std::string& what) {
    expect_same(structure.tracer<Decisions::behind_walk, kinds>(), expected, what + ", one kind");
}

void expect_same_as_loop(const Structure& structure, const std::vector<Ray<float>>& rays, const std::string& name) {
    const auto in_leaves = structure.tracer();
    const auto behind_walk = structure.tracer<Decisions::behind_walk>();
    const SceneView scene = view(structure.scene);
    const LoopTracer one_by_one = {scene};
    const std::size_t count = primitive_count(scene);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!is_traceable(rays[i])) continue;
        const std::string what = name + ", ray " + std::to_string(i);
        const Answers expected(one_by_one, rays[i]);
        expect_same(in_leaves, expected, what);
        expect_same(behind_walk, expected, what + ", decided behind the walk");
        if (structure.scene.spheres.size() == count) {
            expect_same_of_kinds<PrimitiveKinds::sphere>(structure, expected, what);
        } else if (structure.scene.triangles.size() == count) {
            expect_same_of_kinds<PrimitiveKinds::triangle>(structure, expected, what);
        } else if (structure.scene.parallelepipeds.size() == count) {
            expect_same_of_kinds<PrimitiveKinds::parallelepiped>(structure, expected, what);
        }
        if (::testing::Test::HasFatalFailure()) return;
    }
}

TEST(Bvh, HoldsScenesOfAnySize) {
    for (const float scale : {1e-25F, 1e-20F, 1e-4F, 1e10F, 1e17F}) {
        PreparedScene prepared = prepare(named_scene("icosphere/2"));
        for (Triangle& t : prepared.triangles) t.v0 = t.v0 * scale, t.v1 = t.v1 * scale, t.v2 = t.v2 * scale;
        const Structure structure(std::move(prepared));
        ASSERT_EQ(find_bvh_defect(structure.bvh, view(structure.scene), structure.frame.padding), "") << scale;
        expect_same_as_loop(structure, test::make_rays(structure.scene, 1'000, 10), std::to_string(scale));
    }
}

TEST(Bvh, NeverLosesAHitOfTriangles) {
    for (const char* name : {"icosphere/3", "triangles/500"}) {
        const Structure structure(prepare(named_scene(name)));
        expect_same_as_loop(structure, test::make_rays(structure.scene, 4'000, 9), name);
    }
}

TEST(Bvh, NeverLosesAHit) {
    for (const test::HardScene& parameters : test::hard_scenes()) {
        const Structure structure(test::make_scene(parameters, 5));
        const SceneView scene = view(structure.scene);
        ASSERT_EQ(find_bvh_defect(structure.bvh, scene, structure.frame.padding), "") << parameters.name;
        expect_same_as_loop(structure, test::make_rays(structure.scene, 20'000, 6), parameters.name);
    }
}

TEST(Bvh, NeverLosesAHitOfOneKind) {
    for (const test::HardScene& parameters : test::scenes_of_one_kind()) {
        const Structure structure(test::make_scene(parameters, 5));
        ASSERT_EQ(structure.scene.parallelepipeds.size() == primitive_count(structure.scene),
                  parameters.kinds == test::HardKinds::parallelepipeds);
        expect_same_as_loop(structure, test::make_rays(structure.scene, 8'000, 6), parameters.name);
    }
}

TEST(Bvh, NeverLosesAGrazingHit) {
    // rays that touch spheres at their poles, where the boxes are exactly as wide as the spheres
    const Structure structure(prepare(named_scene("spheres/3000")));
    std::vector<Ray<float>> rays;
    for (std::size_t i = 0; i < structure.scene.spheres.size(); ++i) {
        const Sphere& s = structure.scene.spheres[i];
        const float far = i % 2 == 0 ? 3.0F : 3e5F;
        rays.push_back({{s.centre.x + s.radius * 0.9999999F, s.centre.y, s.centre.z - far}, {0, 0, 1}});
        rays.push_back({{s.centre.x - far, s.centre.y, s.centre.z - s.radius * 0.9999999F}, {1, 1e-25F, 0}});
        rays.push_back({{s.centre.x, s.centre.y + s.radius, s.centre.z}, {-1e-10F, 0, 0}});
    }
    expect_same_as_loop(structure, rays, "poles");
}

// Boxes are padded by a part of their own reach, since a part of the scene's would be more than their size.
TEST(Bvh, NeverLosesAHitOfSmallPrimitivesBesideAHugeOne) {
    test::Random random(21);
    for (int round = 0; round < 60; ++round) {
        const Structure structure(test::beside_a_huge_one(random));
        ASSERT_EQ(find_bvh_defect(structure.bvh, view(structure.scene), structure.frame.padding), "") << round;
        expect_same_as_loop(structure, test::rays_at_small_ones(structure.scene, random, 1'000),
                            "round " + std::to_string(round));
    }
}

// Rays from afar through poles of spheres that are as small as the rounding of the rays' moved origins. All coordinates
// are multiples of 2^-11, the distance of floats there, so that the rays hit exactly what they are aimed at.
TEST(Bvh, NeverLosesAHitOfSmallPrimitivesFarFromTheOrigin) {
    test::Random random(24);
    constexpr float step = 0x1p-11F, radius = 7 * step;
    const auto multiple = [&](double range) {
        return step * static_cast<float>(std::floor(random.uniform(-range, range) / double{step}));
    };
    for (int round = 0; round < 200; ++round) {
        PreparedScene scene;
        for (int i = 0; i < 8; ++i) {
            scene.spheres.push_back({{4096 + multiple(0.02), -2048 + multiple(0.02), 1024 + multiple(0.02)}, radius});
        }
        scene.material_of.assign(8, 0);
        scene.materials.emplace_back();
        std::vector<Ray<float>> rays;
        for (int i = 0; i < 200; ++i) {
            const int axis = random.coin() ? 1 : 2;
            Vec3f pole = scene.spheres[random.below(8)].centre, direction = {-3000 + multiple(500), 0, 0};
            pole[axis] += random.coin() ? radius : -radius;
            direction[axis] = multiple(40);  // nearly a tangent, but none
            direction[3 - axis] = multiple(1000);
            rays.push_back({pole - direction, direction});
        }
        expect_same_as_loop(Structure(std::move(scene)), rays, "round " + std::to_string(round));
    }
}

// Lines through a pole of a sphere, the origin of space: numbers of 12 bits make the far origins of the rays exact.
// Here the t of all spheres may be the same, and one step in double does not reach the scene.
TEST(Bvh, NeverLosesAHitOfRaysFromVeryFar) {
    test::Random random(25);
    for (const float scale : {1.0F, 0x1p-30F, 0x1p-80F}) {
        PreparedScene scene;
        for (int i = 0; i < 30; ++i) {
            const Vec3f centre = {static_cast<float>(3 * (i % 6)), 1, static_cast<float>(i / 6)};
            scene.spheres.push_back({centre * scale, scale});
        }
        scene.material_of.assign(30, 0);
        scene.materials.emplace_back();
        const auto of_12_bits = [&](unsigned least) { return static_cast<float>(least + random.below(2048)); };
        std::vector<Ray<float>> rays;
        for (int i = 0; i < 4'000; ++i) {
            const Vec3f direction = {of_12_bits(2048), 0.0625F * of_12_bits(1),
                                     random.coin() ? 1024.0F : -of_12_bits(1)};
            const float far = of_12_bits(2048) * std::exp2(static_cast<float>(random.below(37)));
            const Vec3f towards = random.coin() ? direction : direction * -1.0F;
            rays.push_back({towards * -far, towards});
        }
        expect_same_as_loop(Structure(std::move(scene)), rays, "from very far, scale " + std::to_string(scale));
    }
}

TEST(Bvh, NeverLosesAHitOfTrianglesInPieces) {
    test::Random random(26);
    for (const std::uint32_t count : {2U, 5U, 16U}) {
        const Structure structure = in_pieces(test::hair(random, 500), count);
        ASSERT_EQ(find_bvh_defect(structure.bvh, view(structure.scene), structure.frame.padding), "") << count;
        expect_same_as_loop(structure, test::rays_at_hair(structure.scene, random, 3'000),
                            std::to_string(count) + " pieces");
    }
}

TEST(Bvh, NeverLosesAHitOfNeedlesInPieces) {
    test::Random random(28);
    const PreparedScene needles = test::needles(random, 200, 1);
    PreparedScene boxes = needles;
    boxes.ellipsoids.clear();
    boxes.material_of.resize(boxes.parallelepipeds.size());
    const std::vector<Ray<float>> rays = test::rays_at_needles(needles, random, 3'000);
    for (const std::uint32_t count : {2U, 16U}) {
        for (const bool only_boxes : {false, true}) {
            const Structure structure = in_pieces(only_boxes ? boxes : needles, count);
            ASSERT_EQ(find_bvh_defect(structure.bvh, view(structure.scene), structure.frame.padding), "") << count;
            expect_same_as_loop(structure, rays, std::to_string(count) + " pieces");
        }
    }
}

TEST(Bvh, DoesNotGrowTheBoxesOfSmallPrimitivesBesideAHugeOne) {
    test::Random random(22);
    const Structure structure(test::beside_a_huge_one(random, 0x1p28F, {0, 0, 0}));
    const SceneView scene = view(structure.scene);
    for (std::uint32_t id = 0; id < test::small_count; ++id) {
        const Aabb box = primitive_bounds(scene, id);
        EXPECT_LT(half_area(pad(box, structure.frame.padding)), 1.01F * half_area(box)) << id;
    }
}

TEST(Bvh, NeverLosesTheFirstThingInTheBoundsFromAfar) {
    // a wall of tiles, thin and flush with the border of the bounds: a ray that is brought near must stay before it
    PreparedScene wall;
    for (int i = 0; i < 64; ++i) {
        const auto y = static_cast<float>(i % 8), z = static_cast<float>(i / 8);
        wall.boxes.push_back({{-1, y - 4, z - 4}, {-0.9999F, y - 3, z - 3}});
    }
    wall.boxes.push_back({{2, -4, -4}, {3, 4, 4}});
    wall.material_of.assign(wall.boxes.size(), 0);
    const Structure structure(wall);
    test::Random random(3);
    std::vector<Ray<float>> rays;
    for (int i = 0; i < 40'000; ++i) {
        const double far = std::exp2(random.uniform(0.0, 22.0));
        const Vec3f origin = {static_cast<float>(-2 - far), static_cast<float>(random.uniform(-1.0, 1.0) * far),
                              static_cast<float>(random.uniform(-1.0, 1.0) * far)};
        const Vec3f target = {-1, random.uniform(-4.0F, 4.0F), random.uniform(-4.0F, 4.0F)};
        rays.push_back({origin, (target - origin) * static_cast<float>(std::exp2(random.uniform(-20.0, 20.0)))});
    }
    expect_same_as_loop(structure, rays, "wall");
}

TEST(Bvh, NeverLosesAHitOfAShortDirection) {
    // A big sphere whose box begins before a cluster of small ones, and that is hit behind it. The length of such a
    // direction has but a few bits in float: a limit from it must not be too low.
    PreparedScene scene;
    scene.spheres.push_back({{635, 635, 635}, 100});
    for (int i = 0; i < 12; ++i) {
        const float aside = 0.5F * static_cast<float>(i);
        scene.spheres.push_back({{555 + aside, 555, 555 - aside}, 1});
    }
    scene.material_of.assign(scene.spheres.size(), 0);
    scene.materials.emplace_back();
    const Structure structure(std::move(scene));
    std::vector<Ray<float>> rays;
    for (int k = 1; k < 2000; ++k) {
        const float step = 0x1p-149F * static_cast<float>(k);
        rays.push_back({{0, 0, 0}, {step, step, step}});
        rays.push_back({{-1e4F, -1e4F, -1e4F}, {step, step, step}});
    }
    expect_same_as_loop(structure, rays, "short");
}

TEST(Bvh, BoundsItsDepthForCoincidentPrimitives) {
    PreparedScene scene;
    scene.spheres.assign(5000, Sphere{{1, 2, 3}, 0.5F});
    scene.material_of.assign(5000, 0);
    scene.materials.emplace_back();
    const Structure structure(std::move(scene));
    EXPECT_EQ(find_bvh_defect(structure.bvh, view(structure.scene), structure.frame.padding), "");
    const auto expect_first = [&](const auto& tracer) {
        const Closest<float> hit = tracer.closest(Ray<float>{{1, 2, 0}, {0, 0, 1}}, NoSource{}, true);
        EXPECT_EQ(hit.primitive, 0U);
        EXPECT_EQ(hit.t, 2.5);
    };
    expect_first(structure.tracer());
    expect_first(structure.tracer<Decisions::behind_walk>());
}

/// Rays with more candidates than a tracer keeps that decides behind its walk.
std::size_t crowded_rays(const Structure& structure, const std::vector<Ray<float>>& rays) {
    const auto tracer = structure.tracer<Decisions::behind_walk>();
    std::size_t crowded = 0;
    for (const Ray<float>& ray : rays) {
        const Proposal<float> proposal = propose(ray, structure.frame, is_traceable(ray));
        if (!proposal.active) continue;
        const QueryRay query = make_query_ray(proposal, structure.frame, NoSource{});
        Candidates<decltype(tracer)::most_candidates> candidates;
        float limit = 3e38F;
        (void)tracer.collect<Search::nearest, float>(NoSource{}, query, 0.0F, limit, candidates);
        if (candidates.overflow) ++crowded;
    }
    return crowded;
}

TEST(Candidates, AreTakenUpToALimit) {
    Candidates<3> candidates;
    candidates.add(1, 7, 9);
    candidates.add(5, 8, 9);
    candidates.add(2, 9, 9);
    EXPECT_EQ(candidates.take(4), 7U);
    EXPECT_EQ(candidates.take(4), 9U);
    EXPECT_EQ(candidates.take(4), no_primitive) << "the other begins at 5";
    candidates.add(3, 6, 5);
    EXPECT_EQ(candidates.take(5), 8U);
    EXPECT_EQ(candidates.take(5), 6U);
    EXPECT_EQ(candidates.take(5), no_primitive);
}

TEST(Bvh, DecidesAboutCrowds) {
    const test::Bundles bundles = test::make_bundles(11);
    for (const PreparedScene* scene : {&bundles.solids, &bundles.faces}) {
        const Structure structure(*scene);
        const std::vector<Ray<float>> rays = test::rays_at_bundles(structure.scene, 10'000, 12);
        EXPECT_GT(crowded_rays(structure, rays), 1000U);
        expect_same_as_loop(structure, rays, scene == &bundles.solids ? "solids" : "faces");
    }
}

TEST(Bvh, BoundsItsDepthForSizesThatHalve) {
    // each sphere half as big and half as far as the one before: surface areas favour splitting off one at a time
    PreparedScene scene;
    float x = 1e15F;
    for (int i = 0; i < 150; ++i, x *= 0.5F) scene.spheres.push_back({{x, 0, 0}, 0.1F * x});
    scene.material_of.assign(scene.spheres.size(), 0);
    scene.materials.emplace_back();
    const Structure structure(std::move(scene));
    EXPECT_EQ(find_bvh_defect(structure.bvh, view(structure.scene), structure.frame.padding), "");
}

// A hierarchy deeper than the stack, as build_bvh() never makes one: a chain, each node a leaf and the rest.
TEST(Bvh, StaysRightAndCountsWhenTheStackIsFull) {
    constexpr std::uint32_t count = 200;
    PreparedScene scene;
    for (std::uint32_t i = 0; i < count; ++i) scene.spheres.push_back({{0, 0, -3 * static_cast<float>(i) - 5}, 1});
    scene.material_of.assign(count, 0);
    scene.materials.emplace_back();
    Structure structure(std::move(scene));
    Bvh& bvh = structure.bvh;
    bvh.nodes.clear();
    bvh.entry_ids.clear();
    bvh.entry_spheres.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
        bvh.entry_ids.push_back(i);
        bvh.entry_spheres.push_back(structure.scene.spheres[i]);
        if (i + 1 == count) break;
        // all boxes hold everything, and the chain comes first, so that each step leaves leaves on the stack
        BvhNode node{};
        std::fill(node.corner, node.corner + 3, -1024.0F);
        for (unsigned axis = 0; axis < 3; ++axis) node.frame |= frame_exponent(4) << (8 * axis);  // steps of 16
        node.lower_x = node.lower_y = node.lower_z = 0xFFFF0000U;
        node.upper_x = node.upper_y = node.upper_z = 0xFFFFU;
        const bool is_last = i + 2 == count;
        node.frame |= (is_last ? 0U : 1U) << 24;
        node.first_inner = static_cast<std::int32_t>(i + 1);
        node.leaf_base = is_last ? ~static_cast<std::int32_t>(i) : -static_cast<std::int32_t>(i);
        bvh.nodes.push_back(node);
    }
    for (int i = 0; i < spare_entries; ++i) {
        bvh.entry_ids.push_back(bvh.entry_ids.back());
        bvh.entry_spheres.push_back(bvh.entry_spheres.back());
    }
    EXPECT_NE(find_bvh_defect(bvh, view(structure.scene), {0}), "") << "too deep";
    unsigned long long overflows = 0;
    BvhTracer tracer = structure.tracer();
    auto behind_walk = structure.tracer<Decisions::behind_walk>();
    tracer.bvh.stack_overflows = behind_walk.bvh.stack_overflows = &overflows;
    const LoopTracer one_by_one = {view(structure.scene)};
    for (const float x : {0.0F, 0.5F, 0.999F, 1.5F}) {
        const Answers expected(one_by_one, {{x, 0, 0}, {0, 0, -1}});
        expect_same(tracer, expected, "x = " + std::to_string(x));
        expect_same(behind_walk, expected, "behind the walk, x = " + std::to_string(x));
        const Answers from_behind(one_by_one, {{x, 0, -1000}, {0, 0, 1}});
        expect_same(tracer, from_behind, "from behind, x = " + std::to_string(x));
        for (const double t_max : {0.5 * expected.nearest.t, 2.0 * expected.nearest.t}) {
            const bool blocked = expected.nearest.t < t_max;
            AnyHit of_leaves = {tracer.scene, expected.ray, t_max}, of_candidates = of_leaves;
            EXPECT_EQ(tracer.find_blocker(expected.ray, t_max, {}, true, of_leaves), blocked) << x;
            EXPECT_EQ(behind_walk.find_blocker(expected.ray, t_max, {}, true, of_candidates), blocked) << x;
            EXPECT_TRUE(blocked || (of_leaves.begun_again == 1 && of_candidates.begun_again == 1)) << x;
        }
    }
    EXPECT_GT(overflows, 0U);
    tracer.bvh.stack_overflows = nullptr;  // need not be counted
    EXPECT_EQ(tracer.closest(Ray<float>{{0, 0, 0}, {0, 0, -1}}, NoSource{}, true).t, 4.0);
}

TEST(Bvh, HoldsOnePrimitive) {
    PreparedScene scene;
    scene.spheres.push_back({{0, 0, 0}, 1});
    scene.material_of.push_back(0);
    scene.materials.emplace_back();
    const Structure structure(std::move(scene));
    EXPECT_EQ(structure.tracer().closest(Ray<float>{{0, 0, -3}, {0, 0, 1}}, NoSource{}, true).t, 2.0);
    EXPECT_EQ(structure.tracer().closest(Ray<float>{{0, 3, -3}, {0, 0, 1}}, NoSource{}, true).primitive, no_primitive);
}

TEST(ConstantMemoryTracer, GivesTheBitsOfTheLoop) {
    for (const std::uint32_t boxes : {0U, 1U, 4U}) {
        PreparedScene scene = test::make_scene({"few", 1, 0, 1, 32}, 7 + boxes);
        scene.spheres.resize(8 - boxes);
        scene.boxes.resize(boxes);
        scene.ellipsoids.clear();
        scene.parallelepipeds.clear();
        scene.material_of.resize(scene.spheres.size() + scene.boxes.size());
        const SceneView scene_view = view(scene);
        ASSERT_TRUE(fits_constant_memory(scene_view));
        const ConstantMemoryTracer few = make_constant_memory_tracer(scene_view, scene_view);
        const LoopTracer one_by_one = {scene_view};
        for (const Ray<float>& ray : test::make_rays(scene, 50'000, 8)) {
            if (!is_traceable(ray)) continue;
            expect_same(few, Answers(one_by_one, ray), "few");
            if (HasFatalFailure()) return;
        }
    }
    EXPECT_FALSE(fits_constant_memory(view(prepare(named_scene("spheres/9")))));
    EXPECT_FALSE(fits_constant_memory(view(prepare(named_scene("mixed/4")))));
    EXPECT_FALSE(fits_constant_memory(view(prepare(named_scene("triangles/1")))));
    EXPECT_FALSE(fits_constant_memory(view(prepare(named_scene("quads/1")))));
}

}  // namespace
}  // namespace tandem
