/// Where a scene comes from, and the options that change it: what an image must say so that it can be drawn again.
#pragma once

#include <cstddef>
#include <string>

#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem {

struct SceneSource {
    std::string scene{};        ///< glTF file or "named:NAME", as the user wrote it
    std::string camera{};       ///< empty: the first of the scene
    std::string environment{};  ///< a picture; empty: the background of the scene
    double rotation = 0;        ///< of that picture, degrees
    float intensity = 1;        ///< of that picture
    bool default_light = true;  ///< light a file without lights
    bool indirect = false;      ///< indirect light in place of ambient light
    int instants = 0;           ///< of the shutter; 0: as the cameras say

    bool operator==(const SceneSource&) const = default;
};

struct OpenedScene {
    Scene scene;
    ImportReport import;
    std::size_t negative_texels = 0;  ///< of the environment's picture, which became 0
};

/// Loads the scene and applies the options. `aspect`: width over height of the film. Throws InputError.
[[nodiscard]] OpenedScene open_scene(const SceneSource& source, double aspect);

/// One line of ASCII: a JSON object with the members that are not the default.
[[nodiscard]] std::string to_json(const SceneSource& source);

/// Parses the same; unknown members are ignored. Throws InputError.
[[nodiscard]] SceneSource scene_source_from(const std::string& json);

}  // namespace tandem
