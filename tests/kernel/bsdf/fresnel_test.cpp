// Fresnel's reflectance: bounds, ends, and the formula in closed forms.
#include "tandem/kernel/bsdf/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tandem {
namespace {

/// Reflectance under the angle of incidence with the given cosine, onto z = 0 from above.
double reflectance(double cosine, double eta) {
    const Vec3d direction = {std::sqrt((1 - cosine) * (1 + cosine)), 0, -cosine};
    return fresnel_dielectric<float>(refract<float>(direction, {0, 0, 1}, eta), eta);
}

TEST(Fresnel, IsOneUnderTotalReflection) {
    EXPECT_EQ(reflectance(0.5, 1.5), 1);
    EXPECT_EQ(reflectance(1e-7, 1.5), 1);
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
