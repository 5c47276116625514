#include "tandem/math/transform.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

constexpr double pi = 3.14159265358979323846;

Vec3d any_vector(test::Random& random, double size) {
    return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

Quaternion any_rotation(test::Random& random) {
    return {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(0.1, 1.0)};
}

/// Quaternion of a turn by `angle` about a unit axis.
Quaternion turn(const Vec3d& axis, double angle) {
    const double s = std::sin(angle / 2);
    return {s * axis.x, s * axis.y, s * axis.z, std::cos(angle / 2)};
}

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Transform, RotationTurnsRightHanded) {
    expect_near(rotation_matrix(turn({0, 0, 1}, pi / 2)) * Vec3d{1, 0, 0}, {0, 1, 0}, 1e-15);
    expect_near(rotation_matrix(turn({1, 0, 0}, pi / 2)) * Vec3d{0, 1, 0}, {0, 0, 1}, 1e-15);
    expect_near(rotation_matrix(turn({0, 1, 0}, pi / 2)) * Vec3d{0, 0, 1}, {1, 0, 0}, 1e-15);
}

TEST(Transform, RotationIsOrthogonalWhateverTheLengthOfTheQuaternion) {
    test::Random random(5);
    for (int i = 0; i < 1000; ++i) {
        const Matrix3 r = rotation_matrix(any_rotation(random));
        const Matrix3 product = r * transpose(r);
        expect_near(product.row[0], {1, 0, 0}, 4e-15);
        expect_near(product.row[1], {0, 1, 0}, 4e-15);
        expect_near(product.row[2], {0, 0, 1}, 4e-15);
        EXPECT_NEAR(determinant(r), 1, 4e-15);
    }
}

TEST(Transform, ComposeScalesThenTurnsThenMoves) {
    const Transform t = compose({10, 20, 30}, turn({0, 0, 1}, pi / 2), {2, 3, 4});
    expect_near(transform_point(t, {1, 0, 0}), {10, 22, 30}, 1e-14);
    expect_near(transform_point(t, {0, 1, 0}), {7, 20, 30}, 1e-14);
    expect_near(transform_point(t, {0, 0, 1}), {10, 20, 34}, 1e-14);
    expect_near(transform_vector(t, {1, 0, 0}), {0, 2, 0}, 1e-14);
}

TEST(Transform, ProductAppliesTheRightFactorFirst) {
    test::Random random(6);
    for (int i = 0; i < 1000; ++i) {
        const Transform a = compose(any_vector(random, 5), any_rotation(random), any_vector(random, 2));
        const Transform b = compose(any_vector(random, 5), any_rotation(random), any_vector(random, 2));
        const Vec3d p = any_vector(random, 3);
        expect_near(transform_point(a * b, p), transform_point(a, transform_point(b, p)), 1e-13);
    }
}

// Scales of the ratio 1e6, as of a flat body: the residual is relative to the condition.
TEST(Transform, InverseUndoes) {
    test::Random random(7);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d scale = {random.uniform(0.5, 2.0), random.uniform(0.5, 2.0), 1e-6};
        const Matrix3 m =
            compose({0, 0, 0}, any_rotation(random), scale).linear * rotation_matrix(any_rotation(random));
        const Vec3d v = any_vector(random, 1);
        expect_near(m * (inverse(m) * v), v, 1e-9);
    }
}

TEST(Transform, DeterminantOfAMirrorIsNegative) {
    EXPECT_LT(determinant(compose({0, 0, 0}, turn({0, 1, 0}, 0.3), {1, -1, 1}).linear), 0);
}

}  // namespace
}  // namespace tandem
