#include "tandem/scene/load_scene.h"

#include <fmt/format.h>

#include "tandem/error/error.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {

Scene load_scene(const std::string& specification) {
    constexpr std::string_view named = "named:";
    if (specification.starts_with(named)) return named_scene(std::string_view(specification).substr(named.size()));
    throw InputError(fmt::format("'{}' is not a scene; write named: and a name", specification));
}

}  // namespace tandem
