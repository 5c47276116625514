/// What Tandem makes of extensions, by name.
#pragma once

#include <string>
#include <string_view>

namespace tandem::gltf {

/// Whether Tandem renders what an extension says, so that a file may require it.
[[nodiscard]] bool is_rendered_extension(std::string_view name);

/// Why an extension that is not rendered is ignored, for the report.
[[nodiscard]] std::string why_ignored(std::string_view name);

}  // namespace tandem::gltf
