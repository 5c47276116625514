#include "tandem/scene/load_scene.h"

#include <string_view>
#include <utility>

#include "tandem/gltf/import.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {

Scene load_scene(const std::string& specification, ImportReport* report) {
    constexpr std::string_view prefix = "named:";
    ImportResult result;
    if (specification.starts_with(prefix)) {
        result.scene = named_scene(std::string_view(specification).substr(prefix.size()));
    } else {
        result = import_gltf(specification);
    }
    if (report != nullptr) *report = std::move(result.report);
    return std::move(result.scene);
}

}  // namespace tandem
