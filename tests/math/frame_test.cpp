// Orthonormal frames, above all where the normal is near -z.
#include "tandem/math/frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"

namespace tandem {
namespace {

void expect_orthonormal(const Vec3d& normal) {
    const Frame<double> f = frame_around(normal);
    constexpr double tolerance = 8 * 0x1p-53;
    EXPECT_NEAR(dot(f.tangent, f.tangent), 1, tolerance) << normal.x << " " << normal.y << " " << normal.z;
    EXPECT_NEAR(dot(f.bitangent, f.bitangent), 1, tolerance);
    EXPECT_NEAR(dot(f.tangent, f.bitangent), 0, tolerance);
    EXPECT_NEAR(dot(f.tangent, f.normal), 0, tolerance);
    EXPECT_NEAR(dot(f.bitangent, f.normal), 0, tolerance);
    const Vec3d third = cross(f.tangent, f.bitangent);
    EXPECT_NEAR(dot(third, normal), 1, tolerance) << "right-handed";
    EXPECT_EQ(f.normal, normal);
}

// G11: the form before Duff et al. is off by 1.24 there.
TEST(Frame, IsOrthonormalNextToMinusZ) {
    for (const double off : {0.0, 1e-300, 1e-20, 1e-12, 1e-9, 1e-8, 1e-7, 1e-5, 1e-3}) {
        for (const double z : {1.0, -1.0}) {
            expect_orthonormal(normalize(Vec3d{off, 0, z}));
            expect_orthonormal(normalize(Vec3d{0, -off, z}));
            expect_orthonormal(normalize(Vec3d{off, off, z}));
        }
    }
}

TEST(Frame, IsOrthonormalAnywhere) {
    expect_orthonormal({1, 0, 0});
    expect_orthonormal({0, -1, 0});
    expect_orthonormal({-1, 0, -0.0});
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        test::Random random(number);
        expect_orthonormal(
            normalize(Vec3d{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)}));
        ASSERT_FALSE(::testing::Test::HasFailure()) << "case " << number;
    }
}

}  // namespace
}  // namespace tandem
