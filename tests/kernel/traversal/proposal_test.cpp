// The ends of the query to a structure. That no candidate is lost is tested by tests/agree/structure_test.cpp.
#include "tandem/kernel/traversal/proposal.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace tandem
