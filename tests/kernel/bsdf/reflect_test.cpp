// Mirror directions keep their length, bounce after bounce.
#include "tandem/kernel/bsdf/reflect.h"

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
