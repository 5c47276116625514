/// A scene from what a user types.
#pragma once

#include <string>

#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// What an image needs and a file may lack.
struct LoadOptions {
    std::string camera{};       ///< name of a camera's node or, where no camera has it, of a view (scene/framing.h)
    double aspect = 1;          ///< width over height of the film for which a view is framed
    bool default_light = true;  ///< light files without light (scene/default_light.h)
};

/// `specification` is "named:NAME" (named_scenes.h) or the path of a .gltf or .glb file (gltf/import.h). Throws
/// InputError. The importer reports what a file uses and Tandem approximates or ignores: pass `report` to get it. A
/// named scene leaves the report empty.
///
/// A scene without a camera gets one that frames it from the front, at a node "auto" behind the others; so does one
/// from which a view is wanted, at a node of the view's name. So prepare() finds the camera by the name of the options.
/// A file without light and without TANDEM_environment gets light. The report says so. import_gltf() returns a file as
/// it is.
[[nodiscard]] Scene load_scene(const std::string& specification, ImportReport* report = nullptr,
                               const LoadOptions& options = {});

}  // namespace tandem
