/// The scenes of the accuracy report: files, named scenes, and scenes whose image is known.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/arguments.h"
#include "tandem/images/image.h"
#include "tandem/kernel/path_limits.h"
#include "tandem/scene/scene.h"

namespace tandem::bench {

struct AccuracyScene {
    std::string name;  ///< as on the command line
    Scene scene;
    std::optional<Vec3f> truth;  ///< the radiance of every pixel, where it has a closed form
    std::string closed_form;     ///< in words; empty without one
};

/// What load_scene() takes, and scenes with a closed form:
///   closed:furnace/PERCENT  the inside of a diffuse, emissive room that reflects that much, 1 to 99: e / (1 - r)
///   closed:glass            clear glass in uniform light, which nobody can see
/// Throws InputError.
[[nodiscard]] AccuracyScene load_accuracy_scene(const std::string& name, const FilmSize& size);

/// A scene of the fixed list, chosen before anything was measured.
struct ListedScene {
    const char* axis;
    const char* difficulty;  ///< "easy" or "hard"
    const char* scene;       ///< paths are relative to the repository
    const char* why;
};

/// At least one easy and one hard scene for each axis that the report varies.
[[nodiscard]] const std::vector<ListedScene>& listed_scenes();

/// Real files of other people, which are not part of the repository, may lie beside it.
[[nodiscard]] bool is_beside_the_repository(const ListedScene& listed);

/// The scenes of the list, each once, but for files beside the repository that are not there.
[[nodiscard]] std::vector<std::string> listed_scene_names();

/// The scene with every sphere as a mesh of 20 * 4^level triangles whose vertices are on the sphere, with its normals.
/// Empty if the scene has no sphere, or one whose material needs the parametrisation of spheres (textures, anisotropy).
[[nodiscard]] std::optional<Scene> tessellated_twin(const Scene& scene, int level);

/// 20 * 4^level.
[[nodiscard]] int triangles_per_sphere(int level);

}  // namespace tandem::bench
