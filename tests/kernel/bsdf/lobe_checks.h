/// What the tests of lobes share: directions, charts of the sphere that are fine where a lobe is narrow, and integrals
/// over them.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "support/random.h"
#include "tandem/kernel/bsdf/lobes.h"

namespace tandem::test {

inline Vec3d direction(double cosine, double turns) {
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    return {sine * std::cos(2 * pi * turns), sine * std::sin(2 * pi * turns), cosine};
}

/// Of 24 bits, as the renderer's.
inline Vec3d random_numbers(Random& random) {
    const auto number = [&] { return random.below(1U << 24) * 0x1p-24; };
    return {number(), number(), number()};
}

/// From the unit square to directions and back, for a given wo. `solid_angle`: d omega / (ds dt); 0 where there is
/// none.
struct ChartPoint {
    Vec3d wi;
    double solid_angle;
};
struct Chart {
    std::function<ChartPoint(const Vec3d& wo, double s, double t)> to;
    std::function<Vec2<double>(const Vec3d& wo, const Vec3d& wi)> from;
};

/// Around the mirror direction; half of s is within the angle with 1 - cos = width, if width is small.
inline Chart polar_chart(double width) {
    const auto frame = [](const Vec3d& wo) { return frame_around(Vec3d{-wo.x, -wo.y, wo.z}); };
    return {[=](const Vec3d& wo, double s, double t) -> ChartPoint {
                const double rest = 2 + width - 2 * s;
                const double x = 2 * width * s / rest;  // 1 - cos
                const double sine = std::sqrt(x * (2 - x));
                return {from_frame(frame(wo), sine * std::cos(2 * pi * t), sine * std::sin(2 * pi * t), 1 - x),
                        2 * pi * 2 * width * (2 + width) / (rest * rest)};
            },
            [=](const Vec3d& wo, const Vec3d& wi) -> Vec2<double> {
                const Frame<double> axes = frame(wo);
                const Vec3d offset = wi - axes.normal;
                const double x = dot(offset, offset) / 2;
                const double turns = std::atan2(dot(wi, axes.bitangent), dot(wi, axes.tangent)) / (2 * pi);
                return {x * (2 + width) / (2 * (x + width)), turns < 0 ? turns + 1 : turns};
            }};
}

/// By the slopes of the microfacets, in units of the alphas. Fine where slopes are large, which are seen at grazing
/// angles: without the square the density of visible normals has a pole at s = 1.
inline Chart slope_chart(double alpha_x, double alpha_y) {
    return {[=](const Vec3d& wo, double s, double t) -> ChartPoint {
                const double rest = (1 - s) * (1 - s);
                const double radius = std::sqrt((1 - rest) / rest);
                const double x = radius * std::cos(2 * pi * t) * alpha_x;
                const double y = radius * std::sin(2 * pi * t) * alpha_y;
                const double z = 1 / std::sqrt(1 + x * x + y * y);
                const Vec3d h = {x * z, y * z, z};
                const double cosine = dot(wo, h);
                if (cosine <= 0) return {{0, 0, -1}, 0};
                const double of_h = 2 * pi * alpha_x * alpha_y * (1 - s) / (rest * rest) * (z * z * z);
                return {h * (2 * cosine) - wo, 4 * cosine * of_h};
            },
            [=](const Vec3d& wo, const Vec3d& wi) -> Vec2<double> {
                const Vec3d h = wo + wi;
                const double x = h.x / (h.z * alpha_x);
                const double y = h.y / (h.z * alpha_y);
                const double square = x * x + y * y;
                const double turns = std::atan2(y, x) / (2 * pi);
                return {1 - std::sqrt(1 / (1 + square)), turns < 0 ? turns + 1 : turns};
            }};
}

/// A lobe of any type and Real, behind functions of doubles.
struct AnyLobe {
    std::string name;
    Chart chart;
    double roundoff;  ///< of the Real
    bool is_reciprocal = true;
    double most_albedo = 1, most_weight = 1;  ///< LobeExamples
    std::function<Vec3d(const Vec3d&, const Vec3d&)> f;
    std::function<double(const Vec3d&, const Vec3d&)> pdf;
    std::function<LobeSample<double>(const Vec3d&, const Vec3d&)> sample;
    std::function<Vec3d(const Vec3d&)> albedo;
};

template <class Real, template <class> class L>
AnyLobe any_lobe(const std::string& name, const Chart& chart, const L<Real>& lobe, bool is_reciprocal = true,
                 double most_albedo = 1, double most_weight = 1) {
    static_assert(std::is_same_v<Double<Real>, double>);
    const auto doubles = [](const Vec3<Real>& v) { return Vec3d{v.x, v.y, v.z}; };
    return {name + (std::is_same_v<Real, float> ? ", strict" : ", precise"),
            chart,
            std::is_same_v<Real, float> ? 0x1p-24 : 0x1p-53,
            is_reciprocal,
            most_albedo,
            most_weight,
            [=](const Vec3d& wo, const Vec3d& wi) { return doubles(lobe.f(wo, wi)); },
            [=](const Vec3d& wo, const Vec3d& wi) { return lobe.pdf(wo, wi); },
            [=](const Vec3d& wo, const Vec3d& u) -> LobeSample<double> {
                const LobeSample<Real> s = lobe.sample(wo, u);
                return {s.wi, s.pdf, doubles(s.weight), s.valid, s.transmits};
            },
            [=](const Vec3d& wo) { return doubles(lobe.albedo(wo)); }};
}

/// Integral of a number or a vector over the part [s0, s1] x [t0, t1] of a chart, by a lattice of about that many
/// points.
template <class F>
auto integrate(const Chart& chart, const Vec3d& wo, double s0, double s1, double t0, double t1, int points, F f) {
    auto sum = f(wo) * 0.0;
    const double step = 0.6180339887498949;
    for (int i = 0; i < points; ++i) {
        const double place = i * step - std::floor(i * step);
        const ChartPoint at = chart.to(wo, s0 + (s1 - s0) * (i + 0.5) / points, t0 + (t1 - t0) * place);
        if (at.solid_angle > 0) sum += f(at.wi) * at.solid_angle;
    }
    return sum * ((s1 - s0) * (t1 - t0) / points);
}

}  // namespace tandem::test
