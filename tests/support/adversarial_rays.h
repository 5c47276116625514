/// Rays and solids that are hard for intersection tests, by kind (docs/numerics.md). Each case is a function of (kind,
/// number), which reproduce it.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "support/aim.h"
#include "tandem/kernel/shapes/box.h"

namespace tandem::test {

inline constexpr const char* sphere_kinds[] = {"near",
                                               "far",
                                               "grazing",
                                               "grazing and far",
                                               "tiny",
                                               "planet",
                                               "horizon",
                                               "near surface",
                                               "on the surface",
                                               "inside",
                                               "huge",
                                               "minute",
                                               "long and short directions",
                                               "any magnitudes",
                                               "tangent, exact",
                                               "through the centre",
                                               "zeros and subnormals"};

inline SphereCase sphere_case(int kind, std::uint64_t number) {
    Random random(number * 64 + static_cast<std::uint64_t>(kind));
    const Vec3d origin = {0, 0, 0};
    const auto grazing = [&] { return 1 + (random.coin() ? 1 : -1) * std::exp2(random.uniform(-30.0, -6.0)); };
    switch (kind) {
        case 0:
            return aim(random, any_unit(random) * random.uniform(0.0, 10.0), random.uniform(0.1, 2.0),
                       random.uniform(2.0, 20.0), random.uniform(0.0, 1.2));
        case 1:
            return aim(random, origin, 1, std::exp2(random.uniform(3.0, 20.0)), random.uniform(0.0, 0.999));
        case 2:
            return aim(random, origin, 1, 4, grazing());
        case 3:
            return aim(random, any_unit(random) * 100.0, 1, std::exp2(random.uniform(3.0, 20.0)), grazing());
        case 4:
            return aim(random, origin, std::exp2(random.uniform(-24.0, -10.0)), 100, random.uniform(0.0, 1.5));
        case 5: {  // looking down from 1.75 m above a planet
            SphereCase c = aim(random, {0, -6.4e6, 0}, 6.4e6, 6.4e6 + 1.75, random.uniform(0.0, 0.5));
            c.ray.origin = {0, 1.75F, 0};
            c.ray.direction = narrow(any_unit(random));
            c.ray.direction.y = -std::abs(c.ray.direction.y);
            return c;
        }
        case 6: {  // the same, towards the horizon
            const double elevation = random.uniform(-4e-3, 0.0);
            const double azimuth = random.uniform(0.0, 6.28);
            const auto direction = Vec3d{std::cos(azimuth), elevation, std::sin(azimuth)};
            return {{{0, -6.4e6F, 0}, 6.4e6F}, {{0, 1.75F, 0}, narrow(direction)}};
        }
        case 7: {  // heading in from a gap of 2^-6 to 2^-24 radii
            const Vec3d up = any_unit(random);
            const Vec3d from = up * (1 + std::exp2(random.uniform(-24.0, -6.0)));
            return {{{0, 0, 0}, 1}, {narrow(from), narrow(any_unit(random) - up * random.uniform(0.0, 2.0))}};
        }
        case 8: {  // the nearest float to a surface point; any direction, some along the surface
            const double radius = std::exp2(random.uniform(-10.0, 10.0));
            const Vec3d centre = any_unit(random) * random.uniform(0.0, 100.0);
            const Vec3d up = any_unit(random);
            const Vec3d out = random.coin() ? any_unit(random) : any_across(random, up);
            return {{narrow(centre), static_cast<float>(radius)}, {narrow(centre + up * radius), narrow(out)}};
        }
        case 9: {
            const double radius = random.coin() ? 1 : 1e7;
            return {{{0, 0, 0}, static_cast<float>(radius)},
                    {narrow(any_unit(random) * (radius * random.uniform(0.0, 1.0))), narrow(any_unit(random))}};
        }
        case 10:
            return aim(random, origin, 1e16, 1e17, random.uniform(0.0, 1.1));
        case 11:
            return aim(random, origin, 1e-25, 1e-24, random.uniform(0.0, 1.1));
        case 12:
            return aim(random, origin, 1, 4, random.uniform(0.0, 1.1), std::exp2(random.uniform(-120.0, 59.0)));
        case 13: {
            const double size = std::exp2(random.uniform(-100.0, 50.0));
            const double distance = size * std::exp2(random.uniform(-1.0, 12.0));
            if (distance > 1e18) return sphere_case(1, number);
            return aim(random, origin, size, distance, random.coin() ? grazing() : random.uniform(0.0, 1.0),
                       std::exp2(random.uniform(-60.0, 50.0)));
        }
        case 14: {  // Pythagorean directions and offsets: the line touches exactly, or misses by one unit of the radius
            static constexpr int triples[][3] = {{3, 4, 5}, {5, 12, 13}, {8, 15, 17}, {7, 24, 25}, {20, 21, 29}};
            const auto& [p, q, hypotenuse] = triples[random.below(5)];
            const auto scale = static_cast<float>(std::exp2(static_cast<double>(random.below(20)) - 10));
            const auto step = static_cast<float>(static_cast<int>(random.below(2000)) - 1000);
            const auto k = static_cast<float>(random.below(500) + 1);
            const auto P = static_cast<float>(p), Q = static_cast<float>(q), H = static_cast<float>(hypotenuse);
            const Vec3f centre = {static_cast<float>(random.below(64)) * scale, 0, scale};
            const Vec3f offset = {(-Q * k + P * step) * scale, (P * k + Q * step) * scale, 0};
            float radius = H * k * scale;
            if (random.below(3) == 0) radius = std::nextafter(radius, random.coin() ? 0.0F : 1e30F);
            return {{centre, radius}, {centre + offset, {-P, -Q, 0}}};
        }
        case 15: {  // exactly at the centre of a sphere that may be far smaller than the distance allows to see
            const auto a = static_cast<float>(random.below(4096));
            const Vec3f direction = {a, static_cast<float>(random.below(4096)),
                                     static_cast<float>(random.below(4095) + 1)};
            const auto k = static_cast<float>(-1 - static_cast<int>(random.below(4096)));
            return {{{0, 0, 0}, static_cast<float>(std::exp2(random.uniform(-60.0, 0.0)))},
                    {direction * k, direction * static_cast<float>(random.below(7) + 1)}};
        }
        default: {  // directions with zeros and subnormals
            SphereCase c = aim(random, origin, 1, 3, random.uniform(0.0, 1.1));
            c.ray.origin = {random.uniform(-1.5F, 1.5F), random.uniform(-1.5F, 1.5F), -3};
            c.ray.direction = {random.coin() ? 0.0F : random.log_uniform(-149.0, -126.0),
                               random.coin() ? -0.0F : random.log_uniform(-149.0, -126.0),
                               random.coin() ? 1.0F : 0x1p-127F};
            if (random.coin()) c.ray.origin = {1, 0, -3};
            return c;
        }
    }
}

struct BoxCase {
    Box box;
    Ray<float> ray;
};

inline constexpr const char* box_kinds[] = {"inside and outside",
                                            "zero direction components",
                                            "subnormal direction components",
                                            "corners, exact",
                                            "edges, dyadic",
                                            "edges, close",
                                            "flat and thin",
                                            "small and far out",
                                            "from far away",
                                            "on a face",
                                            "any magnitudes",
                                            "edges, by the last bits"};

/// A line that enters by one axis and leaves by another at parameters n1 / d1 and n2 / d2 with n1 d2 - n2 d1 = 0, 1 or
/// -1: they differ by 2^-70 of themselves, so that only exact arithmetic decides whether the line touches the edge.
inline BoxCase almost_equal_quotients(Random& random) {
    const auto odd = [&] { return std::int64_t{random.below(1U << 22)} * 2 + (1 << 23) + 1; };
    std::int64_t d1 = odd(), d2 = odd();
    // Bezout: x d2 + y d1 = gcd
    std::int64_t r0 = d2, r1 = d1, x0 = 1, x1 = 0;
    while (r1 != 0) {
        const std::int64_t q = r0 / r1;
        r0 = std::exchange(r1, r0 - q * r1);
        x0 = std::exchange(x1, x0 - q * x1);
    }
    d1 /= r0;
    d2 /= r0;
    const std::int64_t apart = static_cast<std::int64_t>(random.below(3)) - 1;
    // NOLINTNEXTLINE(clang-analyzer-core.DivideZero): d1 was at least 2^23, and r0 divides it
    const std::int64_t x = ((x0 % d1 + d1) % d1 * apart % d1 + d1) % d1;
    const std::int64_t k = random.below(1U << 23) + 1;
    const std::int64_t n1 = x + k * d1;
    const std::int64_t n2 = (x * d2 - apart) / d1 + k * d2;
    // n = face - origin, each of at most 24 bits
    const auto face = [](std::int64_t n) { return (n + (1 << 23)) >> 24 << 24; };
    const Vec3f origin = {static_cast<float>(face(n1) - n1), static_cast<float>(face(n2) - n2), 0};
    const Box box = {{static_cast<float>(face(n1)), -0x1p59F, -1}, {0x1p59F, static_cast<float>(face(n2)), 1}};
    const Vec3f direction = {static_cast<float>(d1), static_cast<float>(d2), 0};
    const int turn = static_cast<int>(random.below(3));
    const auto turned = [&](const Vec3f& v) { return Vec3f{v[turn], v[(turn + 1) % 3], v[(turn + 2) % 3]}; };
    return {{turned(box.lower), turned(box.upper)}, {turned(origin), turned(direction)}};
}

inline BoxCase box_case(int kind, std::uint64_t number) {
    Random random(number * 64 + static_cast<std::uint64_t>(kind) + 0x5A5A5A00U);
    const Box unit = {{-1, -1, -1}, {1, 1, 1}};
    const auto integer = [&](int range) {
        return static_cast<float>(static_cast<int>(random.below(2U * static_cast<unsigned>(range) + 1U)) - range);
    };
    const auto sign = [&] { return random.coin() ? 1.0F : -1.0F; };
    /// A point on an edge of `unit`: two coordinates are at their limits.
    const auto edge_point = [&](float free) {
        Vec3f p = {sign(), sign(), sign()};
        p[static_cast<int>(random.below(3))] = free;
        return p;
    };
    switch (kind) {
        case 0:
            return {{{-1, -2, -0.5F}, {1.5F, 1, 2}},
                    {narrow(any_unit(random) * random.uniform(0.0, 6.0)), narrow(any_unit(random))}};
        case 1: {  // some of them with the origin in the plane of a face
            const auto coordinate = [&] {
                const float limits[] = {-1.0F, 1.0F, random.uniform(-1.2F, 1.2F), 1.0000001F, -0.99999994F};
                return limits[random.below(5)];
            };
            Ray<float> ray = {{coordinate(), coordinate(), coordinate()}, {0, 0, 0}};
            for (int i = 0; i < 3; ++i) ray.direction[i] = random.coin() ? sign() * 0.0F : random.uniform(-1.0F, 1.0F);
            const int axis = static_cast<int>(random.below(3));
            if (norm1(ray.direction) == 0.0F) ray.direction[axis] = sign();
            if (random.coin()) ray.origin[axis] = -3 * ray.direction[axis];
            return {unit, ray};
        }
        case 2: {
            Ray<float> ray = {{random.uniform(-1.5F, 1.5F), random.uniform(-1.5F, 1.5F), random.uniform(-1.5F, 1.5F)},
                              {}};
            if (random.coin()) ray.origin.x = sign();
            for (int i = 0; i < 3; ++i) ray.direction[i] = random.log_uniform(-149.0, -120.0);
            if (random.coin()) ray.direction.z = sign();
            return {unit, ray};
        }
        case 3: {
            const Vec3f origin = {integer(50), integer(50), integer(50)};
            const Vec3f corner = {sign(), sign(), sign()};
            const Vec3f direction = corner - origin;
            if (norm1(direction) == 0.0F) return box_case(0, number);
            return {unit, {origin, direction * static_cast<float>(random.below(7) + 1)}};
        }
        case 4: {
            const Vec3f target = edge_point(integer(512) / 512);
            const Vec3f origin = {integer(4096) / 256, integer(4096) / 256, integer(4096) / 256};
            const Vec3f direction = target - origin;
            if (norm1(direction) == 0.0F) return box_case(0, number);
            return {unit, {origin, direction}};
        }
        case 5: {
            const Vec3d target = widen(edge_point(random.uniform(-1.0F, 1.0F))) * (1 + random.uniform(-1e-6, 1e-6));
            const Vec3d origin = any_unit(random) * random.uniform(2.0, 10.0);
            return {unit, {narrow(origin), narrow(target - origin)}};
        }
        case 6: {
            const float at = random.coin() ? 1000.0F : 0.125F;
            const float to = random.coin() ? at : std::nextafter(at, 1e9F);
            const Box thin = {{at, -1, -1}, {to, 1, 1}};
            const Vec3f origin = {at + integer(8), integer(2) / 2, integer(2) / 2};
            const Vec3f target = {to, random.uniform(-1.1F, 1.1F), random.coin() ? 1.0F : random.uniform(-1.1F, 1.1F)};
            const Vec3f direction = target - origin;
            if (norm1(direction) == 0.0F) return box_case(0, number);
            return {thin, {origin, direction}};
        }
        case 7: {
            const Box small = {{1000, 1000, 1000}, {1000.001F, 1000.001F, 1000.001F}};
            const Vec3f origin = {random.uniform(999.9995F, 1000.0015F), random.uniform(999.9995F, 1000.0015F),
                                  random.uniform(999.9995F, 1000.0015F)};
            return {small, {origin, narrow(any_unit(random))}};
        }
        case 8: {
            const Vec3d origin = any_unit(random) * std::exp2(random.uniform(3.0, 20.0));
            const Vec3d target = {random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2)};
            return {unit, {narrow(origin), narrow(target - origin)}};
        }
        case 9: {
            Vec3f origin = {random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)};
            const int axis = static_cast<int>(random.below(3));
            origin[axis] = sign();
            if (random.coin()) origin[(axis + 1) % 3] = sign();
            Vec3f direction = narrow(any_unit(random));
            if (random.coin()) direction[axis] = 0;
            return {unit, {origin, direction}};
        }
        case 10: {
            const double size = std::exp2(random.uniform(-60.0, 50.0));
            Box box;
            Vec3d inside = {0, 0, 0};
            for (int i = 0; i < 3; ++i) {
                const double a = random.uniform(-1.0, 1.0) * size;
                const double b = a + std::exp2(random.uniform(-20.0, 1.0)) * size;
                box.lower[i] = static_cast<float>(a);
                box.upper[i] = static_cast<float>(b);
                inside[i] = random.coin() ? b : random.uniform(a, b);
            }
            const Vec3d origin = any_unit(random) * (size * std::exp2(random.uniform(-2.0, 6.0)));
            const double length = std::exp2(random.uniform(-40.0, 5.0)) / size;
            return {box, {narrow(origin), narrow((inside - origin) * std::min(length, 1e17 / size))}};
        }
        default:
            return almost_equal_quotients(random);
    }
}

}  // namespace tandem::test
