// Mirror directions keep their length, bounce after bounce.
#include "tandem/material/reflect.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"

namespace tandem {
namespace {

Vec3d unit_vector(test::Random& random) {
    while (true) {
        const Vec3d v = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
        if (dot(v, v) > 0.01 && dot(v, v) < 1) return normalize(v);
    }
}

constexpr double four_units = 4 * 0x1p-53;

// F6: the direction of a path of 500 mirror bounces, and what an albedo of 0.999 leaves of its light.
TEST(Reflect, KeepsUnitLengthOverFiveHundredBounces) {
    for (std::uint64_t path = 0; path < 200; ++path) {
        test::Random random(path);
        Vec3d direction = unit_vector(random);
        double throughput = 1;
        for (int bounce = 0; bounce < 500; ++bounce) {
            direction = reflect(direction, unit_vector(random));
            throughput *= 0.999;
            ASSERT_NEAR(std::sqrt(dot(direction, direction)), 1, four_units)
                << "path " << path << ", bounce " << bounce;
        }
        EXPECT_NEAR(throughput / std::pow(0.999, 500), 1, 1e-12);
    }
}

// F10: a normal that is too long by 3 u of float does not lengthen the direction.
TEST(Reflect, DoesNotPassOnTheErrorOfTheNormal) {
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        test::Random random(number);
        const Vec3d normal = unit_vector(random) * (1 + 3 * 0x1p-24);
        const Vec3d mirrored = reflect(unit_vector(random), normal);
        ASSERT_NEAR(std::sqrt(dot(mirrored, mirrored)), 1, four_units) << "case " << number;
    }
}

TEST(Reflect, MirrorsTheAngle) {
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        test::Random random(number);
        const Vec3d normal = unit_vector(random);
        const Vec3d direction = unit_vector(random);
        const Vec3d mirrored = reflect(direction, normal);
        ASSERT_NEAR(dot(mirrored, normal), -dot(direction, normal), 1e-15) << "case " << number;
        const Vec3d across = mirrored - direction;  // along the normal
        const Vec3d off = cross(across, normal);
        ASSERT_LE(std::sqrt(dot(off, off)), 1e-15) << "case " << number;
    }
    EXPECT_EQ(reflect(Vec3d{0, 0, -1}, Vec3d{0, 0, 1}), Vec3d(0, 0, 1));
    EXPECT_EQ(reflect(Vec3d{1, 0, 0}, Vec3d{0, 0, 1}), Vec3d(1, 0, 0));
}

}  // namespace
}  // namespace tandem
