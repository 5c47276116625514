// The quad light: the solid angle and the form factor of rectangles in closed form, and quads of any shape.
#include "tandem/kernel/lights/quad_light.h"

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

const Vec3d origin = {0, 0, 0};

/// Seen from the origin.
struct Case {
    std::string name;
    Vec3d v0, v1, v2, v3;
};

const Case cases[] = {
    {"a face of a cube", {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}},
    {"a trapezium", {-1, 0, 2}, {3, 0, 2}, {1, 1, 2.5}, {0, 1, 2.5}},
    {"a dart", {0, 0, 1}, {2, 0.1, 1.2}, {0.5, 0.5, 1.1}, {0.1, 2, 1.2}},
    {"folded", {-1, -1, 1}, {1, -1, 1.5}, {1, 1, 1}, {-1, 1, 2}},
    {"tiny and far", {600, 0, 800}, {600.000001, 0, 800}, {600.000001, 0.000001, 800}, {600, 0.000001, 800}},
    {"huge and near", {-1e6, -1e6, 1e-3}, {1e6, -1e6, 1e-3}, {1e6, 1e6, 1e-3}, {-1e6, 1e6, 1e-3}},
    {"one half edge on", {1, 0, 1}, {1, 0, 3}, {-1, 0, 2}, {0, 1, 2}},
};

QuadLightView<float> view_of(const Case& c) { return view_quad_light<float>(origin, c.v0, c.v1, c.v2, c.v3); }

TEST(QuadLight, TheSolidAngleOfARectangle) {
    EXPECT_NEAR(view_of(cases[0]).solid_angle, 4 * pi / 6, 1e-15);
    // over the middle of a rectangle 2a by 2b at distance d: 4 asin(ab / sqrt((a^2 + d^2) (b^2 + d^2)))
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        test::Random random(number);
        const double a = std::exp2(random.uniform(-10.0, 4.0));
        const double b = std::exp2(random.uniform(-10.0, 4.0));
        const double d = std::exp2(random.uniform(-4.0, 4.0));
        const auto view = view_quad_light<float>({3, 4, 5}, {3 - a, 4 - b, 5 + d}, {3 + a, 4 - b, 5 + d},
                                                 {3 + a, 4 + b, 5 + d}, {3 - a, 4 + b, 5 + d});
        const double exact = 4 * std::asin(a * b / std::sqrt((a * a + d * d) * (b * b + d * d)));
        ASSERT_NEAR(view.solid_angle / exact, 1, 1e-11) << "case " << number;
    }
}

/// E. M. Sparrow, R. D. Cess, "Radiation Heat Transfer", 1966: the form factor from a point to a rectangle parallel to
/// its surface, one corner over the point: with A = a / d and B = b / d it is
/// (A / sqrt(1 + A^2) atan(B / sqrt(1 + A^2)) + B / sqrt(1 + B^2) atan(A / sqrt(1 + B^2))) / (2 pi).
TEST(QuadLight, TheFormFactorOfARectangle) {
    for (const auto& [a, b, d] : {std::tuple(1.0, 2.0, 1.0), {0.01, 0.3, 2.0}, {50.0, 40.0, 1.0}}) {
        const auto view = view_quad_light<float>(origin, {0, 0, d}, {a, 0, d}, {a, b, d}, {0, b, d});
        test::Random random(1);
        Estimate factor;
        for (int i = 0; i < 200'000; ++i) {
            const auto s = sample_light(view, random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
            factor.add(s.direction.z / pi / s.pdf);
        }
        const double A = a / d, B = b / d, p = std::sqrt(1 + A * A), q = std::sqrt(1 + B * B);
        expect_mean(factor, (A / p * std::atan(B / p) + B / q * std::atan(A / q)) / (2 * pi), std::to_string(a));
    }
}

TEST(QuadLight, TheIrradianceIsLamberts) {
    for (const Case& c : cases) {
        const QuadLightView<float> view = view_of(c);
        const Estimate irradiance = test::irradiance(view, 2);
        const double exact = (view.first.solid_angle > 0 ? test::lambert(origin, {0, 0, 1}, {c.v0, c.v1, c.v2}) : 0) +
                             test::lambert(origin, {0, 0, 1}, {c.v0, c.v2, c.v3});
        EXPECT_NEAR(irradiance.mean(), exact, 4.5 * irradiance.standard_error() + 1e-9 * exact) << c.name;
    }
}

TEST(QuadLight, SamplesHaveTheDensityOfTheirDirection) {
    for (const Case& c : cases) {
        const QuadLightView<float> view = view_of(c);
        test::Random random(3);
        for (int i = 0; i < 20'000; ++i) {
            const double u = i % 100 == 0 ? 0 : i % 100 == 1 ? below_one : random.uniform(0.0, 1.0);
            const double v = i % 100 == 2 ? 0 : i % 100 == 3 ? below_one : random.uniform(0.0, 1.0);
            const LightSample<float> s = sample_light(view, u, v);
            ASSERT_NEAR(s.pdf * view.solid_angle, 1, 1e-15) << c.name << ", sample " << i;
            ASSERT_NEAR(pdf_of(view, s.direction) * view.solid_angle, 1, 1e-15) << c.name << ", sample " << i;
            const Vec3d off = s.direction * s.distance - s.point;
            ASSERT_LE(std::sqrt(dot(off, off)), 1e-15 * view.second.unit) << c.name << ", sample " << i;
        }
    }
}

TEST(QuadLight, TheDensityIntegratesToOne) {
    for (const int k : {0, 1, 2, 5}) {
        const QuadLightView<float> view = view_of(cases[k]);
        expect_mean(test::whole_density(view, 6), 1, cases[k].name);
    }
}

TEST(QuadLight, EachHalfShinesFromItsOwnFront) {
    const Vec3d v0 = {-1, 0, 2}, v2 = {1, 0, 2}, up = {0, 1, 2.5}, down = {0, -1, 2.5}, aside = {0, 3, 2.2};
    int one_half = 0;
    for (const auto& [v1, v3] : {std::pair{up, down}, {down, up}, {up, aside}, {aside, up}, {down, aside}}) {
        const auto view =
            view_quad_light<float>(origin, v0, v1, v2, v3, quad_light_shape<float>(FaceSides::single_sided, true));
        const auto is_front = [](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
            return dot(cross(b - a, c - a), origin - a) > 0;
        };
        const bool first = is_front(v0, v1, v2), second = is_front(v0, v2, v3);
        EXPECT_EQ(view.first.solid_angle > 0, first);
        EXPECT_EQ(view.second.solid_angle > 0, second);
        const auto both =
            view_quad_light<float>(origin, v0, v1, v2, v3, quad_light_shape<float>(FaceSides::double_sided, true));
        EXPECT_GT(both.first.solid_angle * both.second.solid_angle, 0);
        if (!first && !second) continue;
        one_half += first != second;
        test::Random random(4);
        for (int i = 0; i < 1000; ++i) {
            const auto s = sample_light(view, random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
            ASSERT_TRUE(s.in_second_half ? second : first);
        }
    }
    EXPECT_GT(one_half, 0);
}

// One half before a part of the other: what is drawn there is not seen, and what is seen is drawn with the whole
// density.
TEST(QuadLight, AHalfHidesTheOther) {
    const Vec3d v0 = {-1, 0, 2}, v1 = {0, 1, 2}, v2 = {1, 0, 2}, v3 = {0, 0.8, 1.2};
    for (const FaceSides sides : {FaceSides::double_sided, FaceSides::culled}) {
        const auto view = view_quad_light<float>(origin, v0, v1, v2, v3, quad_light_shape<float>(sides, true));
        const bool is_there = sides == FaceSides::double_sided || view.second.shows_front;
        test::Random random(5);
        int hidden = 0;
        for (int i = 0; i < 20'000; ++i) {
            const auto s = sample_light(view, random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
            const bool before = find_on_light(view.second, s.direction, 1e-12).meets;
            if (s.in_second_half || !before || !is_there) {
                ASSERT_NEAR(s.pdf * view.solid_angle, 1, 1e-14);
                ASSERT_NEAR(pdf_of(view, s.direction) * view.solid_angle, 1, 1e-14);
            } else {
                ASSERT_EQ(s.pdf, 0);
                ++hidden;
            }
        }
        EXPECT_EQ(hidden > 1000, is_there);
    }
}

TEST(QuadLight, SeenEdgeOnItHasNoSamples) {
    const Case degenerate[] = {
        {"in its plane", {1, -1, 0}, {2, -1, 0}, {2, 1, 0}, {1, 1, 0}},
        {"on it", {-1, -1, 0}, {1, -1, 0}, {1, 2, 0}, {-1, 2, 0}},
        {"a point", {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}},
    };
    for (const Case& c : degenerate) {
        const QuadLightView<float> view = view_of(c);
        EXPECT_EQ(view.solid_angle, 0) << c.name;
        for (const double u : {0.0, 0.4, below_one}) {
            const LightSample<float> s = sample_light(view, u, 0.7);
            EXPECT_EQ(s.pdf, 0) << c.name;
            EXPECT_FALSE(std::isnan(s.direction.x + s.direction.y + s.direction.z + s.distance)) << c.name;
            EXPECT_EQ(pdf_of(view, normalize(Vec3d{u, 1, 0.1})), 0) << c.name;
        }
    }
}

}  // namespace
}  // namespace tandem
