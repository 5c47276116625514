/// Loads a scene by file or name.
#pragma once

#include <string>

#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// Defaults for what an image needs and a file may lack.
struct LoadOptions {
    std::string camera{};       ///< name of a camera's node or, if no camera has it, of a view (scene/framing.h)
    double aspect = 1;          ///< width over height of the film for which a view is framed
    bool default_light = true;  ///< light files without light (scene/default_light.h)
};

/// `specification` is "named:NAME" (named_scenes.h) or the path of a .gltf or .glb file (gltf/import.h). Throws
/// InputError. `report` receives what Tandem approximates or ignores in a file; it stays empty for a named scene.
///
/// A scene without a camera gets one that frames it from the front, at a node "auto" after the others. If a view is
/// requested, its camera is added at a node with the view's name, so that prepare() finds it by the name in the
/// options. A file without light and without TANDEM_environment gets lights. The report says so. import_gltf() returns
/// a file without these additions.
[[nodiscard]] Scene load_scene(const std::string& specification, ImportReport* report = nullptr,
                               const LoadOptions& options = {});

}  // namespace tandem
