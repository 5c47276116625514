// Group A: rays and spheres. The oracle is exact arithmetic on the same floats, except where a case says otherwise.
#include <fmt/format.h>

#include <cmath>

#include "hard/corpus/groups.h"
#include "hard/corpus/ray_batches.h"
#include "support/exact_geometry.h"
#include "tandem/kernel/shapes/sphere.h"

namespace tandem::hard {

namespace {

using test::aim;
using test::any_across;
using test::any_unit;

constexpr const char* exact = "exact arithmetic";
const Sphere unit = {{0, 0, 0}, 1};

/// Rays toward a sphere around the origin, from `distance` away, that pass its centre at impact() radii.
template <class Impact>
void add_aimed(std::vector<RayBatch>& batches, Random& random, float radius, double distance, std::size_t rays,
               Impact impact, double length = 1) {
    const double r = double{radius};
    const double shell_radius = std::min(4 * distance, 9e17);
    add_batches(batches, random, {{{0, 0, 0}, radius}}, {}, shell_radius, rays, [&] {
        return aim(random, {0, 0, 0}, r, distance, impact(), length).ray;
    });
}

double either_side_of_one(Random& random, double gap) { return random.coin() ? 1 + gap : 1 - gap; }

std::vector<RayBatch> far_away(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (int k = 1; k <= 6; ++k) {
        add_aimed(batches, random, 1, std::pow(10.0, k), rays / 6, [&] { return random.uniform(0.0, 0.999); });
    }
    return batches;
}

const Sphere planet = {{0, -6.4e6F, 0}, 6.4e6F};
const Vec3f eye_above_planet = {0, 1.75F, 0};

std::vector<RayBatch> planet_from_above(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    add_batches(batches, random, {planet}, {}, 3e7, rays, [&] {
        Vec3d down = any_unit(random);
        down.y = -std::abs(down.y);
        return Ray<float>{eye_above_planet, narrow(down)};
    });
    return batches;
}

std::vector<RayBatch> horizon(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    add_batches(batches, random, {planet}, {}, 3e7, rays, [&] {
        const double elevation = random.uniform(-4e-3, 0.0);
        const double azimuth = random.uniform(0.0, 6.28);
        return Ray<float>{eye_above_planet, narrow(Vec3d{std::cos(azimuth), std::sin(elevation), std::sin(azimuth)})};
    });
    return batches;
}

std::vector<RayBatch> grazing(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (const double gap : {1e-2, 1e-4, 1e-6, 1e-7}) {
        add_aimed(batches, random, 1, 4, rays / 4, [&] { return either_side_of_one(random, gap); });
    }
    return batches;
}

std::vector<RayBatch> grazing_from_far(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    add_aimed(batches, random, 1, 1000, rays, [&] { return either_side_of_one(random, 1e-6); });
    return batches;
}

std::vector<RayBatch> tiny(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (const float radius : {1e-4F, 1e-6F}) {
        add_aimed(batches, random, radius, 100, rays / 2, [&] { return random.uniform(0.0, 1.2); });
    }
    return batches;
}

/// Exactly tangent lines: Pythagorean directions and offsets, integers below 2^24. The first ray is the textbook
/// example, with both hits at t = 5.
std::vector<RayBatch> tangent(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches = {{scene_of({unit}), {{{1, 0, -5}, {0, 0, 1}}}}};
    static constexpr float triples[][3] = {{3, 4, 5}, {5, 12, 13}, {8, 15, 17}, {7, 24, 25}, {20, 21, 29}};
    for (const auto& [p, q, hypotenuse] : triples) {
        for (const int off : {0, -1, 1}) {  // exactly; smaller and larger by the last bit of the radius
            const float k = static_cast<float>(random.below(500) + 1);
            float radius = hypotenuse * k;
            if (off != 0) radius = std::nextafter(radius, off < 0 ? 0.0F : HUGE_VALF);
            add_batches(batches, random, {{{0, 0, 0}, radius}}, {}, 1e6, rays / 15, [&, p = p, q = q] {
                const auto step = static_cast<float>(static_cast<int>(random.below(2000)) - 1000);
                return Ray<float>{{-q * k + p * step, p * k + q * step, 0}, {-p, -q, 0}};
            });
        }
    }
    return batches;
}

/// Rays from the float nearest to a surface point, which is just above, on or below the surface, and is judged as such.
std::vector<RayBatch> from_surface(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (const float radius : {1e-3F, 1.0F, 1e3F}) {
        const Vec3d centre = any_unit(random) * random.uniform(0.0, 10.0);
        const Sphere sphere = {narrow(centre), radius};
        add_batches(batches, random, {sphere}, {}, 5e3, rays / 3, [&] {
            const Vec3d up = any_unit(random);
            const Vec3d out = random.coin() ? any_unit(random) : any_across(random, up);
            return Ray<float>{narrow(centre + up * double{radius}), narrow(out)};
        });
    }
    return batches;
}

std::vector<RayBatch> from_inside(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (const float radius : {1.0F, 1e7F}) {
        add_batches(batches, random, {{{0, 0, 0}, radius}}, {}, 4.0 * double{radius}, rays / 2, [&] {
            const double at = random.below(8) == 0 ? 0 : random.uniform(0.0, 1.0) * double{radius};
            return Ray<float>{narrow(any_unit(random) * at), narrow(any_unit(random))};
        });
    }
    return batches;
}

std::vector<RayBatch> close_above(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (const double gap : {1e-4, 1e-5, 1e-6}) {
        add_batches(batches, random, {unit}, {}, 4, rays / 3, [&] {
            const Vec3d up = any_unit(random);
            return Ray<float>{narrow(up * (1 + gap)), narrow(any_unit(random) - up * random.uniform(0.5, 2.0))};
        });
    }
    return batches;
}

std::vector<RayBatch> minute(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (const float radius : {1e-20F, 1e-25F}) {
        add_aimed(batches, random, radius, 10.0 * double{radius}, rays / 2, [&] { return random.uniform(0.0, 1.1); });
    }
    return batches;
}

std::vector<RayBatch> enormous(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    add_aimed(batches, random, 9e16F, 9e17, rays, [&] { return random.uniform(0.0, 1.1); });
    return batches;
}

std::vector<RayBatch> any_length(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (const double length : {1e-38, 1e-25, 1e-20, 1e-12, 1e12, 9e17}) {
        add_aimed(
            batches, random, 1, 4, rays / 6, [&] { return random.uniform(0.0, 1.1); }, length);
    }
    return batches;
}

std::vector<RayBatch> looking_back(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    add_batches(batches, random, {unit}, {}, 4, rays, [&] {  // the exit is nearer than the surface behind by up to 2^20
        const Vec3d up = any_unit(random);
        return Ray<float>{narrow(up * (1 - std::exp2(random.uniform(-20.0, -2.0)))),
                          narrow(up + any_unit(random) * random.uniform(0.0, 0.5))};
    });
    return batches;
}

/// |n| = 1 and the angle to the normal of the exact hit point, both in 2^-24.
Score normals(Random& random, std::size_t calls) {
    using test::big;
    Score score;
    for (std::size_t i = 0; i < calls; ++i) {
        const test::SphereCase c = aim(random, any_unit(random), 1e-3, 10, random.uniform(0.0, 0.999));
        double t = 0;
        if (!first_hit(c.sphere, c.ray, t)) continue;
        const test::BigVector offset = big(c.ray.origin) - big(c.sphere.centre);
        const auto right = test::hit_ball(offset, big(c.ray.direction), test::Big(c.sphere.radius));
        const auto line = [&] { return to_literal(c.ray); };
        score.decide(!right, line);
        if (!right) continue;
        const test::BigVector point = test::along(offset, big(c.ray.direction), *right);
        const test::Big radius(c.sphere.radius);
        const Vec3d normal = sphere_normal(c.sphere, c.ray, t);
        const test::BigVector away =
            big(normal) - test::BigVector{point.x / radius, point.y / radius, point.z / radius};
        const double angle = static_cast<double>(sqrt(test::dot(away, away)));
        score.measure(std::max(angle, std::abs(std::sqrt(dot(normal, normal)) - 1)) * 0x1p24, line);
    }
    return score;
}

/// Rays from between two concentric spheres, like an eye and its cornea, and from outside; radii differ by 4e-5.
std::vector<RayBatch> concentric(Random& random, std::size_t rays) {
    std::vector<RayBatch> batches;
    for (const float radius : {0.012F, 1.0F, 6.4e6F}) {
        const float outer = radius * (1 + 4e-5F);
        add_batches(batches, random, {{{0, 0, 0}, radius}, {{0, 0, 0}, outer}}, {}, 10.0 * double{outer}, rays / 3,
                    [&] {
                        const double at = double{radius} * (random.coin() ? 1 + 2e-5 : random.uniform(0.0, 4.0));
                        return Ray<float>{narrow(any_unit(random) * at), narrow(any_unit(random))};
                    });
    }
    return batches;
}

}  // namespace

std::vector<HardCase> sphere_cases() {
    return {
        {"A1", "Unit sphere from 10 to 10^6 away", "b^2 - ac cancels: its error grows with the square of the distance",
         exact, RayCase{far_away}},
        {"A2", "A planet from 1.75 m above, looking down",
         "origin - centre, and its square minus r^2, round away the 1.75 m", exact, RayCase{planet_from_above}},
        {"A3", "The planet's horizon", "the same cancellation, for nearly tangent rays", exact, RayCase{horizon}},
        {"A4", "Grazing by 1e-2 to 1e-7 of the radius", "the discriminant is smaller than its own rounding error",
         exact, RayCase{grazing}},
        {"A5", "Grazing by 1e-6 from 1000 radii", "both at once: far away and nearly tangent", exact,
         RayCase{grazing_from_far}},
        {"A6", "Radius 1e-4 and 1e-6 at distance 100", "r^2 is below the rounding error of the squared distance", exact,
         RayCase{tiny}},
        {"A7", "Exactly tangent rays", "the sign of a discriminant of 0 is accidental; the root of -0 or less is NaN",
         exact, RayCase{tangent}},
        {"A8", "From the surface itself, rounded to float",
         "the constant term is rounding noise, so a root near t = 0 appears or disappears", exact,
         RayCase{from_surface}},
        {"A9", "From inside and from the centre; a sky sphere of 10^7",
         "0/0 at the centre; the root behind the origin is taken", exact, RayCase{from_inside}},
        {"A10", "From 1e-4 to 1e-6 above the surface", "the constant term cancels, and t with it", exact,
         RayCase{close_above}},
        {"A11", "Radius 1e-20 and 1e-25", "r^2 is subnormal or zero in float", exact, RayCase{minute}},
        {"A12", "Radius 9e16 at distance 9e17", "products overflow: infinity - infinity", exact, RayCase{enormous}},
        {"A13", "Directions with lengths from 1e-38 to 9e17",
         "d.d overflows or vanishes; code that assumes length 1 is off by that factor", exact, RayCase{any_length}},
        {"A14", "The exit from inside, close to the surface", "-b + root cancels", exact, RayCase{looking_back}},
        {"A15", "The normal of a sphere of radius 1e-3 at distance 10", "the hit point is 1e-3 radii off the surface",
         exact, FunctionCase{normals}},
        {"A16", "Two spheres whose radii differ by 4e-5", "an absolute epsilon skips the second surface", exact,
         RayCase{concentric}},
    };
}

}  // namespace tandem::hard
