/// Triangles and rays that are hard for intersection tests, by kind, as in adversarial_rays.h.
#pragma once

#include "support/adversarial_rays.h"
#include "tandem/kernel/shapes/quad.h"

namespace tandem::test {

struct TriangleCase {
    Triangle triangle;
    Ray<float> ray;
};

inline constexpr const char* triangle_kinds[] = {"anywhere",       "edges, exact",   "vertices, exact",
                                                 "edges, close",   "grazing",        "needle",
                                                 "ground",         "just above",     "tiny",
                                                 "far away",       "degenerate",     "almost degenerate",
                                                 "in the plane",   "any magnitudes", "edges, by the last bits",
                                                 "mixed exponents"};

/// A point on the triangle, on one of its edges, or around it.
inline Vec3d point_of(Random& random, const Triangle& triangle, double overshoot = 0.2) {
    double u = random.uniform(-overshoot, 1 + overshoot);
    double v = random.uniform(-overshoot, 1 + overshoot - u);
    const std::uint32_t place = random.below(8);
    if (place == 0) u = 0;
    if (place == 1) v = 0;
    if (place == 2) v = 1 - u;
    const Vec3d v0 = widen(triangle.v0);
    return v0 + (widen(triangle.v1) - v0) * u + (widen(triangle.v2) - v0) * v;
}

inline TriangleCase triangle_case(int kind, std::uint64_t number) {
    Random random(number * 64 + static_cast<std::uint64_t>(kind) + 0x7A7A0000U);
    const auto integer = [&](int range) {
        return static_cast<float>(static_cast<int>(random.below(2U * static_cast<unsigned>(range) + 1U)) - range);
    };
    const auto lattice = [&](int range) {
        const float x = integer(range), y = integer(range), z = integer(range);
        return Vec3f{x, y, z};
    };
    const auto in_ball = [&](double radius) { return any_unit(random) * (radius * random.uniform(0.0, 1.0)); };
    /// Corners within `size` of `centre`.
    const auto around = [&](const Vec3d& centre, double size) {
        return Triangle{narrow(centre + in_ball(size)), narrow(centre + in_ball(size)), narrow(centre + in_ball(size))};
    };
    /// A ray from `origin` at a point of the triangle.
    const auto at = [&](const Triangle& triangle, const Vec3d& origin, double length = 1) {
        const Vec3f from = narrow(origin);
        Vec3d direction = point_of(random, triangle) - widen(from);
        if (norm1(direction) == 0) direction = {0, 0, 1};
        return TriangleCase{triangle, {from, narrow(normalize(direction) * length)}};
    };
    switch (kind) {
        case 0: {
            const Triangle triangle = around(in_ball(10), 2);
            return at(triangle, in_ball(12));
        }
        case 1:
        case 2: {  // small integers, so that the ray meets the edge or the vertex exactly
            const Triangle triangle = {lattice(64), lattice(64), lattice(64)};
            const float part = kind == 2 ? 0.0F : static_cast<float>(random.below(17)) / 16;
            Vec3f target = triangle.v1 + (triangle.v2 - triangle.v1) * part;
            if (random.below(16) == 0) target = triangle.v0;
            Vec3f origin = lattice(256);
            if (random.coin()) origin = origin * 16.0F;
            Vec3f direction = target - origin;
            if (norm1(direction) == 0.0F) direction = {0, 1, 0};
            return {triangle, {origin, direction * static_cast<float>(random.below(7) + 1)}};
        }
        case 3: {
            const Triangle triangle = around({0, 0, 0}, 1);
            const double part = random.uniform(0.0, 1.0);
            const Vec3d edge = widen(triangle.v0) * part + widen(triangle.v1) * (1 - part);
            const Vec3d beside = any_unit(random) * (random.coin() ? 0 : std::exp2(random.uniform(-50.0, -15.0)));
            const Vec3f origin = narrow(any_unit(random) * random.uniform(1.0, 20.0));
            return {triangle, {origin, narrow(edge + beside - widen(origin))}};
        }
        case 4: {  // 1e-3 to 1e-10 radians from the plane
            const Triangle triangle = around({0, 0, 0}, 1);
            const Vec3d normal = triangle_normal(triangle.v0, triangle.v1, triangle.v2);
            const Vec3d target = point_of(random, triangle);
            const double angle = std::pow(10.0, random.uniform(-10.0, -3.0));
            const Vec3d along = any_across(random, normal) + normal * (random.coin() ? angle : -angle);
            const Vec3f origin = narrow(target - along * random.uniform(0.1, 10.0));
            return {triangle, {origin, narrow(target - widen(origin))}};
        }
        case 5: {
            const Vec3d a = in_ball(1);
            const Vec3d along = any_unit(random);
            const Vec3d across = any_across(random, along) * std::exp2(random.uniform(-20.0, -14.0));
            const Triangle triangle = {narrow(a), narrow(a + along),
                                       narrow(a + along * random.uniform(0.0, 1.0) + across)};
            return at(triangle, any_unit(random) * random.uniform(1.0, 10.0));
        }
        case 6: {  // half a million metres each way, from the height of a man; level, or a little tilted
            const double tilt = random.coin() ? 0 : random.uniform(-1e-3, 1e-3);
            const Triangle ground = {{-1e6F, static_cast<float>(-1e6 * tilt), -1e6F},
                                     {0, 0, 1e6F},
                                     {1e6F, static_cast<float>(1e6 * tilt), -1e6F}};
            const double elevation = -std::pow(10.0, random.uniform(-6.0, 0.0));
            const double azimuth = random.uniform(0.0, 6.28);
            return {ground, {{0, 1.7F, 0}, narrow(Vec3d{std::cos(azimuth), elevation, std::sin(azimuth)})}};
        }
        case 7: {
            const Triangle triangle = around(in_ball(2), 1);
            const Vec3d normal = triangle_normal(triangle.v0, triangle.v1, triangle.v2);
            const Vec3d over = point_of(random, triangle) + normal * std::pow(10.0, random.uniform(-8.0, -5.0));
            return {triangle, {narrow(over), narrow(any_unit(random) - normal * random.uniform(0.0, 3.0))}};
        }
        case 8: {
            const double size = std::pow(10.0, random.uniform(-7.0, -3.0));
            const Triangle triangle = around(in_ball(size), size);
            return at(triangle, random.coin() ? any_unit(random) * size * 3.0 : any_unit(random));
        }
        case 9: {
            const Vec3d centre = random.coin() ? Vec3d{0, 0, 0} : any_unit(random) * 1e6;
            const Triangle triangle = around(centre, random.coin() ? 1 : 100);
            return at(triangle, centre + any_unit(random) * std::exp2(random.uniform(3.0, 20.0)));
        }
        case 10: {  // collinear, or with a repeated vertex
            const Vec3f a = lattice(32);
            const Vec3f step = lattice(32);
            Triangle line = {a, a + step * integer(4), a + step * integer(4)};
            if (random.below(4) == 0) line.v1 = line.v0 = narrow(in_ball(1));
            return at(line, any_unit(random) * random.uniform(1.0, 100.0));
        }
        case 11: {  // the third corner is the float nearest to a point of the edge
            const Vec3f a = narrow(in_ball(4)), b = narrow(in_ball(4));
            const double part = random.uniform(-0.5, 1.5);
            const Triangle sliver = {a, b, narrow(widen(a) * part + widen(b) * (1 - part))};
            return at(sliver, any_unit(random) * random.uniform(1.0, 10.0));
        }
        case 12: {  // the origin in the plane, the direction along it, or both; a third of each
            Triangle flat = {lattice(8), lattice(8), lattice(8)};
            const Vec3f v0 = flat.v0;
            const Vec3f e1 = flat.v1 - v0, e2 = flat.v2 - v0;
            const auto in_plane = [&] { return e1 * (integer(8) / 4) + e2 * (integer(8) / 4); };
            const std::uint32_t which = random.below(3);
            const Vec3f origin = which == 0 ? lattice(16) : v0 + in_plane();
            Vec3f direction = which == 1 ? lattice(16) : in_plane();
            if (norm1(direction) == 0.0F) direction = {1, 0, 0};
            return {flat, {origin, direction}};
        }
        case 13: {
            const double size = std::exp2(random.uniform(-60.0, 50.0));
            const Triangle triangle = around(in_ball(size), size);
            const double length = std::exp2(random.uniform(-60.0, 55.0));
            return at(triangle, any_unit(random) * std::min(1e17, size * std::exp2(random.uniform(-3.0, 8.0))), length);
        }
        case 14: {  // through the plane of origin and edge: the volume is an exact zero of three products of 24 bits
                    // each
            const auto big_integer = [&] {
                const int magnitude = static_cast<int>(random.below(1U << 23) + (1U << 22));
                return static_cast<float>(random.coin() ? magnitude : -magnitude);
            };
            const auto even = [&] { return Vec3f{big_integer(), big_integer(), big_integer()}; };
            const Vec3f p = even(), q = even();
            Vec3f direction = (p + q) * 0.5F;  // exact, or off by half a unit
            if (random.below(4) == 0) direction.x = std::nextafter(direction.x, 1e9F);
            const Vec3f origin = random.coin() ? Vec3f{0, 0, 0} : narrow(in_ball(1e-6));
            return {{p, q, even()}, {origin, direction}};
        }
        default: {  // coordinates whose differences no double holds
            const auto any_size = [&] { return random.below(3) == 0 ? random.log_uniform(-100.0, -20.0) : integer(4); };
            const auto corner = [&] { return Vec3f{any_size(), any_size(), any_size()}; };
            const Triangle triangle = {corner(), corner(), corner()};
            TriangleCase c = at(triangle, widen(lattice(16)));
            if (random.coin()) c.ray.origin[static_cast<int>(random.below(3))] = random.log_uniform(-100.0, -30.0);
            if (random.coin()) c.ray.direction = triangle.v1 - c.ray.origin;
            if (norm1(c.ray.direction) == 0.0F) c.ray.direction = {1, 0, 0};
            return c;
        }
    }
}

/// Corners as a C++ literal.
inline std::string reproducer(const Triangle& t) {
    char text[300];
    const auto d = [](float x) { return static_cast<double>(x); };
    std::snprintf(text, sizeof text, "Triangle{{%aF, %aF, %aF}, {%aF, %aF, %aF}, {%aF, %aF, %aF}}", d(t.v0.x),
                  d(t.v0.y), d(t.v0.z), d(t.v1.x), d(t.v1.y), d(t.v1.z), d(t.v2.x), d(t.v2.y), d(t.v2.z));
    return text;
}

}  // namespace tandem::test
