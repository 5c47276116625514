#include "tandem/math/vec.h"

#include <gtest/gtest.h>

#include "support/exact_geometry.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::Big;

double ulp_of(double a) { return std::nextafter(std::abs(a), HUGE_VAL) - std::abs(a); }

// Float vectors of every magnitude, subnormal to largest: their squares are normal doubles.
TEST(Vec, NormalizeIsWithinFourUnitsOfTheLastPlace) {
    test::Random random(11);
    for (int i = 0; i < 20000; ++i) {
        const double size = random.uniform(-149.0, 127.0);
        const auto component = [&] { return static_cast<double>(random.log_uniform(size - 20, size)); };
        const Vec3d v = {component(), component(), component()};
        const Vec3d unit = normalize(v);
        const test::BigVector exact = test::big(v);
        const Big length = sqrt(test::dot(exact, exact));
        if (length == 0) continue;
        for (int k = 0; k < 3; ++k) {
            const Big error = abs(Big(unit[k]) - exact[k] / length);
            ASSERT_LE(static_cast<double>(error), 4 * ulp_of(unit[k]))
                << std::hexfloat << v.x << " " << v.y << " " << v.z;
        }
    }
    EXPECT_EQ(normalize(Vec3d{0, 0, 0}), (Vec3d{0, 0, 0}));
}

TEST(Vec, AccurateCrossKeepsItsDigitsWhenProductsCancel) {
    test::Random random(12);
    for (int i = 0; i < 20000; ++i) {
        const Vec3d a = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
        Vec3d b = a * random.uniform(0.5, 2.0);
        const double noise = std::exp2(random.uniform(-60.0, 0.0));
        for (int k = 0; k < 3; ++k) b[k] += random.uniform(-noise, noise);
        const Vec3d ours = accurate_cross(a, b);
        for (int k = 0; k < 3; ++k) {
            const int p = (k + 1) % 3, q = (k + 2) % 3;
            const Big exact = Big(a[p]) * Big(b[q]) - Big(a[q]) * Big(b[p]);
            if (exact == 0) {
                ASSERT_EQ(ours[k], 0);
                continue;
            }
            ASSERT_LE(static_cast<double>(Big(abs(Big(ours[k]) - exact))), 1.5 * ulp_of(static_cast<double>(exact)))
                << std::hexfloat << a[p] << " * " << b[q] << " - " << a[q] << " * " << b[p];
        }
    }
}

}  // namespace
}  // namespace tandem
