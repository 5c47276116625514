// Refraction against Snell's law in 100 decimal digits, on the very doubles that went in.
#include "tandem/kernel/bsdf/refract.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/exact_geometry.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::Big;
using test::BigVector;

/// A direction that meets the plane z = 0 from above under an angle with the given sine.
Vec3d incident(double sine, double azimuth) {
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), -std::sqrt((1 - sine) * (1 + sine))};
}

/// A random unit normal, and the rotation that brings +z there applied to `d`.
struct Turned {
    Vec3d direction, normal;
};
Turned turn(const Vec3d& d, test::Random& random) {
    const Matrix3 rotation = rotation_matrix(
        {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(0.1, 1.0)});
    return {normalize(rotation * d), normalize(rotation * Vec3d{0, 0, 1})};
}

/// (eta sine)^2 of the very doubles: eta^2 |d x n|^2 / (|d|^2 |n|^2).
Big exact_sine2(const Turned& t, double eta) {
    const BigVector d = test::big(t.direction);
    const BigVector n = test::big(t.normal);
    const BigVector c = {d.y * n.z - d.z * n.y, d.z * n.x - d.x * n.z, d.x * n.y - d.y * n.x};
    return Big(eta) * Big(eta) * test::dot(c, c) / (test::dot(d, d) * test::dot(n, n));
}

double to_double(const Big& a) { return static_cast<double>(a); }

// F2 and the whole range: the sine behind is eta times the sine before, to 1e-12 of itself, however near the normal.
TEST(Refract, FollowsSnellAlsoNearTheNormal) {
    for (const double angle : {1e-8, 1e-4, 1e-2, 0.3, 1.0, 1.5}) {
        for (std::uint64_t number = 0; number < 5'000; ++number) {
            test::Random random(number);
            const double eta = random.uniform(0.4, 0.99);
            const Turned t = turn(incident(std::sin(angle), random.uniform(0.0, 6.28)), random);
            const Refraction<float> found = refract<float>(t.direction, t.normal, eta);
            ASSERT_TRUE(found.transmits);
            const Turned behind = {found.direction, t.normal};
            const double sine_out = to_double(sqrt(exact_sine2(behind, 1)));
            const double expected = to_double(sqrt(exact_sine2(t, eta)));
            // near the normal the direction's own last places are what is left of the angle
            ASSERT_NEAR(sine_out / expected, 1, 1e-12 + 4e-16 / angle) << "angle " << angle << ", case " << number;
            ASSERT_NEAR(dot(found.direction, found.direction), 1, 2e-15);
            ASSERT_LT(dot(found.direction, t.normal), 0) << "it must go through";
            ASSERT_NEAR(found.cosine_out, -dot(found.direction, t.normal), 1e-14);
        }
    }
}

TEST(Refract, LeavesAlongTheInterfaceExactlyAtTheCriticalAngle) {
    // eta = 2, sine = 1/2
    const Vec3d direction = {0.5, 0, -std::sqrt(0.75)};
    const Refraction<float> found = refract<float>(direction, {0, 0, 1}, 2.0);
    ASSERT_TRUE(found.transmits);
    EXPECT_EQ(found.cosine_out, 0);
    EXPECT_NEAR(found.direction.x, 1, 1e-15);
}

TEST(Refract, DoesNotTransmitNan) {
    const double nan = std::nan("");
    EXPECT_FALSE(refract<float>({nan, 0, -1}, {0, 0, 1}, 1.5).transmits);
    EXPECT_FALSE(refract<float>({0, 0, -1}, {0, 0, 1}, nan).transmits);
}

}  // namespace
}  // namespace tandem
