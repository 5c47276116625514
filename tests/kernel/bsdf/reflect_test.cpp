// Mirror directions keep their length, bounce after bounce.
#include "tandem/kernel/bsdf/reflect.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/aim.h"
#include "support/random.h"

namespace tandem {
namespace {

TEST(Reflect, MirrorsTheAngle) {
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        test::Random random(number);
        const Vec3d normal = test::any_unit(random);
        const Vec3d direction = test::any_unit(random);
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
