// Faces with alpha masks and culled sides, shadow rays among them, and what blocks these, found in the simplest way.
#pragma once

#include <array>

#include "support/aim.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/shadow.h"
#include "tandem/kernel/traversal/intersect.h"

namespace tandem::test {

/// A few faces with any sides, some of them with a common edge, and a ball. All triangles have the same v0.
inline PreparedScene any_faces(Random& random, int count = 4) {
    PreparedScene scene;
    scene.spheres.push_back({any_point(random), 0.1F});
    const Vec3f corner = any_point(random), other = any_point(random);
    for (int i = 0; i < count; ++i) {
        const Vec3f b = random.coin() ? other : any_point(random);
        scene.triangles.push_back({corner, b, any_point(random)});
        scene.triangles.back().attributes.sides = random.coin() ? FaceSides::culled : FaceSides::single_sided;
        scene.quads.push_back({any_point(random), b, any_point(random), any_point(random)});
        scene.quads.back().attributes.sides = random.coin() ? FaceSides::culled : FaceSides::double_sided;
    }
    scene.material_of.assign(scene.spheres.size() + scene.triangles.size() + scene.quads.size(), 0);
    scene.materials.emplace_back();
    scene.cutout_kinds = PrimitiveKinds::faces;
    return scene;
}

/// A shadow ray among the primitives of any_faces(), often through the common corner.
template <class Real>
ShadowRay<Real> any_shadow_ray(const PreparedScene& scene, Random& random) {
    const auto count = static_cast<std::uint32_t>(scene.material_of.size());
    const Vec3f from = any_point(random);
    const Vec3f target = random.coin() ? scene.triangles[0].v0 : any_point(random);
    ShadowRay<Real> shadow;
    shadow.ray = {Vec3<Real>(from), Vec3<Real>((target - from) * random.uniform(0.5F, 2.0F))};
    shadow.source.primitive = random.coin() ? random.below(count) : no_primitive;
    shadow.source.light = random.coin() ? random.below(count) : no_primitive;
    shadow.active = is_traceable(shadow.ray);
    return shadow;
}

/// Materials without a mask (0), with one that is open everywhere (1), and with one that is opaque (2).
inline void add_masked_materials(PreparedScene& scene) {
    scene.materials.resize(3);
    scene.optics.resize(3);
    scene.textures.materials.resize(3);
    scene.textures.materials[1].alpha = 0.1F;
    for (std::size_t i = 1; i < 3; ++i) scene.textures.materials[i].alpha_cutoff = 0.5F;
    scene.masked_kinds = scene.cutout_kinds = PrimitiveKinds::all;
}
/// Gives each primitive one of them.
inline void mask_some(PreparedScene& scene, Random& random) {
    add_masked_materials(scene);
    for (std::uint32_t& material : scene.material_of) material = std::array{0U, 0U, 1U, 1U, 1U, 2U}[random.below(6)];
}

using CutoutEffects = EffectSet<(Effect::shadows | Effect::cutouts).bits()>;

/// Whether a shadow ray is blocked, by searches for the nearest hit, one after the other.
template <class Real>
bool is_blocked_one_by_one(const SceneView& scene, const ShadowRay<Real>& shadow) {
    return shadow_detail::is_blocked_one_by_one<CutoutEffects>(LoopTracer{scene}, scene, shadow);
}

}  // namespace tandem::test
