// The ends of the query to a structure. That no candidate is lost is tested by tests/agree/structure_test.cpp.
#include "tandem/kernel/traversal/proposal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/exact_geometry.h"
#include "support/random.h"
#include "tandem/kernel/traversal/quick_proposal.h"
#include "tandem/math/lanes.h"

namespace tandem {
namespace {

constexpr double infinity = __builtin_huge_val();
const StructureFrame frame = make_structure_frame({{-1, -1, -1}, {1, 1, 1}});

/// A ray of length 3 from inside the bounds, so that the query ray starts with it.
template <class Real>
Ray<Real> ray_inside() {
    return {Vec3<Real>(Vec3f{0, 0, 0}), Vec3<Real>(Vec3f{2, 1, -2})};
}

template <class Real>
void expect_ends(const Proposal<Real>& proposal, const char* tier) {
    const auto limit = [&](double t) { return to_plain(lane(proposal.limit(Double<Real>(t)), 0)); };
    const auto start = [&](double t) { return to_plain(lane(proposal.start(Double<Real>(t)), 0)); };
    EXPECT_EQ(limit(infinity), 3e38F) << tier;
    EXPECT_EQ(start(infinity), 3e38F) << tier << ": a search for any hit may stop at the first certain one";
    for (const double t : {0.25, 1.0, 1e10}) {
        EXPECT_GE(limit(t), static_cast<float>(3 * t)) << tier;
        EXPECT_LE(start(t), static_cast<float>(3 * t)) << tier;
        EXPECT_GT(start(t), static_cast<float>(2.999 * t)) << tier;
    }
    EXPECT_EQ(start(0), 0) << tier;
}

TEST(Proposal, HasEndsForEveryPrecision) {
    expect_ends(propose(ray_inside<float>(), frame, true), "strict");
    expect_ends(propose_quickly(ray_inside<float>(), frame), "strict, quickly");
    expect_ends(propose(ray_inside<double>(), frame, true), "precise");
    using Packet = Lanes<float, Sse4>;
    expect_ends(propose(ray_inside<Packet>(), frame, Mask<Packet>(true)), "strict, packets");
}

// Decisions give a t that errs by 2^-26 of itself.
TEST(Proposal, HasEndsThatAllowForTheErrorOfT) {
    for (const float far : {10.0F, 0x1p12F, 0x1p30F}) {
        const Proposal<float> proposal = propose_quickly({{0, 0, -far}, {0, 0, 1}}, frame);
        const double t = static_cast<double>(far);  // in the middle of the bounds
        ASSERT_GT(proposal.t_offset, t - 1.1);
        EXPECT_GE(widen(proposal.limit(t)), t * (1 + 0x1p-26) - proposal.t_offset) << far;
        EXPECT_LE(widen(proposal.start(t)), greater(t * (1 - 0x1p-26) - proposal.t_offset, 0.0)) << far;
    }
}

/// A line through the origin of space, from a distance of up to `most`, and nothing is rounded.
template <class Real>
Ray<Real> ray_from_afar(test::Random& random, float size, double most) {
    const auto coordinate = [&] { return random.uniform(-1.0, 1.0) * std::exp2(random.uniform(-20.0, 0.0)); };
    const Vec3d towards = normalize(Vec3d{coordinate(), coordinate(), coordinate()});
    const double length = std::exp2(random.uniform(-20.0, 20.0));
    const auto along = [&](double d) { return static_cast<Real>(d * length); };
    const Vec3<Real> direction = {along(towards.x), along(towards.y), along(towards.z)};
    const double distance = std::exp2(random.uniform(std::log2(double{size}), std::log2(most)));
    return {direction * -static_cast<Real>(std::exp2(std::round(std::log2(distance / length)))), direction};
}

/// That the query ray starts on the ray and before the bounds, but not far before them.
template <class Real>
void expect_to_reach_the_bounds(const Ray<Real>& ray, const StructureFrame& bounds, const Proposal<Real>& proposal) {
    using test::Big;
    const test::BigVector o = test::big(ray.origin), d = test::big(ray.direction);
    const auto entry = test::hit_box(o, d, test::big(bounds.bounds.lower), test::big(bounds.bounds.upper));
    if (!entry) return;  // whether such a ray is active does not matter
    ASSERT_TRUE(proposal.active);
    const Big size(reach(bounds.bounds));
    const bool is_within_reach = abs(o.x) <= size && abs(o.y) <= size && abs(o.z) <= size;
    if (is_within_reach || !entry->entering) return;  // not moved
    const test::BigVector start = test::big(unrounded_origin(ray, bounds, proposal));
    const Big t = test::dot(start - o, d) / test::dot(d, d);
    const test::BigVector true_start = test::along(o, d, t), true_entry = test::along(o, d, entry->t);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(abs(start[axis] - true_start[axis]), size * Big(0x1p-39)) << axis;
        EXPECT_LE(abs(start[axis] - true_entry[axis]), size * Big(0x1p-6)) << axis;
        EXPECT_LE(abs(start[axis]), size * Big(1 + 0x1p-6)) << axis;
    }
    const Big rounding = size * Big(0x1p-39) / sqrt(test::dot(d, d));
    EXPECT_LE(t, entry->t + rounding) << "the bounds are padded by far more";
    EXPECT_LE(abs(Big(proposal.t_offset) - t), t * Big(0x1p-49) + rounding);
}

template <class Real, class Propose>
void expect_to_reach_the_bounds_from(double most, const Propose& propose_one, const char* what) {
    test::Random random(7);
    for (const float size : {1e-20F, 1.0F, 1e10F}) {
        const StructureFrame bounds = make_structure_frame({{-size, -0.5F * size, 0}, {size, size, 0.25F * size}});
        for (int i = 0; i < 3'000; ++i) {
            const auto ray = ray_from_afar<Real>(random, size, most < 1e18 ? most * widen(size) : most);
            if (!is_traceable(ray)) continue;
            expect_to_reach_the_bounds(ray, bounds, propose_one(ray, bounds));
            ASSERT_FALSE(::testing::Test::HasFailure()) << what << ", size " << size << ", ray " << i;
        }
    }
}

TEST(Proposal, ReachesTheBoundsFromAnyDistance) {
    const auto slow = [](const auto& ray, const StructureFrame& bounds) { return propose(ray, bounds, true); };
    const auto quick = [](const auto& ray, const StructureFrame& bounds) { return propose_quickly(ray, bounds); };
    expect_to_reach_the_bounds_from<float>(1e18, quick, "quickly");
    expect_to_reach_the_bounds_from<float>(1e18, slow, "strict");
    expect_to_reach_the_bounds_from<double>(0x1p34, slow, "precise");
}

}  // namespace
}  // namespace tandem
