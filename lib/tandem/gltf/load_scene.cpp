#include "tandem/gltf/load_scene.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/gltf/import.h"
#include "tandem/math/fp_environment.h"
#include "tandem/scene/camera_node.h"
#include "tandem/scene/default_light.h"
#include "tandem/scene/framing.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {

namespace {

/// Finds the requested camera; adds it if it is a view.
std::size_t take_camera(ImportResult& file, const LoadOptions& options) {
    Scene& scene = file.scene;
    if (const auto found = find_camera(scene, options.camera)) return *found;
    const std::string view = options.camera.empty() ? "auto" : options.camera;
    if (!is_view(view)) {
        throw InputError(fmt::format("the scene has no camera '{}'; it has {}, and can be seen from any of {}", view,
                                     camera_names(scene), view_names()));
    }
    const bool has_none = !find_camera(scene, "");
    Framing framing = frame_scene(scene, view, options.aspect);
    scene.nodes.push_back(std::move(framing.node));
    if (has_none) {
        const char* moment = scene.animation.empty() ? "" : ", as the scene is at frame 0";
        file.report.add(Treatment::approximated, "no camera", file.scene_path,
                        fmt::format("framed {}{}; --camera selects another view", framing.description, moment));
    }
    if (framing.is_empty) {
        file.report.add(Treatment::approximated, "no surfaces", file.scene_path, "the image shows only the background");
    }
    return scene.nodes.size() - 1;
}

}  // namespace

Scene load_scene(const std::string& specification, ImportReport* report, const LoadOptions& options) {
    const DefaultFpEnvironment guard;
    constexpr std::string_view prefix = "named:";
    ImportResult result;
    const bool is_file = !specification.starts_with(prefix);
    if (is_file) {
        result = import_gltf(specification);
    } else {
        result.scene = named_scene(std::string_view(specification).substr(prefix.size()));
    }
    const std::size_t camera = take_camera(result, options);
    if (is_file && options.default_light && !result.has_environment && !has_light(result.scene)) {
        add_default_light(result.scene, camera);
        result.report.add(
            Treatment::approximated, "no light", result.scene_path,
            "lit by a uniform background and a light from the upper left of the camera; --light none leaves it dark");
    }
    if (report != nullptr) *report = std::move(result.report);
    return std::move(result.scene);
}

}  // namespace tandem
