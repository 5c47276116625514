#include "ray_sets.h"

#include <bit>

#include "tandem/base/error.h"
#include "tandem/kernel/sampler/philox.h"

namespace tandem::bench {

namespace {

Ray<float> coherent_ray(int x, int y, int edge) {
    const double half = 1 / 1.5;
    const double step = 2 * half / edge;
    return {{0, 0, 3.2F}, narrow(Vec3d{-half + (x + 0.5) * step, half - (y + 0.5) * step, -1})};
}

Ray<float> random_ray(std::uint32_t index) {
    // Rejection sampling of the unit ball. No libm, so the bits are equal everywhere.
    std::uint32_t draw = 1;
    Vec3d direction = uniform_in_cube(20, index, draw);
    while (dot(direction, direction) > 1 || dot(direction, direction) < 1e-6)
        direction = uniform_in_cube(20, index, ++draw);
    return {narrow(uniform_in_cube(20, index, 0)), narrow(normalize(direction))};
}

}  // namespace

RaySet parse_ray_set(const std::string& name) {
    if (name == "coherent") return RaySet::coherent;
    if (name == "random") return RaySet::random;
    throw InputError("--rays is '" + name + "', but must be coherent or random");
}

Vec3d uniform_in_cube(std::uint32_t stream, std::uint32_t index, std::uint32_t draw) {
    const auto bits = philox4x32<std::uint32_t>({{index, draw, 0, 0}}, stream, 24);
    const auto coordinate = [&](int i) { return 2 * double{to_unit_interval<float>(bits.word[i])} - 1; };
    return {coordinate(0), coordinate(1), coordinate(2)};
}

std::string to_string(RaySet set) { return set == RaySet::coherent ? "coherent" : "random"; }

std::vector<Ray<float>> make_rays(RaySet set, int edge) {
    std::vector<Ray<float>> rays;
    rays.reserve(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge));
    for (int y = 0; y < edge; ++y) {
        for (int x = 0; x < edge; ++x) {
            rays.push_back(set == RaySet::coherent ? coherent_ray(x, y, edge)
                                                   : random_ray(static_cast<std::uint32_t>(rays.size())));
        }
    }
    return rays;
}

bool has_bits_of(const Hit& a, const Hit& b) {
    return a.primitive == b.primitive && std::bit_cast<std::uint32_t>(a.t) == std::bit_cast<std::uint32_t>(b.t);
}

}  // namespace tandem::bench
