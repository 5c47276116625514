/// The scene at one instant, as the kernels read it: flat arrays of plain structs and indices, no pointers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tandem/compile/copies.h"
#include "tandem/compile/prepared_textures.h"
#include "tandem/kernel/bsdf/phong.h"
#include "tandem/kernel/camera/camera.h"
#include "tandem/kernel/camera/lens.h"
#include "tandem/kernel/camera/shutter.h"
#include "tandem/kernel/lights/environment.h"
#include "tandem/kernel/lights/environment_picture.h"
#include "tandem/kernel/lights/punctual_light.h"
#include "tandem/kernel/shapes/affine.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// Where the camera stands, without the size of a film; camera_view() sets it up for one.
struct PreparedCamera {
    Transform render_from_camera;
    bool orthographic = false;
    Lens lens{};
    double half_height = 1;  ///< tan(yfov / 2), or ymag for an orthographic camera
};

/// All coordinates are in render space: world space moved by `origin`, so that float is precise where the camera looks
/// (compile/render_origin.h). The axes are those of the world.
///
/// Primitive ids run over the arrays spheres, boxes, ... in the order of primitives.def. Within a kind they follow the
/// order of nodes, geometries, instances and faces in the Scene.
struct PreparedScene {
    static constexpr std::uint32_t never = 0xFFFFFFFFU;

#define TANDEM_SCENE_ARRAY(Type, names) std::vector<Type> names;
#include "tandem/kernel/view/scene_arrays.def"
    PreparedTextures textures;
    std::vector<std::uint32_t> node_of;  ///< by primitive id: index into Scene::nodes, for messages
    std::vector<PrimitiveCopy> copies;   ///< primitives that are not traced, because they equal another one
    std::uint32_t area_light_kinds = 0;  ///< PrimitiveKinds of area_lights
    bool area_light_shadows = true;
    bool several_slots = false;           ///< a material reads colours of corners, or another slot than 0
    std::uint32_t cutout_kinds = 0;       ///< PrimitiveKinds of those that are cut out by their alpha, or culled
    std::uint32_t culled_node = never;    ///< the first node whose faces are culled from behind
    std::uint32_t roulette_from = never;  ///< vertex of a path
    CameraMedia camera_media{};
    bool media_overlap = false;  ///< bodies of glass may lie within, or touch, something else
    Environment environment;
    bool indirect_light = false;  ///< diffuse surfaces receive light from other surfaces
    EnvironmentPicture environment_picture{};
    EffectMask effects;  ///< what kernels have to simulate: what the scene calls for, and what was forced on
    /// Of the Scene, because no ray hits them: faces without area, bodies that their transforms hide (scale 0), and
    /// what an alpha mask leaves nothing of.
    std::uint64_t dropped_primitives = 0;
    std::uint64_t dropped_lights = 0;  ///< spot and directional lights that a scale of 0 leaves without direction

    Vec3d origin{0, 0, 0};  ///< of render space, in world space, metres

    PreparedCamera camera;

    // when this is, and what the camera would see of motion: for derive_effects()
    double time = 0;              ///< seconds, of the animation
    std::size_t camera_node = 0;  ///< index into Scene::nodes
    Shutter shutter{};            ///< closed for an instant of a frame
};

[[nodiscard]] std::size_t primitive_count(const PreparedScene& scene);

/// Points between the two spaces; directions, normals and t are the same in both.
[[nodiscard]] inline Vec3d render_from_world(const PreparedScene& scene, const Vec3d& world) {
    return world - scene.origin;
}
[[nodiscard]] inline Vec3d world_from_render(const PreparedScene& scene, const Vec3d& render) {
    return render + scene.origin;
}

/// The window of the kernels onto the arrays of `scene`, which must outlive it.
[[nodiscard]] SceneView view(const PreparedScene& scene);

/// The camera for a film of width x height pixels; pixels are square. All its rays are traceable and
/// have directions at least 1 long. Throws InputError if an orthographic one shows points beyond coordinate_limit.
[[nodiscard]] CameraView camera_view(const PreparedCamera& camera, int width, int height);

/// SHA-256 over everything above that makes the picture, in hexadecimal: equal hashes mean equal pictures. Not over
/// node_of and the numbers of what was dropped, which serve messages, nor over copies, which follow from the rest, nor
/// over origin, effects, time and shutter: a frame with motion blur has a hash of its own (render/motion_blur.h).
[[nodiscard]] std::string scene_hash(const PreparedScene& scene);

}  // namespace tandem
