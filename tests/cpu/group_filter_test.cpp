// The filters of groups may not drop a hit. What a hit is says the test in double; sphere_test and triangle_test hold
// it to the exact answer.
#include "cpu/group_filter.h"

#include <gtest/gtest.h>

#include "support/adversarial_rays.h"
#include "support/adversarial_triangles.h"
#include "support/exact_geometry.h"
#include "tandem/kernel/shapes/quad.h"
#include "tandem/kernel/shapes/sphere.h"

namespace tandem {
namespace {

using test::Random;
using Lane = Lanes<float, GroupIsa<Sse4>>;

constexpr std::uint64_t rays_per_kind = 4000;

void set(BodyGroup& group, int place, const Sphere& sphere) {
    group.x[place] = sphere.centre.x;
    group.y[place] = sphere.centre.y;
    group.z[place] = sphere.centre.z;
    group.radius[place] = sphere.radius;
}
template <int corners, class... Points>
void set(FaceGroup<corners>& group, int place, const Points&... points) {
    int corner = 0;
    ((group.x[corner][place] = points.x, group.y[corner][place] = points.y, group.z[corner][place] = points.z,
      ++corner),
     ...);
}

struct Counts {
    int hits = 0, misses = 0, passed_misses = 0;
};

/// `group` has the primitive in all places, in some without an id.
template <class Group, class Primitive>
void check(const Group& group, const Primitive& primitive, const Ray<float>& ray, const std::string& where,
           Counts& counts) {
    double t = 0;
    const bool hits = first_hit(primitive, ray, t);
    unsigned all = 0;
    for (int i = 0; i < group_size; ++i) all |= group.id[i] != no_primitive ? 1U << i : 0U;
    const unsigned passed = filter_group(in_all_lanes<Lane>(make_filter_ray(ray)), group);
    ASSERT_TRUE(passed == 0 || passed == all) << where;
    ASSERT_TRUE(!hits || passed == all) << where << ", " << test::reproducer(ray);
    ++(hits ? counts.hits : counts.misses);
    if (!hits && passed != 0) ++counts.passed_misses;
    // in the tier precise, rays are rounded
    ASSERT_EQ(filter_group(in_all_lanes<Lane>(make_filter_ray(to_real<double>(ray))), group), passed) << where;
}

/// Gives the first places of a group an id, at least one.
template <class Group>
void fill(Group& group, std::uint64_t number) {
    const auto filled = static_cast<int>(1 + number % group_size);
    for (int i = 0; i < group_size; ++i) group.id[i] = i < filled ? static_cast<std::uint32_t>(i) : no_primitive;
}

TEST(GroupFilter, KeepsHitsOfSpheres) {
    for (int kind = 0; kind < static_cast<int>(std::size(test::sphere_kinds)); ++kind) {
        Counts counts;
        for (std::uint64_t number = 0; number < rays_per_kind; ++number) {
            const auto [sphere, ray] = test::sphere_case(kind, number);
            if (!is_traceable(ray)) continue;
            BodyGroup group;
            fill(group, number);
            for (int i = 0; i < group_size; ++i) set(group, i, sphere);
            check(group, sphere, ray, "sphere_case(" + std::to_string(kind) + ", " + std::to_string(number) + ")",
                  counts);
            if (HasFatalFailure()) return;
        }
        if (kind == 0) {
            EXPECT_GT(counts.hits, 1000);
            EXPECT_LT(counts.passed_misses, counts.misses / 5);
        }
    }
}

TEST(GroupFilter, KeepsHitsOfTriangles) {
    for (int kind = 0; kind < static_cast<int>(std::size(test::triangle_kinds)); ++kind) {
        Counts counts;
        for (std::uint64_t number = 0; number < rays_per_kind; ++number) {
            const auto [triangle, ray] = test::triangle_case(kind, number);
            if (!is_traceable(ray)) continue;
            TriangleGroup group;
            fill(group, number);
            for (int i = 0; i < group_size; ++i) set(group, i, triangle.v0, triangle.v1, triangle.v2);
            check(group, triangle, ray, "triangle_case(" + std::to_string(kind) + ", " + std::to_string(number) + ")",
                  counts);
            if (HasFatalFailure()) return;
        }
    }
}

TEST(GroupFilter, KeepsHitsOfQuads) {
    Counts counts;
    for (std::uint64_t number = 0; number < 4 * rays_per_kind; ++number) {
        const auto [triangle, ray] = test::triangle_case(0, number);
        if (!is_traceable(ray)) continue;
        Random random(number);
        const Vec3f &v0 = triangle.v0, &v1 = triangle.v1, &v2 = triangle.v2;
        // the ray is aimed at the first half or at the second one
        const Vec3f v3 = v2 + (v0 - v1) * random.uniform(0.1F, 2.0F);
        const Quad quad = random.coin() ? Quad{v0, v1, v2, v3} : Quad{v2, v3, v0, v1};
        QuadGroup group;
        fill(group, number);
        for (int i = 0; i < group_size; ++i) set(group, i, quad.v0, quad.v1, quad.v2, quad.v3);
        check(group, quad, ray, "quad of triangle_case(0, " + std::to_string(number) + ")", counts);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(counts.hits, 1000);
    EXPECT_LT(counts.passed_misses, counts.misses / 5);
}

// Each place has its own answer.
TEST(GroupFilter, TellsPlacesApart) {
    BodyGroup group;
    for (int i = 0; i < group_size; ++i) {
        group.id[i] = static_cast<std::uint32_t>(i);
        set(group, i, {{static_cast<float>(i), 0, 0}, 0.25F});
    }
    for (int i = 0; i < group_size; ++i) {
        const Ray<float> ray = {{static_cast<float>(i), 0, -3}, {0, 0, 1}};
        EXPECT_EQ(filter_group(in_all_lanes<Lane>(make_filter_ray(ray)), group), 1U << i);
    }
    group.id[7] = group.id[6] = no_primitive;
    const Ray<float> along = {{-3, 0, 0}, {1, 0, 0}};
    EXPECT_EQ(filter_group(in_all_lanes<Lane>(make_filter_ray(along)), group), 0x3FU);
}

}  // namespace
}  // namespace tandem
