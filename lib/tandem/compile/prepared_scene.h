/// The scene at one instant, as the kernels read it: flat arrays of plain structs and indices, no pointers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tandem/compile/copies.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_instances.h"
#include "tandem/compile/prepared_textures.h"
#include "tandem/kernel/bsdf/phong.h"
#include "tandem/kernel/camera/camera.h"
#include "tandem/kernel/camera/lens.h"
#include "tandem/kernel/camera/shutter.h"
#include "tandem/kernel/lights/environment.h"
#include "tandem/kernel/lights/punctual_light.h"
#include "tandem/kernel/shapes/affine.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// The camera, independent of the size of a film; camera_view() sets it up for one.
struct PreparedCamera {
    Transform render_from_camera;
    bool orthographic = false;
    Lens lens{};
    double half_height = 1;  ///< tan(yfov / 2), or ymag for an orthographic camera
};

/// All coordinates are in render space: world space translated so that `origin` becomes zero, where float is precise
/// (compile/render_origin.h). The axes are those of the world.
///
/// Primitive ids run over the arrays spheres, boxes, ... in the order of primitives.def. Within a kind they follow the
/// order of nodes, geometries, instances and faces in the Scene.
struct PreparedScene {
    static constexpr std::uint32_t never = 0xFFFFFFFFU;

#define TANDEM_SCENE_ARRAY(Type, names) std::vector<Type> names;
#include "tandem/kernel/view/scene_arrays.def"
    PreparedTextures textures;
    /// Meshes that are kept once. The ids of their faces follow those of the arrays above, in the order of meshes,
    /// instances and faces; material_of and node_of do not have them. Empty in most scenes.
    PreparedInstances instances;
    std::vector<std::uint32_t> node_of;  ///< by primitive id: index into Scene::nodes, for messages
    std::vector<PrimitiveCopy> copies;   ///< primitives that are not traced, because they are copies
    std::uint32_t area_light_kinds = 0;  ///< PrimitiveKinds of area_lights
    bool area_light_shadows = true;
    bool several_slots = false;           ///< a material reads vertex colours, or another slot than 0
    std::uint32_t cutout_kinds = 0;       ///< PrimitiveKinds with alpha masks or culled faces
    std::uint32_t masked_kinds = 0;       ///< PrimitiveKinds with alpha masks
    std::uint32_t culled_node = never;    ///< the first node with culled faces
    std::uint32_t roulette_from = never;  ///< vertex of a path
    CameraMedia camera_media{};
    bool media_overlap = false;  ///< dielectric solids may overlap, or touch, other primitives
    Environment environment;
    bool indirect_light = false;  ///< diffuse surfaces receive light from other surfaces
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) Type name{};
#include "tandem/kernel/lights/lights.def"
    EffectMask effects;  ///< the effects to simulate: those that the scene needs, and those forced on
    /// Primitives of the Scene that no ray can hit: degenerate faces, solids that their transforms hide (scale 0), and
    /// primitives that their alpha mask removes completely.
    std::uint64_t dropped_primitives = 0;
    std::uint64_t dropped_lights = 0;  ///< spot and directional lights without a direction because of a scale of 0

    Vec3d origin{0, 0, 0};  ///< of render space, in world space, metres

    PreparedCamera camera;

    // the instant, and what determines motion blur: for derive_effects()
    double time = 0;              ///< seconds, of the animation
    std::size_t camera_node = 0;  ///< index into Scene::nodes
    Shutter shutter{};            ///< closed for an instant of a frame
};

/// Of the arrays; without the faces of instanced meshes.
[[nodiscard]] std::size_t primitive_count(const PreparedScene& scene);

/// The kernels' view of the arrays of `scene`, which must outlive it.
[[nodiscard]] SceneView view(const PreparedScene& scene);

/// The camera for a film of width x height square pixels. All its rays are traceable and their directions have at least
/// length 1, up to `reach` pixels outside the film. Throws InputError if an orthographic camera shows points beyond
/// coordinate_limit.
[[nodiscard]] CameraView camera_view(const PreparedCamera& camera, int width, int height, double reach = 0);

/// prepare_shared() by value, for code that reads the arrays.
[[nodiscard]] PreparedScene prepare(const Scene& scene, const PrepareOptions& options = {});

}  // namespace tandem
