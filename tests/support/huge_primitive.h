/// Small primitives beside a huge one, where boxes that are padded by a part of the scene's reach would all overlap.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "support/aim.h"
#include "support/random.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/traversal/intersect.h"
#include "tandem/math/ray.h"

namespace tandem::test {

/// The small primitives of beside_a_huge_one(), which come first in their kind's list.
inline constexpr std::uint32_t small_count = 100;

/// A sphere or a triangle that is `size` times as large as the other primitives: spheres of radius 1, boxes or
/// triangles around `middle`.
inline PreparedScene beside_a_huge_one(Random& random, float size, const Vec3f& middle) {
    PreparedScene scene;
    const int kind = static_cast<int>(random.below(3));
    const auto place = [&] {
        return middle + Vec3f{random.uniform(-9.0F, 9.0F), random.uniform(-9.0F, 9.0F), random.uniform(-9.0F, 9.0F)};
    };
    for (std::uint32_t i = 0; i < small_count; ++i) {
        const Vec3f a = place();
        if (kind == 0) scene.spheres.push_back({a, 1});
        if (kind == 1) scene.boxes.push_back({a, a + Vec3f{1, 0.5F, 0.25F}});
        if (kind == 2) scene.triangles.push_back({a, a + Vec3f{1, 0.5F, 0}, a + Vec3f{0, -0.5F, 1}});
    }
    if (random.coin()) {
        scene.spheres.push_back({middle + Vec3f{0, -size - 10, 0}, size});
    } else {
        scene.triangles.push_back({middle + Vec3f{-size, -10, size}, middle + Vec3f{0, -10, -2 * size},
                                   middle + Vec3f{size, 0.1F * size, size}});
    }
    scene.material_of.assign(primitive_count(scene), 0);
    scene.materials.emplace_back();
    return scene;
}

/// The same with any size from 2^10 to 2^36, half of them around the origin, half up to 2^12 away from it.
inline PreparedScene beside_a_huge_one(Random& random) {
    const float size = static_cast<float>(std::exp2(random.uniform(10.0, 36.0)));
    const float away = random.coin() ? 0.0F : static_cast<float>(std::exp2(random.uniform(0.0, 12.0)));
    return beside_a_huge_one(random, size, Vec3f{1, -0.5F, 0.25F} * away);
}

/// Rays from nearby and from very far away to points in and on the boxes of the first `small_count` primitives.
inline std::vector<Ray<float>> rays_at_small_ones(const PreparedScene& prepared, Random& random, int count) {
    const SceneView scene = view(prepared);
    std::vector<Ray<float>> rays;
    for (int i = 0; i < count; ++i) {
        const Aabb box = primitive_bounds(scene, static_cast<std::uint32_t>(random.below(small_count)));
        const auto within = [&](float low, float high) {
            const double part = random.below(4) == 0 ? 1 : random.uniform(0.0, 1.0);
            return static_cast<float>(low + part * (double{high} - low));
        };
        const Vec3f target = {within(box.lower.x, box.upper.x), within(box.lower.y, box.upper.y),
                              within(box.lower.z, box.upper.z)};
        const double far = std::exp2(random.uniform(-2.0, 44.0));
        Vec3f direction = narrow(any_unit(random));
        if (random.below(4) == 0) direction[static_cast<int>(random.below(3))] = random.coin() ? 0.0F : 1e-25F;
        const Vec3f origin = target - direction * static_cast<float>(far);
        rays.push_back({origin, random.coin() ? target - origin : direction});
    }
    return rays;
}

}  // namespace tandem::test
