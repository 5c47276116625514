// The triangle light against closed forms: Girard's theorem, Lambert's formula, and areas of its parts.
#include "tandem/kernel/lights/triangle_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "kernel/lights/light_estimates.h"
#include "support/polygon_forms.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::below_one;
using test::Estimate;
using test::expect_mean;

/// Seen from the origin.
struct Case {
    std::string name;
    Vec3d v0, v1, v2;
};

const Case cases[] = {
    {"an octant", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {"ordinary", {1, 0, 2}, {-1, 1, 2.5}, {0, -1.5, 3}},
    {"mirrored", {0, -1.5, 3}, {-1, 1, 2.5}, {1, 0, 2}},
    {"small", {1, 0, 2}, {1.001, 0.0005, 2}, {1, 0.001, 2.0003}},
    {"tiny and far", {600, 0, 800}, {600.000001, 0, 800}, {600, 0.000001, 800}},
    {"huge and near", {-1e6, -1e6, 1e-3}, {1e6, -1e6, 1e-3}, {0, 1e6, 1e-3}},
    {"near the plane, beside it", {1, 0, 1e-6}, {2, 1, 1e-6}, {2, -1, 1e-6}},
    {"near an edge", {-1, 0, 1e-5}, {1, 0, 1e-5}, {0, 1, 0.5}},
    {"nearer to an edge", {-1, 0, 1e-9}, {1, 0, 1e-9}, {0, 1, 0.5}},
    {"near a corner", {1e-5, 0, 2e-5}, {1, 1, 1}, {1, -1, 1}},
    {"a needle", {0, 0, 1}, {1, 0, 1}, {0.5, 1e-7, 1}},
};

const Vec3d origin = {0, 0, 0};
TriangleLightView<float> view_of(const Case& c) { return view_triangle_light<float>(origin, c.v0, c.v1, c.v2); }

TEST(TriangleLight, TheSolidAngleIsGirards) {
    EXPECT_NEAR(view_of(cases[0]).solid_angle, pi / 2, 1e-15);
    for (const Case& c : cases) {
        const double exact = test::girard(origin, c.v0, c.v1, c.v2);
        EXPECT_NEAR(view_of(c).solid_angle / exact, 1, 1e-9) << c.name;
    }
    for (std::uint64_t number = 0; number < 500; ++number) {
        test::Random random(number);
        const double spread = std::abs(static_cast<double>(random.log_uniform(-30, 1)));
        const auto any = [&](double size) {
            return Vec3d{random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
        };
        const Vec3d centre = any(1), v0 = centre + any(spread), v1 = centre + any(spread), v2 = centre + any(spread);
        const TriangleLightView<float> view = view_triangle_light<float>(origin, v0, v1, v2);
        const Vec3d normal = normalize(cross(v1 - v0, v2 - v0));
        const double sine = std::abs(dot(normal, normalize(v0)));
        if (sine < 1e-3) continue;
        const double exact = test::girard(origin, v0, v1, v2);
        ASSERT_NEAR(view.solid_angle / exact, 1, 0x1p-46 / sine) << "case " << number;
    }
}

TEST(TriangleLight, SamplesLieOnTheTriangleAndTheLine) {
    for (const Case& c : cases) {
        const TriangleLightView<float> view = view_of(c);
        const Vec3d normal = cross(c.v1 - c.v0, c.v2 - c.v0);
        const double area = std::sqrt(dot(normal, normal));
        test::Random random(1);
        for (int i = 0; i < 20'000; ++i) {
            const double u = i % 100 == 0 ? 0 : i % 100 == 1 ? below_one : random.uniform(0.0, 1.0);
            const double v = i % 100 == 2 ? 0 : i % 100 == 3 ? below_one : random.uniform(0.0, 1.0);
            const LightSample<float> s = sample_light(view, u, v);
            const std::string name = c.name + ", sample " + std::to_string(i);
            ASSERT_NEAR(dot(s.direction, s.direction), 1, 1e-14) << name;
            const Vec3d off = s.direction * s.distance - s.point;
            ASSERT_LE(std::sqrt(dot(off, off)), 1e-15 * view.unit) << name;
            const double size = std::sqrt(area);
            ASSERT_LE(std::abs(dot(s.point - c.v0, normal)) / area, 1e-14 * view.unit) << name;
            const Vec3d corner[] = {c.v0, c.v1, c.v2};
            for (int k = 0; k < 3; ++k) {
                const Vec3d edge = corner[(k + 1) % 3] - corner[k];
                const double inside =
                    dot(cross(edge, s.point - corner[k]), normal) / (area * std::sqrt(dot(edge, edge)));
                ASSERT_GE(inside, -1e-14 * (view.unit + size)) << name << ", edge " << k;
            }
            ASSERT_EQ(s.pdf, 1 / view.solid_angle) << name;
            ASSERT_EQ(pdf_of(view, s.direction), s.pdf) << name;
        }
    }
}

/// The four triangles between the middles of the sides are met as often as their solid angles say.
TEST(TriangleLight, DirectionsAreUniform) {
    for (const Case& c : cases) {
        const TriangleLightView<float> view = view_of(c);
        const Vec3d m01 = (c.v0 + c.v1) * 0.5, m12 = (c.v1 + c.v2) * 0.5, m20 = (c.v2 + c.v0) * 0.5;
        const Case parts[] = {
            {"at v0", c.v0, m01, m20}, {"at v1", c.v1, m12, m01}, {"at v2", c.v2, m20, m12}, {"middle", m01, m12, m20}};
        for (const Case& part : parts) {
            const TriangleLightView<float> of_part = view_of(part);
            test::Random random(3);
            Estimate met;
            for (int i = 0; i < 100'000; ++i) {
                const auto s = sample_light(view, random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
                met.add(pdf_of(of_part, s.direction) > 0 ? 1 : 0);
            }
            const double share = test::girard(origin, part.v0, part.v1, part.v2) / view.solid_angle;
            EXPECT_NEAR(met.mean(), share, 4.5 * met.standard_error() + 1e-4) << c.name << ", " << part.name;
        }
    }
}

TEST(TriangleLight, TheIrradianceIsLamberts) {
    const Vec3d normal = {0, 0, 1};
    for (const Case& c : cases) {
        const TriangleLightView<float> view = view_of(c);
        const Estimate irradiance = test::irradiance(view, 4);
        const double exact = test::lambert(origin, normal, {c.v0, c.v1, c.v2});
        EXPECT_NEAR(irradiance.mean(), exact, 4.5 * irradiance.standard_error() + 1e-9 * exact) << c.name;
    }
}

TEST(TriangleLight, TheDensityIntegratesToOne) {
    for (const int k : {0, 1, 2, 5, 7}) {
        const TriangleLightView<float> view = view_of(cases[k]);
        expect_mean(test::whole_density(view, 6), 1, cases[k].name);
    }
}

/// Below smallest_spherical the area is sampled; the density stays that of the solid angle.
TEST(TriangleLight, TheSmallestAreSampledByArea) {
    const TriangleLightView<float> view = view_of({"", {1, 0, 2}, {1, 0x1p-104, 2}, {1, 0, 2 + 0x1p-51}});
    ASSERT_GT(view.solid_angle, triangle_light_detail::smallest_spherical<float>);
    const TriangleLightView<float> by_area = view_of({"", {1, 0, 2}, {1, 0x1p-160, 2}, {1, 0, 2 + 0x1p-51}});
    ASSERT_GT(by_area.solid_angle, 0);
    ASSERT_LT(by_area.solid_angle, triangle_light_detail::smallest_spherical<float>);
    for (const auto& v : {view, by_area}) {
        const LightSample<float> s = sample_light(v, 0.3, 0.4);
        EXPECT_NEAR(s.pdf * v.solid_angle, 1, 1e-9);
        EXPECT_NEAR(pdf_of(v, s.direction) / s.pdf, 1, 1e-9);
        EXPECT_NEAR(s.distance, std::sqrt(5), 1e-14);
    }
}

TEST(TriangleLight, SeenEdgeOnItHasNoSamples) {
    const double nan = std::nan("");
    const Case degenerate[] = {
        {"in the plane, beside it", {1, 0, 0}, {2, 1, 0}, {2, -1, 0}},
        {"on it", {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}},
        {"on a corner", {0, 0, 0}, {-1, 1, 1}, {-1, -1, 2}},
        {"on an edge", {-1, -1, -1}, {1, 1, 1}, {3, 0, 0}},
        {"no area", {1, 0, 1}, {1, 0, 1}, {2, 0, 1}},
        {"on a line", {1, 0, 1}, {2, 0, 2}, {3, 0, 3}},
        {"a point", {1, 0, 1}, {1, 0, 1}, {1, 0, 1}},
        {"nothing", {0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
        {"less than rounding from the plane", {1, 0, 1e-15}, {-1, 1, 1e-15}, {-1, -1, 1e-15}},
        {"not a number", {nan, 0, 1}, {1, 1, 1}, {-1, -1, 1}},
    };
    for (const Case& c : degenerate) {
        const TriangleLightView<float> view = view_of(c);
        EXPECT_EQ(view.solid_angle, 0) << c.name;
        for (const double u : {0.0, 0.3, below_one}) {
            for (const double v : {0.0, 0.6, below_one}) {
                const LightSample<float> s = sample_light(view, u, v);
                EXPECT_EQ(s.pdf, 0) << c.name;
                if (c.name == "not a number") continue;
                EXPECT_FALSE(std::isnan(s.direction.x + s.direction.y + s.direction.z + s.distance)) << c.name;
            }
        }
        for (const Vec3d& d : {Vec3d{0, 0, 1}, Vec3d{1, 0, 0}, Vec3d{0, 0, -1}})
            EXPECT_EQ(pdf_of(view, d), 0) << c.name;
    }
}

TEST(TriangleLight, InTheTierFastItStaysFinite) {
    for (const Case& c : cases) {
        const auto view = view_triangle_light<FastFloat>({0, 0, 0}, Vec3<FastFloat>(c.v0), Vec3<FastFloat>(c.v1),
                                                         Vec3<FastFloat>(c.v2));
        if (to_wide(view.solid_angle) == 0) continue;
        EXPECT_NEAR(to_wide(view.solid_angle) / view_of(c).solid_angle, 1, 1e-2) << c.name;
        test::Random random(1);
        int refused = 0;
        for (int i = 0; i < 10'000; ++i) {
            const auto s = sample_light(view, FastFloat(random.uniform(0.0, 1.0)), FastFloat(random.uniform(0.0, 1.0)));
            ASSERT_NEAR(to_wide(dot(s.direction, s.direction)), 1, 1e-5) << c.name << ", sample " << i;
            ASSERT_GT(to_wide(s.pdf), 0) << c.name;
            refused += to_wide(pdf_of(view, s.direction)) == 0 ? 1 : 0;
        }
        EXPECT_LT(refused, 10) << c.name;
    }
}

}  // namespace
}  // namespace tandem
