// Moments of the maps against closed forms, and their corners.
#include "tandem/kernel/sampler/warp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/estimate.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::Estimate;
using test::expect_mean;

constexpr int samples = 200'000;
constexpr double largest = 1 - 0x1p-53;
constexpr double ends[] = {0.0, 0x1p-53, 0x1p-24, 0.25, 0.5, 0.5 + 0x1p-53, 1 - 0x1p-24, largest};

TEST(Warp, TheDiskIsUniform) {
    test::Random random(1);
    Estimate x, y, x2, xy, r2, r4, inner;
    for (int i = 0; i < samples; ++i) {
        const Vec2<double> p = sample_disk<float>(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
        const double square = p.x * p.x + p.y * p.y;
        ASSERT_LE(square, 1 + 0x1p-51) << "sample " << i;
        x.add(p.x), y.add(p.y), x2.add(p.x * p.x), xy.add(p.x * p.y), r2.add(square), r4.add(square * square);
        inner.add(square < 0.25 && p.y > std::abs(p.x) ? 1 : 0);
    }
    expect_mean(x, 0, "x");
    expect_mean(y, 0, "y");
    expect_mean(x2, 0.25, "x^2");
    expect_mean(xy, 0, "xy");
    expect_mean(r2, 0.5, "r^2");
    expect_mean(r4, 1.0 / 3, "r^4");
    expect_mean(inner, 1.0 / 16, "a quarter of the inner disk");
}

TEST(Warp, TheDiskMapsSquaresToCircles) {
    const Vec2<double> centre = sample_disk<float>(0.5, 0.5);
    EXPECT_EQ(centre.x, 0);
    EXPECT_EQ(centre.y, 0);
    const Vec2<double> right = sample_disk<float>(0.75, 0.5);
    EXPECT_EQ(right.x, 0.5);
    EXPECT_EQ(right.y, 0);
    const Vec2<double> below = sample_disk<float>(0.5, 0.0);
    EXPECT_EQ(below.x, 0);
    EXPECT_EQ(below.y, -1);
    const Vec2<double> corner = sample_disk<float>(0.0, 0.0);
    EXPECT_NEAR(corner.x, -std::sqrt(0.5), 1e-15);
    EXPECT_NEAR(corner.y, -std::sqrt(0.5), 1e-15);
    // along a square around the centre the angle grows with the way
    for (const double t : {0.6, 0.7, 0.74}) {
        const Vec2<double> p = sample_disk<float>(0.75, t);
        EXPECT_NEAR(std::hypot(p.x, p.y), 0.5, 1e-15);
        EXPECT_NEAR(std::atan2(p.y, p.x), pi / 4 * (t - 0.5) / 0.25, 1e-15);
    }
}

TEST(Warp, ThePolygonIsUniformAndHasItsCornersOnTheCircle) {
    for (const int sides : {3, 4, 5, 6, 9}) {
        const double rotation = 0.1;
        test::Random random(static_cast<std::uint64_t>(sides));
        Estimate x, y, r2, first;
        const double inner = std::cos(pi / sides);  // distance of the sides
        double farthest = 0;
        for (int i = 0; i < samples; ++i) {
            const Vec2<double> p =
                sample_aperture<float>(sides, rotation, random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
            for (int k = 0; k < sides; ++k) {
                const double angle = 2 * pi * (rotation + (k + 0.5) / sides);
                ASSERT_LE(p.x * std::cos(angle) + p.y * std::sin(angle), inner + 1e-15) << sides << ", sample " << i;
            }
            x.add(p.x), y.add(p.y), r2.add(p.x * p.x + p.y * p.y);
            const double turns = atan2_turns<double>(p.y, p.x) - rotation;
            first.add(turns >= 0 && turns < 1.0 / sides ? 1 : 0);
            farthest = std::max(farthest, std::hypot(p.x, p.y));
        }
        const std::string name = std::to_string(sides) + " sides";
        expect_mean(x, 0, name);
        expect_mean(y, 0, name);
        // polar moment of a triangle about its apex: h^2 / 2 + w^2 / 6 with height h and half width w
        expect_mean(r2, inner * inner / 2 + std::pow(std::sin(pi / sides), 2) / 6, name);
        expect_mean(first, 1.0 / sides, name);
        EXPECT_GT(farthest, 0.97) << name;
    }
    const Vec2<double> corner = sample_regular_polygon<float>(6, 0.0, largest / 6, 0.0);
    EXPECT_NEAR(corner.x, 1, 1e-15);
    EXPECT_NEAR(corner.y, 0, 1e-15);
}

TEST(Warp, NoBladesAreADisk) {
    const Vec2<double> a = sample_aperture<float>(0, 0.3, 0.2, 0.9);
    const Vec2<double> b = sample_disk<float>(0.2, 0.9);
    EXPECT_EQ(a.x, b.x);
    EXPECT_EQ(a.y, b.y);
}

TEST(Warp, TheHemisphereHasTheCosineAsItsDensity) {
    for (const Vec3d& axis : {Vec3d{0, 0, 1}, Vec3d{0, 0, -1}, Vec3d{0.3, -0.8, 0.1}, Vec3d{1e-9, 0, -1}}) {
        const Vec3d normal = normalize(axis);
        test::Random random(7);
        Estimate whole, cosine, cosine2, aside;
        for (int i = 0; i < samples; ++i) {
            const auto [direction, pdf] =
                sample_cosine_hemisphere<float>(normal, random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
            const double c = dot(direction, normal);
            ASSERT_GT(pdf, 0) << "sample " << i;
            ASSERT_NEAR(pdf * pi, c, 1e-15) << "sample " << i;
            ASSERT_NEAR(dot(direction, direction), 1, 4e-15) << "sample " << i;
            whole.add(std::sqrt(c) / pdf);  // 1 / pdf itself has no variance
            cosine.add(c), cosine2.add(c * c), aside.add(dot(direction, frame_around(normal).tangent));
        }
        expect_mean(whole, 2 * pi / 1.5, "integral of sqrt(cos)");
        expect_mean(cosine, 2.0 / 3, "cos");
        expect_mean(cosine2, 0.5, "cos^2");
        expect_mean(aside, 0, "tangent");
    }
}

TEST(Warp, TheSphereIsUniform) {
    test::Random random(3);
    Estimate x, y, z, x2, y2, z2, xy;
    for (int i = 0; i < samples; ++i) {
        const auto [d, pdf] = sample_sphere<float>(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
        ASSERT_NEAR(dot(d, d), 1, 2e-15) << "sample " << i;
        ASSERT_EQ(pdf, 1 / (4 * pi));
        x.add(d.x), y.add(d.y), z.add(d.z), x2.add(d.x * d.x), y2.add(d.y * d.y), z2.add(d.z * d.z), xy.add(d.x * d.y);
    }
    for (const Estimate& mean : {x, y, z, xy}) expect_mean(mean, 0, "odd");
    for (const Estimate& mean : {x2, y2, z2}) expect_mean(mean, 1.0 / 3, "squares");
}

TEST(Warp, NoCornerOfTheSquareGivesNan) {
    const Vec3d normal = normalize(Vec3d{1, 2, 3});
    for (const double u : ends) {
        for (const double v : ends) {
            const Vec2<double> disk = sample_disk<float>(u, v);
            EXPECT_LE(std::hypot(disk.x, disk.y), 1 + 0x1p-51) << u << " " << v;
            const Vec2<double> triangle = sample_aperture<float>(3, 0.0, u, v);
            EXPECT_LE(std::hypot(triangle.x, triangle.y), 1 + 0x1p-51) << u << " " << v;
            const auto up = sample_cosine_hemisphere<float>(normal, u, v);
            EXPECT_GT(up.pdf, 0) << u << " " << v;
            EXPECT_GE(dot(up.direction, normal), 0) << u << " " << v;
            EXPECT_NEAR(dot(up.direction, up.direction), 1, 4e-15) << u << " " << v;
            const auto any = sample_sphere<float>(u, v);
            EXPECT_NEAR(dot(any.direction, any.direction), 1, 2e-15) << u << " " << v;
            const auto fast = sample_cosine_hemisphere<FastFloat>({0, 0, -1}, u, v);
            EXPECT_GT(to_wide(fast.pdf), 0) << u << " " << v;
        }
    }
}

TEST(Warp, TheTierFastComesClose) {
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        test::Random random(number);
        const float u = random.uniform(0.0F, 0.9999F), v = random.uniform(0.0F, 0.9999F);
        const Vec2<double> exact = sample_disk<float>(static_cast<double>(u), static_cast<double>(v));
        const Vec2<FastFloat> fast = sample_disk<FastFloat>(u, v);
        ASSERT_NEAR(to_wide(fast.x), exact.x, 0x1p-21) << "case " << number;
        ASSERT_NEAR(to_wide(fast.y), exact.y, 0x1p-21) << "case " << number;
        const Vec2<double> exact5 = sample_aperture<float>(5, 0.0, static_cast<double>(u), static_cast<double>(v));
        const Vec2<FastFloat> fast5 = sample_aperture<FastFloat>(5, 0.0, u, v);
        ASSERT_NEAR(std::hypot(to_wide(fast5.x) - exact5.x, to_wide(fast5.y) - exact5.y), 0, 2e-3) << "case " << number;
    }
}

}  // namespace
}  // namespace tandem
