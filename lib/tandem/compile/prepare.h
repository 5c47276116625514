/// Prepares an authored scene: flat arrays at one instant.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "tandem/compile/render_settings.h"
#include "tandem/effects/names.h"
#include "tandem/scene/scene.h"

namespace tandem {

struct PreparedScene;  // its arrays: prepared_scene.h

struct PrepareOptions {
    std::int32_t frame = 0;
    std::string camera{};           ///< name of the camera's node; empty means the first camera of the scene
    std::optional<Vec3d> origin{};  ///< of render space, in world space; empty: chosen for precision (RenderOrigin)
    ForcedEffects effects{};        ///< forced on, or forced off even if the scene needs them
    std::optional<double> time{};   ///< seconds: an instant instead of the frame's time, with the shutter closed
    RenderSettings settings{};
    /// Meshes that appear many times are kept once if together they have at least this many faces (docs/instances.md).
    std::uint64_t instanced_from = 2'000'000;
};

/// Throws InputError with the problems that validate() finds, if there are any.
void check(const Scene& scene);

/// Deterministic: the same scene gives the same bytes. Transforms are composed in double, moved to the origin of render
/// space in double, and rounded once.
///
/// Spheres under rotation and uniform scale stay spheres, and boxes under diagonal transforms stay boxes; the others
/// become ellipsoids and parallelepipeds. So do textured ones that are rotated or mirrored, since a sphere and a box
/// have no orientation; prepare_textures() decides what is a texture. Meshes become triangles and quads (place_mesh.h).
///
/// The result is one instant: a frame with motion blur combines several (render/motion_blur.h). Their times are not
/// rounded, unlike that of a frame.
/// Throws InputError as check() does, and if the camera is missing; EnvironmentError if the memory cannot hold the
/// scene.
[[nodiscard]] std::shared_ptr<const PreparedScene> prepare_shared(const Scene& scene,
                                                                  const PrepareOptions& options = {});

/// Points from world space to render space, which is world space translated, and back. Directions, normals and t are
/// the same in both. Metres.
[[nodiscard]] Vec3d render_from_world(const PreparedScene& scene, const Vec3d& world);
[[nodiscard]] Vec3d world_from_render(const PreparedScene& scene, const Vec3d& render);

/// What a primitive was made from.
struct PrimitiveOwner {
    std::uint32_t node;      ///< index into Scene::nodes
    std::uint32_t material;  ///< index into Scene::materials
};
/// Of the primitive with the id that a Hit or the plane `primitive` of a film has. Throws InputError if there is none.
[[nodiscard]] PrimitiveOwner owner_of(const PreparedScene& scene, std::uint32_t primitive);

/// SHA-256, in hexadecimal, of what determines the image: equal hashes mean equal images. A frame with motion blur has
/// its own hash (render/motion_blur.h).
[[nodiscard]] std::string scene_hash(const PreparedScene& scene);

}  // namespace tandem
