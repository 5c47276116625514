// Fresnel's reflectance: bounds, ends, and the formula in closed forms.
#include "tandem/material/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"

namespace tandem {
namespace {

/// Reflectance under the angle of incidence with the given cosine, onto z = 0 from above.
double reflectance(double cosine, double eta) {
    const Vec3d direction = {std::sqrt((1 - cosine) * (1 + cosine)), 0, -cosine};
    return fresnel_dielectric<float>(refract<float>(direction, {0, 0, 1}, eta), eta);
}

// F4
TEST(Fresnel, StaysWithinZeroAndOneDownToGrazing) {
    for (const double eta : {1 / 2.4, 1 / 1.5, 0.999999, 1.0, 1.000001, 1.5, 2.4}) {
        for (const double cosine : {0.0, 1e-300, 1e-20, 1e-12, 1e-7, 1e-3, 0.3, 0.9, 1.0}) {
            const double r = reflectance(cosine, eta);
            ASSERT_GE(r, 0) << "cosine " << cosine << ", eta " << eta;
            ASSERT_LE(r, 1) << "cosine " << cosine << ", eta " << eta;
        }
        if (eta != 1) {
            EXPECT_EQ(reflectance(0, eta), 1) << eta;
        }
    }
    for (std::uint64_t number = 0; number < 100'000; ++number) {
        test::Random random(number);
        const double r = reflectance(std::exp2(random.uniform(-60.0, 0.0)), random.uniform(0.3, 3.0));
        ASSERT_TRUE(r >= 0 && r <= 1) << "case " << number << ": " << r;
    }
}

// F3
TEST(Fresnel, IsZeroForEqualIndicesAtEveryAngle) {
    for (const double cosine : {0.0, 1e-9, 0.5, 1.0}) EXPECT_EQ(reflectance(cosine, 1.0), 0) << cosine;
}

TEST(Fresnel, IsOneUnderTotalReflection) {
    EXPECT_EQ(reflectance(0.5, 1.5), 1);
    EXPECT_EQ(reflectance(1e-7, 1.5), 1);
}

// F5: the transmittance is 1 - R, so R + T is 1 to the last place.
TEST(Fresnel, LosesNoEnergy) {
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        test::Random random(number);
        const double r = reflectance(random.uniform(0.0, 1.0), random.uniform(0.3, 3.0));
        ASSERT_NEAR(r + (1 - r), 1, 0x1p-53);
    }
}

TEST(Fresnel, AgreesWithClosedForms) {
    for (const double eta : {1 / 1.5, 1.5, 1 / 1.33, 2.4}) {
        const double normal = (eta - 1) / (eta + 1);
        EXPECT_NEAR(reflectance(1, eta), normal * normal, 1e-15) << eta;
    }
    // Brewster's angle, tan = n: no parallel part; the other is ((n^2 - 1) / (n^2 + 1))^2
    const double n = 1.5;
    const double perpendicular = (n * n - 1) / (n * n + 1);
    EXPECT_NEAR(reflectance(1 / std::sqrt(1 + n * n), 1 / n), perpendicular * perpendicular / 2, 1e-15);
    // the same from both sides (Stokes)
    for (const double sine : {0.1, 0.4, 0.6}) {
        const double from_glass = reflectance(std::sqrt(1 - sine * sine), 1.5);
        const double from_air = reflectance(std::sqrt(1 - 2.25 * sine * sine), 1 / 1.5);
        EXPECT_NEAR(from_glass, from_air, 1e-14) << sine;
    }
}

}  // namespace
}  // namespace tandem
