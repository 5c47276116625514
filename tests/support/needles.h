/// Ellipsoids and parallelepipeds as thin as needles, which the CPU's hierarchies hold in pieces
/// (cpu/cut_primitives.h).
#pragma once

#include <cmath>
#include <vector>

#include "support/random.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/shapes/body_pieces.h"

namespace tandem::test {

/// `count` of each kind in a cube of two metres around the origin, up to `length` metres long, and from 10 to 10^5
/// times as long as wide.
inline PreparedScene needles(Random& random, int count, double length) {
    Scene scene;
    scene.materials.emplace_back();
    scene.nodes.emplace_back().camera = Camera{};
    const auto part = [&] { return random.uniform(-1.0, 1.0); };
    for (int i = 0; i < 2 * count; ++i) {
        Node node;
        node.trs.translation = {part(), part(), part()};
        const double half = 0.5 * length * random.uniform(0.5, 1.0);
        node.trs.scale = {half, half * std::pow(10.0, random.uniform(-5.0, -1.0)),
                          half * std::pow(10.0, random.uniform(-5.0, -1.0))};
        const double x = part(), y = part(), z = part(), w = part();
        const double inverse = 1 / std::sqrt(x * x + y * y + z * z + w * w);
        node.trs.rotation = {x * inverse, y * inverse, z * inverse, w * inverse};
        const Shape shape = i < count ? Shape{SphereShape{1}} : Shape{BoxShape{{2, 2, 2}}};
        node.geometry.push_back({shape, 0, {}});
        scene.nodes.push_back(std::move(node));
    }
    return prepare(scene);
}

/// A point of a solid: `local` in the space of its unit sphere or cube.
inline Vec3d point_of(const Placement& placement, const Vec3d& local) {
    return placement.centre + half_edges(placement) * local;
}

/// From anywhere near to points of the needles, half of them near their ends.
inline std::vector<Ray<float>> rays_at_needles(const PreparedScene& scene, Random& random, int count) {
    std::vector<Ray<float>> rays;
    const auto part = [&] { return random.uniform(-1.0, 1.0); };
    for (int i = 0; i < count; ++i) {
        Vec3d local = {part(), part(), part()};
        if (random.coin()) local.x = (random.coin() ? 1 : -1) * random.uniform(0.999, 1.0);
        const bool is_ellipsoid = random.coin();
        if (is_ellipsoid) local = local * (1 / length(local));
        const auto number = [&](const auto& bodies) { return random.below(static_cast<std::uint32_t>(bodies.size())); };
        const Vec3f target =
            narrow(is_ellipsoid ? point_of(scene.ellipsoids[number(scene.ellipsoids)], local)
                                : point_of(scene.parallelepipeds[number(scene.parallelepipeds)], local));
        const Vec3f origin = {random.uniform(-3.0F, 3.0F), random.uniform(-3.0F, 3.0F), random.uniform(-3.0F, 3.0F)};
        rays.push_back({origin, target - origin});
    }
    return rays;
}

}  // namespace tandem::test
