/// Converts a material, with the values of its textures at a point, to the lobes of a surface.
#pragma once

#include "tandem/kernel/surface_lobes.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// How a surface reflects: its BSDF, and the reflectance of ambient light, ka of Phong's model.
template <class Real>
struct Reflectance {
    SurfaceLobes<Real> lobes;
    Vec3<Real> ambient;
};

/// That of a material at a point. `from_inside`: where the ray is inside the solid.
template <class Effects, class Real>
TANDEM_HD Reflectance<Real> reflectance_of(const SceneView& scene, std::uint32_t number, const MaterialPoint<Real>& at,
                                           const Mask<Real>& from_inside) {
    const MaterialTexels<Real>& texels = at.texels;
    const PhongMaterial& material = scene.materials[number];
    const Optics& optics = at.optics;
    Reflectance<Real> result;
    SurfaceLobes<Real>& lobes = result.lobes;
    clear<Effects>(lobes);
    result.ambient = broadcast<Real>(material.ambient);
    lobes.diffuse.reflectance = broadcast<Real>(material.diffuse);
    lobes.phong = {broadcast<Real>(material.specular), Real(material.shininess)};
    if (Effects::has(Effect::textures) && has_textures(scene.textures)) {
        const Vec3<Real> factor = {texels.base_colour.r, texels.base_colour.g, texels.base_colour.b};
        result.ambient = result.ambient * factor;
        lobes.diffuse.reflectance = lobes.diffuse.reflectance * factor;
    }

    // Optional parts
#define TANDEM_MATERIAL_PART(Type, name, names, needs, is)                                     \
    if (Effects::has(needs) && scene.names##_count > 0 && scene.names[number].is_there != 0) { \
        lobes.used.add(needs);                                                                 \
        apply<Effects>(scene.names[number], at, result);                                       \
    }
#include "tandem/kernel/bsdf/lobes.def"

    // Mirrors and clear solids: a dielectric takes its share of the light from the diffuse lobes, and there are no
    // highlights on the inside
    if (Effects::has(Effect::reflection)) {
        if (norm1(optics.mirror) > 0.0F) lobes.used.add(Effect::reflection);
        lobes.mirror.reflectance = broadcast<Real>(optics.mirror);
    }
    if (Effects::has(Effect::refraction) && optics.transmission > 0.0F) {
        lobes.used.add(Effect::refraction);
        lobes.dielectric.share = Real(optics.transmission);
        const Real scattered = Real(1.0F) - lobes.dielectric.share;
        result.ambient = result.ambient * scattered;
        lobes.diffuse.reflectance = lobes.diffuse.reflectance * scattered;
        if (Effects::has(Effect::microfacets) && lobes.used.has(Effect::microfacets)) {
            lobes.coated.base.reflectance = lobes.coated.base.reflectance * scattered;
        }
        lobes.phong.specular = select(from_inside, black<Real>(), lobes.phong.specular);
    }
    return result;
}

}  // namespace tandem
