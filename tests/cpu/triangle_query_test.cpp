// Packets that defer the hits of triangles find what single rays find that decide about every triangle at once: in any
// order of the triangles, on meshes, where surfaces nearly touch, from behind culled faces, and for shadow rays.
#include "cpu/triangle_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/aim.h"
#include "tandem/kernel/traversal/intersect.h"

namespace tandem {
namespace {

using test::any_point;

struct Case {
    std::vector<Triangle> triangles;
    CpuSceneView view{};

    void use() {
        Aabb box;
        for (const Triangle& triangle : triangles) box = merge(box, bounds(triangle));
        view.scene.triangles = triangles.data();
        view.scene.triangle_count = static_cast<std::uint32_t>(triangles.size());
        view.frame = make_structure_frame(box);
    }
};

/// A fan of triangles around an edge and its ends, as in a mesh.
void add_fan(test::Random& random, std::vector<Triangle>& triangles) {
    const Vec3f a = any_point(random), b = any_point(random);
    for (int i = 0; i < 5; ++i) triangles.push_back({a, b, any_point(random)});
}
/// Triangles that differ by a few ulp, or not at all.
void add_crowd(test::Random& random, std::vector<Triangle>& triangles) {
    const Triangle one = {any_point(random), any_point(random), any_point(random)};
    for (int i = 0; i < 6; ++i) {
        Triangle other = one;
        other.v2.x += static_cast<float>(random.below(4)) * 0x1p-24F;
        triangles.push_back(other);
    }
}

template <class Packet>
struct Rays {
    using One = Scalar<Packet>;
    Ray<Packet> ray;
    QuerySource<Packet> source;
    Double<Packet> t_max;
    Ray<One> one[Packet::size];
    QuerySource<One> source_of[Packet::size];
};

/// Rays to points of triangles, their edges or corners; some leave a triangle, some have a light.
template <class Packet>
Rays<Packet> any_rays(test::Random& random, const std::vector<Triangle>& triangles) {
    using One = Scalar<Packet>;
    Rays<Packet> rays;
    rays.source.culls = random.coin();
    const auto count = static_cast<std::uint32_t>(triangles.size());
    for (int i = 0; i < Packet::size; ++i) {
        const Triangle& target = triangles[random.below(count)];
        const float u = random.below(3) == 0 ? 0.0F : random.uniform(0.0F, 1.0F);
        const float v = random.below(3) == 0 ? 1.0F - u : random.uniform(0.0F, 1.0F - u);
        const Vec3f to = target.v0 + (target.v1 - target.v0) * u + (target.v2 - target.v0) * v;
        const Vec3f from = any_point(random) * (random.coin() ? 1.0F : 50.0F);
        rays.one[i] = {Vec3<One>(from), Vec3<One>(to - from)};
        for (int axis = 0; axis < 3; ++axis) {
            rays.ray.origin[axis].set(i, rays.one[i].origin[axis]);
            rays.ray.direction[axis].set(i, rays.one[i].direction[axis]);
        }
        rays.source_of[i].culls = rays.source.culls;
        if (random.coin()) rays.source_of[i].primitive = random.below(count);
        if (random.coin()) rays.source_of[i].light = random.below(count);
        rays.source.primitive.set(i, rays.source_of[i].primitive);
        rays.source.light.set(i, rays.source_of[i].light);
        rays.t_max.set(i, random.coin() ? random.uniform(0.5, 1.5) : __builtin_huge_val());
    }
    return rays;
}

/// Searches as a traversal that visits the triangles in any order. Adds to `at_once` how often a triangle could not be
/// deferred.
template <Search search, class Packet>
Closest<Packet> deferred(const Case& scene, const Rays<Packet>& rays, test::Random& random, int& at_once) {
    constexpr float found = -__builtin_huge_valf();
    const Proposal<Packet> proposal = propose(rays.ray, scene.view.frame, Mask<Packet>(true));
    Closest<Packet> best = search == Search::any ? closest_starting_at<Packet>(rays.t_max) : no_hit<Packet>();
    TriangleQuery<Packet> query;
    query.template start<search>(scene.view, proposal, rays.source, best.t);
    Float<Packet> limit = proposal.limit(best.t);
    const Mask<Packet> begins = proposal.active && limit >= Float<Packet>(0.0F);
    std::vector<std::uint32_t> order;
    for (std::uint32_t id = 0; id < scene.triangles.size(); ++id) {
        order.insert(order.begin() + random.below(id + 1), id);
    }
    for (const std::uint32_t id : order) {
        EXPECT_TRUE(query.defers(scene.view, id));
        const Mask<Packet> active = begins && limit >= Float<Packet>(0.0F);
        const Mask<Packet> left = query.template test<search>(scene.view, id, rays.source, active, found, limit);
        if (!any(left)) continue;
        ++at_once;
        const Double<Packet> before = best.t;
        test_primitive(scene.triangles[id], id, rays.ray, rays.source, left, best);
        const Float<Packet> nearer =
            search == Search::any ? Float<Packet>(found) : lesser(proposal.limit(best.t), limit);
        limit = select(best.t < before, nearer, limit);
    }
    const Mask<Packet> is_found = begins && limit < Float<Packet>(0.0F);
    query.decide(scene.view, rays.ray, limit, begins && !is_found, best);
    best.t = select(is_found, Double<Packet>(0.0), best.t);
    return best;
}

template <class Packet>
void compare(const Case& scene, const Rays<Packet>& rays, std::uint64_t seed, int& at_once) {
    using One = Scalar<Packet>;
    test::Random random(seed);
    const Closest<Packet> nearest = deferred<Search::nearest>(scene, rays, random, at_once);
    const Closest<Packet> shadow = deferred<Search::any>(scene, rays, random, at_once);
    for (int i = 0; i < Packet::size; ++i) {
        Closest<One> want = no_hit<One>(), blocked = closest_starting_at<One>(rays.t_max[i]);
        for (std::uint32_t id = 0; id < scene.triangles.size(); ++id) {
            test_primitive(scene.triangles[id], id, rays.one[i], rays.source_of[i], true, want);
            test_primitive(scene.triangles[id], id, rays.one[i], rays.source_of[i], true, blocked);
        }
        EXPECT_EQ(nearest.t[i], want.t) << "seed " << seed << ", lane " << i;
        EXPECT_EQ(nearest.primitive[i], want.primitive) << "seed " << seed << ", lane " << i;
        EXPECT_EQ(shadow.t[i] < rays.t_max[i], blocked.t < rays.t_max[i]) << "seed " << seed << ", lane " << i;
    }
}

template <class Packet>
void compare_all() {
    int at_once = 0;
    for (std::uint64_t seed = 0; seed < 20000; ++seed) {
        test::Random random(seed);
        Case scene;
        for (std::uint32_t parts = 1 + random.below(3); parts > 0; --parts) {
            random.coin() ? add_fan(random, scene.triangles) : add_crowd(random, scene.triangles);
        }
        const bool has_culled = random.coin();
        for (Triangle& triangle : scene.triangles) {
            if (has_culled && random.coin()) triangle.attributes.sides = FaceSides::culled;
        }
        scene.use();
        compare(scene, any_rays<Packet>(random, scene.triangles), seed, at_once);
        if (testing::Test::HasFailure()) return;
    }
    EXPECT_GT(at_once, 100) << "crowds were deferred as well";
}

TEST(TriangleQuery, FindsTheHitsOfSingleRaysInStrict) { compare_all<Lanes<float, Sse4>>(); }
TEST(TriangleQuery, FindsTheHitsOfSingleRaysInPrecise) { compare_all<Lanes<double, Sse4>>(); }

// A light may be infinitely far away.
TEST(TriangleQuery, EndsASearchForAnyHitAtACertainOne) {
    using Packet = Lanes<float, Sse4>;
    Case scene;
    scene.triangles = {{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{-1, -1, 5}, {1, -1, 5}, {0, 1, 5}}};
    scene.use();
    const Ray<Packet> ray = {Vec3<Packet>(Vec3f{0, 0, 3}), Vec3<Packet>(Vec3f{0, 0, -1})};
    const Proposal<Packet> proposal = propose(ray, scene.view.frame, Mask<Packet>(true));
    for (const double end : {2.0, 4.0, HUGE_VAL}) {
        TriangleQuery<Packet> query;
        const Double<Packet> farthest(end);
        query.start<Search::any>(scene.view, proposal, QuerySource<Packet>(), farthest);
        Float<Packet> limit = proposal.limit(farthest);
        const Mask<Packet> left =
            query.test<Search::any>(scene.view, 0, QuerySource<Packet>(), Mask<Packet>(true), -1.0F, limit);
        EXPECT_FALSE(any(left));
        const bool reaches_triangle = end > 3;
        for (int i = 0; i < Packet::size; ++i) EXPECT_EQ(limit[i] < 0, reaches_triangle) << "until " << end;
    }
}

TEST(TriangleQuery, DefersOnlyTrianglesWhoseHitsAllCount) {
    using Packet = Lanes<float, Sse4>;
    test::Random random(1);
    Case scene;
    add_fan(random, scene.triangles);
    scene.use();
    scene.view.first_id[embree_triangles] = 3;
    const Rays<Packet> rays = any_rays<Packet>(random, scene.triangles);
    const auto defers = [&](std::uint32_t id, const QuerySource<Packet>& source) {
        TriangleQuery<Packet> query;
        query.start<Search::nearest>(scene.view, propose(rays.ray, scene.view.frame, Mask<Packet>(true)), source,
                                     no_hit<Packet>().t);
        return query.defers(scene.view, id);
    };
    EXPECT_FALSE(defers(2, rays.source)) << "a solid";
    EXPECT_TRUE(defers(3, rays.source));
    EXPECT_TRUE(defers(7, rays.source));
    EXPECT_FALSE(defers(8, rays.source)) << "a quad";
    QuerySource<Packet> beyond_mask = rays.source;
    beyond_mask.last_masked.t.set(2, 0.5);
    EXPECT_FALSE(defers(3, beyond_mask));
    scene.view.scene.cutout_kinds = PrimitiveKinds::triangle;
    EXPECT_TRUE(defers(3, rays.source)) << "sides are known, and masks are not the tracer's";
}

}  // namespace
}  // namespace tandem
