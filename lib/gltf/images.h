/// The pictures of a glTF file.
#pragma once

#include "tandem/gltf/model.h"
#include "tandem/scene/texture.h"

namespace tandem::gltf {

/// Decodes image `index`: a PNG or JPEG beside the glTF file (uris.h), in a data URI, or in a buffer view. Throws
/// InputError with the JSON path if there is none, or none that can be read.
[[nodiscard]] Image read_image(const Source& source, std::size_t index);

}  // namespace tandem::gltf
