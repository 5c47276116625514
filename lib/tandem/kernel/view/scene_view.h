/// A prepared scene as kernels read it, on the CPU and on the GPU.
#pragma once

#include "tandem/kernel/bsdf/material_parts.h"
#include "tandem/kernel/bsdf/optics.h"
#include "tandem/kernel/bsdf/phong.h"
#include "tandem/kernel/camera/camera.h"
#include "tandem/kernel/lights/area_light.h"
#include "tandem/kernel/lights/environment.h"
#include "tandem/kernel/lights/punctual_light.h"
#include "tandem/kernel/shapes/affine.h"
#include "tandem/kernel/shapes/quad.h"
#include "tandem/kernel/texture/anisotropy.h"
#include "tandem/kernel/texture/texture_set.h"
#include "tandem/kernel/view/instances.h"
#include "tandem/math/whole.h"

#define TANDEM_ENVIRONMENT_HEADERS
#include "tandem/kernel/lights/lights.def"

namespace tandem {

/// The media that the camera is inside of, by material, in the order of entering them.
struct CameraMedia {
    std::uint32_t count;
    std::uint32_t material[8];
};

/// Pointers are to memory of the side that reads them. Ids as in PreparedScene.
struct SceneView {
#define TANDEM_SCENE_ARRAY(Type, names) const Type* names;
#include "tandem/kernel/view/scene_arrays.def"
    TextureSet textures;
#define TANDEM_COUNTED_SCENE_ARRAY(Type, name, names) std::uint32_t name##_count;
#include "tandem/kernel/view/scene_arrays.def"
    std::uint32_t area_light_kinds;  ///< PrimitiveKinds
    std::uint32_t area_lights_cast_shadows;
    std::uint32_t several_slots;   ///< 0: materials read no vertex colours, and only the texture coordinates of slot 0
    std::uint32_t cutout_kinds;    ///< PrimitiveKinds with alpha masks or culled faces
    std::uint32_t masked_kinds;    ///< PrimitiveKinds with alpha masks
    std::uint32_t indirect_light;  ///< 1: diffuse surfaces receive light from other surfaces
    std::uint32_t roulette_from;   ///< vertex of a path at which Russian roulette starts
    std::uint32_t media_overlap;   ///< 0: dielectric solids neither overlap nor touch other primitives
    CameraMedia camera_media;
    Environment environment;
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) Type name;
#include "tandem/kernel/lights/lights.def"
};

/// A scene with meshes that are kept once. The ids of their faces follow those of all other primitives. A type of its
/// own, so that kernels of other scenes contain no code for instances.
struct InstancedView : SceneView {
    const MeshInstance* instances;
    const InstancedMesh* meshes;  ///< in the order of their ids
    const Triangle* faces;        ///< in object space; `normals` of their attributes is an index into mesh_normals
    const Vec3f* mesh_normals;    ///< at corners, in object space
    std::uint32_t mesh_count;
    std::uint32_t first_instanced_id;
};

/// Whether a kind of environment takes the place of the gradient.
TANDEM_HD_INLINE bool has_environment(const SceneView& scene) {
    bool has = false;
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) has = has || is_there(scene.name);
#include "tandem/kernel/lights/lights.def"
    return has;
}

TANDEM_HD_INLINE std::uint32_t primitive_count(const SceneView& scene) {
    std::uint32_t count = 0;
#define TANDEM_PRIMITIVE(Type, name, names) count += scene.name##_count;
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    return count;
}

/// Whether a material has optional parts.
TANDEM_HD_INLINE bool has_material_parts(const SceneView& scene) {
    std::uint32_t count = 0;
#define TANDEM_MATERIAL_PART(Type, name, names, needs, is) count += scene.names##_count;
#include "tandem/kernel/bsdf/lobes.def"
    return count > 0;
}

/// Sets of kinds of primitives, as bits. A tracer for some kinds has no code for the others.
struct PrimitiveKinds {
    enum Place {
#define TANDEM_PRIMITIVE(Type, name, names) name##_place,
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    };
#define TANDEM_PRIMITIVE(Type, name, names) static constexpr std::uint32_t name = 1U << name##_place;
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    static constexpr std::uint32_t all = 0U
#define TANDEM_PRIMITIVE(Type, name, names) | name
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
        ;
    /// Triangles of an InstancedView. None of `all`, because only tracers for such scenes find them.
    static constexpr std::uint32_t instanced = 1U << 31;
    static constexpr std::uint32_t faces = triangle | quad;
    static constexpr std::uint32_t bodies = all & ~faces;
};

/// The bit of a type of primitive.
template <class Primitive>
inline constexpr std::uint32_t kind_of = 0;
#define TANDEM_PRIMITIVE(Type, name, names) \
    template <>                             \
    inline constexpr std::uint32_t kind_of<Type> = PrimitiveKinds::name;
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE

TANDEM_HD_INLINE bool has_faces(const SceneView& scene) { return scene.triangle_count + scene.quad_count > 0; }

/// Whether a kernel gets the facts of its scene when it is linked (cuda/linked_facts.h).
#ifdef TANDEM_LINKED_KINDS
inline constexpr bool is_linked = true;
#else
inline constexpr bool is_linked = false;
#endif

/// Whether a scene can have primitives of one of these kinds.
TANDEM_HD_INLINE bool may_have(std::uint32_t kinds) {
#if defined(TANDEM_LINKED_KINDS) && TANDEM_ON_DEVICE
    return (TANDEM_LINKED_KINDS & kinds) != 0;
#else
    return kinds != 0;
#endif
}

/// Whether a material can read vertex colours, or texture coordinates of another slot than 0.
TANDEM_HD_INLINE bool may_have_several_slots() {
#if defined(TANDEM_LINKED_SEVERAL_SLOTS) && TANDEM_ON_DEVICE
    return TANDEM_LINKED_SEVERAL_SLOTS != 0;
#else
    return true;
#endif
}

/// Whether primitives of one of these kinds can have alpha masks or culled faces.
TANDEM_HD_INLINE bool may_be_cut_out(std::uint32_t kinds) {
#if defined(TANDEM_LINKED_CUTOUT_KINDS) && TANDEM_ON_DEVICE
    return (TANDEM_LINKED_CUTOUT_KINDS & kinds) != 0;
#else
    return kinds != 0;
#endif
}

/// Whether the scene has neither alpha masks nor culled faces. Not for linked kernels: see may_be_cut_out().
TANDEM_HD_INLINE bool has_no_cutouts(const SceneView& scene) { return scene.cutout_kinds == 0; }

/// Whether the scene has no alpha masks.
TANDEM_HD_INLINE bool has_no_masks(const SceneView& scene) {
#if defined(TANDEM_LINKED_MASKED_KINDS) && TANDEM_ON_DEVICE
    return TANDEM_LINKED_MASKED_KINDS == 0 || (TANDEM_LINKED_ANY_SCENE && scene.masked_kinds == 0);
#else
    return scene.masked_kinds == 0;
#endif
}

/// Whether an area light can be of one of these kinds.
TANDEM_HD_INLINE bool may_emit_light(std::uint32_t kinds) {
#if defined(TANDEM_LINKED_LIGHT_KINDS) && TANDEM_ON_DEVICE
    return (TANDEM_LINKED_LIGHT_KINDS & kinds) != 0;
#else
    return kinds != 0;
#endif
}

/// What a linked kernel knows about the number of area lights.
enum class KnownAreaLights : std::uint32_t { unknown, one, several };
TANDEM_HD_INLINE KnownAreaLights known_area_lights() {
#if defined(TANDEM_LINKED_AREA_LIGHTS) && TANDEM_ON_DEVICE
    return static_cast<KnownAreaLights>(TANDEM_LINKED_AREA_LIGHTS);
#else
    return KnownAreaLights::unknown;
#endif
}

/// Whether primitive `id` is a face of an instanced mesh. Then `scene` is an InstancedView.
template <std::uint32_t kinds>
TANDEM_HD_INLINE bool is_instanced(const SceneView& scene, std::uint32_t id) {
    if constexpr ((kinds & PrimitiveKinds::instanced) == 0) return false;
    return may_have(PrimitiveKinds::instanced) && id >= static_cast<const InstancedView&>(scene).first_instanced_id;
}

/// A face of an instanced mesh, as it is in the mesh, and its instance.
struct InstancedFace {
    const MeshInstance& instance;
    const Triangle& face;
    std::uint32_t material;
};

/// Needs is_instanced().
TANDEM_HD_INLINE InstancedFace instanced_face(const SceneView& scene, std::uint32_t id) {
    const auto& view = static_cast<const InstancedView&>(scene);
    std::uint32_t first = 0, end = view.mesh_count;
    while (end - first > 1) {
        const std::uint32_t middle = (first + end) / 2;
        (id < view.meshes[middle].first_id ? end : first) = middle;
    }
    const InstancedMesh& mesh = view.meshes[first];
    const std::uint32_t within = id - mesh.first_id, instance = within / mesh.face_count;
    return {view.instances[mesh.first_instance + instance],
            view.faces[mesh.first_face + (within - instance * mesh.face_count)], mesh.material};
}

/// The face in render space. Its index of normals remains that of the mesh.
TANDEM_HD_INLINE Triangle placed(const InstancedFace& at) {
    const Transform& place = at.instance.render_from_object;
    return {place_corner(place, at.face.v0), place_corner(place, at.face.v1), place_corner(place, at.face.v2),
            at.face.attributes};
}

/// The material of primitive `id`.
template <std::uint32_t kinds = PrimitiveKinds::all>
TANDEM_HD_INLINE std::uint32_t material_of(const SceneView& scene, std::uint32_t id) {
    if (is_instanced<kinds>(scene, id)) return instanced_face(scene, id).material;
    return scene.material_of[id];
}

/// Whether a material has an alpha mask.
TANDEM_HD_INLINE bool has_alpha_mask(const SceneView& scene, std::uint32_t material) {
    return has_textures(scene.textures) && scene.textures.materials[material].alpha_cutoff > 0.0F;
}

/// Whether primitive `id` may let shadow rays pass, as the light of one or by an alpha mask.
template <std::uint32_t kinds>
TANDEM_HD_INLINE bool may_let_pass(const SceneView& scene, std::uint32_t id, bool is_light) {
    return is_light || has_alpha_mask(scene, material_of<kinds>(scene, id));
}

/// Calls visitor(primitive) with primitive `id`, of its own type; `kinds`: the ones that the scene may have.
template <std::uint32_t kinds = PrimitiveKinds::all, class Visitor>
TANDEM_HD_INLINE void visit_primitive(const SceneView& scene, std::uint32_t id, Visitor visitor) {
    if (is_instanced<kinds>(scene, id)) return visitor(placed(instanced_face(scene, id)));
        // the last possible kind needs no comparison
#define TANDEM_PRIMITIVE(Type, name, names)                                                          \
    if constexpr ((kinds & PrimitiveKinds::name) != 0) {                                             \
        constexpr std::uint32_t later = kinds & ~(2 * PrimitiveKinds::name - 1);                     \
        if (may_have(PrimitiveKinds::name)) {                                                        \
            if (!may_have(later) || id < scene.name##_count) return visitor(whole(scene.names[id])); \
            id -= scene.name##_count;                                                                \
        }                                                                                            \
    }
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
}

/// World-space bounds of primitive `id`, not padded.
TANDEM_HD_INLINE Aabb primitive_bounds(const SceneView& scene, std::uint32_t id) {
    Aabb result;
    visit_primitive(scene, id, [&](const auto& primitive) { result = bounds(primitive); });
    return result;
}

}  // namespace tandem
