/// Support of extensions, by name.
#pragma once

#include <string>
#include <string_view>

namespace tandem::gltf {

/// Whether Tandem renders an extension, so that a file may require it.
[[nodiscard]] bool is_rendered_extension(std::string_view name);

/// Why an extension is ignored, for the report.
[[nodiscard]] std::string why_ignored(std::string_view name);

}  // namespace tandem::gltf
