/// Scenes of primitives that touch, overlap or coincide where rays hit them: more candidates than a tracer keeps that
/// decides behind its traversal.
#pragma once

#include <cmath>
#include <vector>

#include "support/hard_scenes.h"
#include "support/random.h"

namespace tandem::test {

struct Bundles {
    PreparedScene solids, faces;
};

[[nodiscard]] inline Bundles make_bundles(std::uint64_t seed) {
    Random random(seed);
    Bundles bundles;
    PreparedScene &solids = bundles.solids, &faces = bundles.faces;
    for (int bundle = 0; bundle < 12; ++bundle) {
        const Vec3f at = {random.uniform(-9.0F, 9.0F), random.uniform(-9.0F, 9.0F), random.uniform(-9.0F, 9.0F)};
        for (int i = 0; i < 8; ++i) {
            const float nudge = i % 3 == 0 ? 0.0F : random.log_uniform(-26.0, -20.0);
            const float radius = 0.5F + nudge;
            solids.spheres.push_back({{at.x, at.y + nudge, at.z}, radius});
            solids.boxes.push_back(
                {{at.x - 0.45F, at.y - 0.45F, at.z - 0.45F - nudge}, {at.x + 0.45F, at.y + 0.45F, at.z + 0.45F}});
            // a fan around a common corner, and copies of one triangle
            const float angle = static_cast<float>(i) * 0.785398F;
            const Vec3f a = {at.x + std::cos(angle), at.y + std::sin(angle), at.z};
            const Vec3f b = {at.x + std::cos(angle + 0.785398F), at.y + std::sin(angle + 0.785398F), at.z + nudge};
            faces.triangles.push_back({at, a, b});
            faces.triangles.push_back({{at.x, at.y, at.z + 1}, {at.x + 1, at.y, at.z + 1}, {at.x, at.y + 1, at.z + 1}});
            faces.quads.push_back({at, a, {at.x, at.y, at.z + 1}, {at.x - 1, at.y, at.z}});
            if (i % 2 == 0) faces.quads.back().attributes.sides = FaceSides::culled;
            if (i % 3 == 0) faces.triangles.back().attributes.sides = FaceSides::culled;
        }
    }
    for (PreparedScene* scene : {&solids, &faces}) {
        scene->material_of.assign(primitive_count(view(*scene)), 0);
        scene->materials.emplace_back();
    }
    return bundles;
}

/// Rays at the common corners, and at sides, and as make_rays().
[[nodiscard]] inline std::vector<Ray<float>> rays_at_bundles(const PreparedScene& scene, std::size_t count,
                                                             std::uint64_t seed) {
    Random random(seed);
    std::vector<Ray<float>> rays = make_rays(scene, count, seed);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t id = random.below(primitive_count(view(scene)));
        const Aabb box = primitive_bounds(view(scene), id);
        const Vec3f target = id < scene.triangles.size() && i % 2 == 0 ? scene.triangles[id].v0 : box.upper;
        const Vec3f origin = {random.uniform(-30.0F, 30.0F), random.uniform(-30.0F, 30.0F), 20};
        rays.push_back({origin, target - origin});
    }
    return rays;
}

}  // namespace tandem::test
