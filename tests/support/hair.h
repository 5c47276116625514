/// Triangles as thin as hair, which hierarchies hold in pieces (cuda/cut_kernels.h, cpu/cut_primitives.h).
#pragma once

#include <cmath>
#include <vector>

#include "support/random.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem::test {

struct HairShape {
    float reach = 1;  ///< how far each goes on its way to another place in the cube
    float width = 1;  ///< times 2^-5 to 2^-2 metres, at random
};

/// `count` of them in a cube of two metres around the origin, and `spheres` small spheres, whose ids come first.
inline PreparedScene hair(Random& random, std::uint32_t count, std::uint32_t spheres = 0, HairShape shape = {}) {
    const auto anywhere = [&] {
        return Vec3f{random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)};
    };
    PreparedScene scene;
    for (std::uint32_t i = 0; i < spheres; ++i) scene.spheres.push_back({anywhere(), 0.02F});
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3f root = anywhere(), tip = root + (anywhere() - root) * shape.reach;
        const float width = shape.width * std::abs(random.log_uniform(-5.0, -2.0));
        Triangle triangle{root, tip, root + anywhere() * width};
        triangle.attributes.sides = FaceSides::double_sided;
        scene.triangles.push_back(triangle);
    }
    scene.material_of.assign(count + spheres, 0);
    scene.materials.emplace_back();
    scene.optics.emplace_back();
    return scene;
}

/// From anywhere near to points of the triangles, half of them to points of their edges.
inline std::vector<Ray<float>> rays_at_hair(const PreparedScene& scene, Random& random, int count) {
    std::vector<Ray<float>> rays;
    for (int i = 0; i < count; ++i) {
        const Triangle& t = scene.triangles[random.below(static_cast<std::uint32_t>(scene.triangles.size()))];
        const float u = random.uniform(0.0F, 1.0F), v = random.coin() ? 0 : random.uniform(0.0F, 1 - u);
        const Vec3f target = t.v0 + (t.v1 - t.v0) * u + (t.v2 - t.v0) * v;
        const Vec3f origin = {random.uniform(-3.0F, 3.0F), random.uniform(-3.0F, 3.0F), random.uniform(-3.0F, 3.0F)};
        rays.push_back({origin, target - origin});
    }
    return rays;
}

}  // namespace tandem::test
