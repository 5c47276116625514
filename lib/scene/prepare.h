/// From the author's scene to flat arrays at one frame.
#pragma once

#include <optional>
#include <string>

#include "tandem/effects/names.h"
#include "tandem/scene/prepared_scene.h"
#include "tandem/scene/scene.h"

namespace tandem {

struct PrepareOptions {
    std::int32_t frame = 0;
    std::string camera{};           ///< name of the camera's node; empty means the first camera of the scene
    std::optional<Vec3d> origin{};  ///< of render space, in world space; empty: chosen for precision (RenderOrigin)
    ForcedEffects effects{};        ///< simulated in any case, or not even if the scene calls for them
};

/// Deterministic: the same scene gives the same bytes. Transforms are composed in double, moved to the origin of render
/// space in double, and rounded once.
/// Spheres under rotation and uniform scale stay spheres, boxes under diagonal transforms stay boxes; the others
/// become ellipsoids and parallelepipeds. So do those with a texture that are turned or mirrored, since a sphere and a
/// box do not know of it; prepare_textures() says what is a texture. Meshes become triangles and quads (place_mesh.h).
/// Throws InputError with the list of validate() if that is not empty, and if the camera is missing.
[[nodiscard]] PreparedScene prepare(const Scene& scene, const PrepareOptions& options = {});

}  // namespace tandem
