#include "tandem/kernel/shapes/crossing.h"

#include <gtest/gtest.h>

#include <limits>

#include "tandem/kernel/shapes/hit.h"

namespace tandem {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct FrontCase {
    Crossing<float> crossing;
    bool hit;
    double t;
};

TEST(FirstInFront, IsTheLeastPositiveParameter) {
    const FrontCase cases[] = {
        {{true, 1, 2}, true, 1},            // ahead
        {{true, -1, 2}, true, 2},           // origin inside: the exit
        {{true, -2, -1}, false, 0},         // behind
        {{true, 0, 2}, true, 2},            // on the surface, heading in: t must be positive
        {{true, -0.0, 2}, true, 2},         //
        {{true, -1, 0}, false, 0},          // on the surface, heading out
        {{true, 0, 0}, false, 0},           // touching there
        {{true, 3, 3}, true, 3},            // touching ahead
        {{false, 1, 2}, false, 0},          // the line misses
        {{true, 4e-324, 1}, true, 4e-324},  // no epsilon
        {{true, -infinity, 5}, true, 5},   {{true, -infinity, infinity}, true, infinity},
        {{true, nan, nan}, false, 0},      {{true, nan, -1}, false, 0},
    };
    for (const FrontCase& c : cases) {
        double t = -7;
        EXPECT_EQ(first_hit(c.crossing, t), c.hit) << c.crossing.t_near << " to " << c.crossing.t_far;
        if (c.hit) {
            EXPECT_EQ(t, c.t);
        }
    }
}

TEST(Closest, EqualParametersGoToTheLowerId) {
    Closest<float> best = no_hit<float>();
    EXPECT_EQ(to_hit(best).primitive, no_primitive);
    EXPECT_TRUE(is_closer<float>(1e300, 5U, best));
    best = {2.0, 5U};
    EXPECT_TRUE(is_closer<float>(2.0, 4U, best));
    EXPECT_FALSE(is_closer<float>(2.0, 5U, best));
    EXPECT_FALSE(is_closer<float>(2.0, 6U, best));
    EXPECT_TRUE(is_closer<float>(std::nextafter(2.0, 0.0), 6U, best)) << "less than a float apart";
    EXPECT_FALSE(is_closer<float>(nan, 0U, best));
}

}  // namespace
}  // namespace tandem
