// The sphere light against closed forms: its solid angle, and the irradiance under it.
#include "tandem/kernel/lights/sphere_light.h"

#include <gtest/gtest.h>

#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <string>

#include "kernel/lights/light_estimates.h"
#include "support/exact_geometry.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::below_one;
using test::Big;
using test::Estimate;
using test::expect_mean;

struct Case {
    std::string name;
    Vec3d point, centre;
    double radius;
};

const Case cases[] = {
    {"ordinary", {0, 0, 0}, {1, 2, 3}, 1.5},
    {"nearly touching", {0, 0, 0}, {0, 0, -1}, 1 - 1e-9},
    {"touching", {0, 0, 0}, {0, 0, -1}, 1},
    {"tiny and far", {0, 0, 0}, {600, 0, 800}, 1e-6},
    {"huge and near", {0, 0, 1e-3}, {0, 0, -1e6}, 1e6},
    {"from inside", {0.5, 0.25, 0}, {0, 0, 1}, 1.5},
    {"from its centre", {3, 4, 5}, {3, 4, 5}, 2},
    {"from next to its centre", {3, 4, 5}, {3, 4 + 1e-15, 5}, 2},
    {"from inside, next to the surface", {0, 0, 0}, {0, 0, 1}, 1 + 1e-12},
};

SphereLightView<float> view_of(const Case& c) { return view_sphere_light<float>(c.point, c.centre, c.radius); }

TEST(SphereLight, TheSolidAngleIsThatOfTheCone) {
    const Big two_pi = 2 * boost::math::constants::pi<Big>();
    for (std::uint64_t number = 0; number < 2'000; ++number) {
        test::Random random(number);
        const auto any = [&] { return random.uniform(-1.0, 1.0); };
        const Vec3d centre = {any(), any(), any()};
        const double distance = std::sqrt(dot(centre, centre));
        const double ratio = std::abs(static_cast<double>(random.log_uniform(-60, 0)));
        const double radius = distance * ratio;
        if (ratio > 0.99) continue;
        const Big sine2 = Big(radius) * Big(radius) / test::dot(test::big(centre), test::big(centre));
        const Big exact = two_pi * (1 - sqrt(1 - sine2));
        const double found = view_sphere_light<float>({0, 0, 0}, centre, radius).solid_angle;
        ASSERT_NEAR(static_cast<double>(Big(Big(found) / exact)), 1, 1e-14 / (1 - ratio)) << "case " << number;
    }
    EXPECT_EQ(view_of(cases[5]).solid_angle, 4 * pi) << "from inside";
}

TEST(SphereLight, SamplesLieOnTheSphereAndTheLine) {
    for (const Case& c : cases) {
        const SphereLightView<float> view = view_of(c);
        test::Random random(1);
        for (int i = 0; i < 20'000; ++i) {
            const double u = i == 0 ? 0 : i == 1 ? below_one : random.uniform(0.0, 1.0);
            const double v = random.uniform(0.0, 1.0);
            const LightSample<float> s = sample_light(view, u, v);
            const std::string name = c.name + ", sample " + std::to_string(i);
            ASSERT_NEAR(dot(s.direction, s.direction), 1, 1e-14) << name;
            const Vec3d from_centre = s.point - c.centre;
            const double size = c.radius + std::sqrt(dot(c.centre, c.centre)) * 1e-3;  // rounding of the coordinates
            ASSERT_NEAR(std::sqrt(dot(from_centre, from_centre)), c.radius, 1e-14 * c.radius + 1e-13 * size) << name;
            const Vec3d off = c.point + s.direction * s.distance - s.point;
            const double far = c.radius + view.distance;
            // a grazing line meets the sphere within sqrt(2^-53) of a radius
            ASSERT_LE(std::sqrt(dot(off, off)), 4e-8 * c.radius + 1e-14 * far) << name;
            ASSERT_GE(s.distance, 0) << name;
            ASSERT_EQ(s.pdf, 1 / view.solid_angle) << name;
            ASSERT_EQ(pdf_of(view, s.direction), s.pdf) << name;
        }
    }
}

TEST(SphereLight, DirectionsBesideItHaveNoDensity) {
    for (const Case& c : cases) {
        const SphereLightView<float> view = view_of(c);
        if (view.inside) continue;
        const double sine = c.radius / view.distance;
        const Frame<double> frame = frame_around(view.axis);
        for (const double beside : {1 + 1e-6 / sine * 1e-6, 1 + 1e-3, 2.0}) {
            if (sine * beside >= 1) continue;
            const Vec3d d =
                frame.tangent * (sine * beside) + view.axis * std::sqrt((1 - sine * beside) * (1 + sine * beside));
            EXPECT_EQ(pdf_of(view, d), 0) << c.name << ", " << beside;
        }
        EXPECT_EQ(pdf_of(view, -view.axis), 0) << c.name;
        EXPECT_EQ(pdf_of(view, view.axis), 1 / view.solid_angle) << c.name;
    }
}

/// With the sphere above the horizon E = pi L (r / d)^2 cos.
TEST(SphereLight, TheIrradianceIsTheClosedForm) {
    const struct {
        Vec3d centre;
        double radius;
    } lights[] = {{{0, 0, 2}, 1}, {{3, 0, 4}, 2.5}, {{300, -200, 900}, 1e-6}, {{0, 0, 1}, 0.999}};
    for (const auto& [centre, radius] : lights) {
        const SphereLightView<float> view = view_sphere_light<float>({0, 0, 0}, centre, radius);
        const Estimate irradiance = test::irradiance(view, 5);
        const double distance2 = dot(centre, centre);
        const double exact = pi * radius * radius / distance2 * centre.z / std::sqrt(distance2);
        expect_mean(irradiance, exact, "radius " + std::to_string(radius));
    }
}

/// The share of all directions that its density calls those of the light is its solid angle.
TEST(SphereLight, TheDensityIntegratesToOne) {
    for (const Case& c : cases) {
        const SphereLightView<float> view = view_of(c);
        if (view.solid_angle < 1e-2) continue;
        expect_mean(test::whole_density(view, 6), 1, c.name);
    }
}

TEST(SphereLight, FromInsideAllDirectionsAreAlike) {
    const SphereLightView<float> view = view_of(cases[5]);
    test::Random random(2);
    Estimate x, y, z, z2;
    for (int i = 0; i < 200'000; ++i) {
        const Vec3d d = sample_light(view, random.uniform(0.0, 1.0), random.uniform(0.0, 1.0)).direction;
        x.add(d.x), y.add(d.y), z.add(d.z), z2.add(d.z * d.z);
    }
    expect_mean(x, 0, "x");
    expect_mean(y, 0, "y");
    expect_mean(z, 0, "z");
    expect_mean(z2, 1.0 / 3, "z^2");
}

TEST(SphereLight, WithoutARadiusNothingIsSeen) {
    for (const Vec3d& point : {Vec3d{0, 0, 0}, Vec3d{1, 2, 3}}) {
        const SphereLightView<float> view = view_sphere_light<float>(point, {1, 2, 3}, 0);
        const LightSample<float> s = sample_light(view, 0.3, 0.6);
        EXPECT_EQ(s.pdf, 0);
        EXPECT_EQ(pdf_of(view, {0, 0, 1}), 0);
        EXPECT_FALSE(std::isnan(s.direction.x + s.point.x + s.distance));
    }
}

TEST(SphereLight, InTheTierFastItStaysFinite) {
    for (const Case& c : cases) {
        const auto view = view_sphere_light<FastFloat>(Vec3<FastFloat>(c.point), Vec3<FastFloat>(c.centre), c.radius);
        test::Random random(1);
        for (int i = 0; i < 10'000; ++i) {
            const auto s = sample_light(view, FastFloat(random.uniform(0.0, 1.0)), FastFloat(random.uniform(0.0, 1.0)));
            ASSERT_NEAR(to_wide(dot(s.direction, s.direction)), 1, 1e-5) << c.name << ", sample " << i;
            ASSERT_GT(to_wide(s.pdf), 0) << c.name;
            ASSERT_EQ(to_wide(pdf_of(view, s.direction)), to_wide(s.pdf)) << c.name << ", sample " << i;
            ASSERT_GE(to_wide(s.distance), 0) << c.name << ", sample " << i;
        }
    }
}

}  // namespace
}  // namespace tandem
