/// Which hits need the same code to be shaded, so that they can be shaded together (cuda/hit_classes.h). Only for
/// speed. Tested by tests/kernel/shading_class_test.cpp.
#pragma once

#include <cstdint>

#include "tandem/kernel/view/scene_view.h"

namespace tandem {

namespace shading_class_detail {

/// A word whose bits say what is there, the last one first.
class Bits {
  public:
    TANDEM_HD_INLINE void add(bool is) { word_ = word_ << 1 | (is ? 1U : 0U); }
    [[nodiscard]] TANDEM_HD_INLINE std::uint32_t word() const { return word_; }

  private:
    std::uint32_t word_ = 0;
};

}  // namespace shading_class_detail

/// Equal for materials with the same lobes, parts and textures, whatever their numbers and pictures are.
TANDEM_HD_INLINE std::uint32_t material_class(const SceneView& scene, std::uint32_t number) {
    const PhongMaterial& material = scene.materials[number];
    const Optics& optics = scene.optics[number];
    shading_class_detail::Bits bits;
    bits.add(norm1(material.diffuse) + norm1(material.specular) > 0.0F);
    bits.add(norm1(optics.mirror) > 0.0F);
    bits.add(optics.transmission > 0.0F);
    bits.add(norm1(optics.emission) > 0.0F);
    bits.add(optics.unlit != 0);
#define TANDEM_MATERIAL_PART(Type, name, names, needs, is) \
    bits.add(scene.names##_count > 0 && scene.names[number].is_there != 0);
#include "tandem/kernel/bsdf/lobes.def"
    if (has_textures(scene.textures)) {
        const MaterialTextures& textures = scene.textures.materials[number];
        bits.add(textures.diffuse.texture != no_texture);
        bits.add(textures.normal.texture != no_texture);
        bits.add(textures.emission.texture != no_texture);
        bits.add(textures.metallic_roughness.texture != no_texture);
        bits.add(textures.alpha_cutoff > 0.0F);
    }
    return bits.word();
}

/// How many kinds of primitives the scene may have, without instanced triangles.
template <std::uint32_t kinds>
TANDEM_HD_INLINE std::uint32_t kind_count() {
    std::uint32_t count = 0;
#define TANDEM_PRIMITIVE(Type, name, names) \
    count += (kinds & PrimitiveKinds::name) != 0 && may_have(PrimitiveKinds::name) ? 1U : 0U;
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    return count;
}

/// The number of a primitive's kind among these.
template <std::uint32_t kinds>
TANDEM_HD_INLINE std::uint32_t kind_number(const SceneView& scene, std::uint32_t id) {
    std::uint32_t number = 0;
#define TANDEM_PRIMITIVE(Type, name, names)                                      \
    if ((kinds & PrimitiveKinds::name) != 0 && may_have(PrimitiveKinds::name)) { \
        if (id < scene.name##_count) return number;                              \
        id -= scene.name##_count;                                                \
        ++number;                                                                \
    }
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    return number;
}

}  // namespace tandem
