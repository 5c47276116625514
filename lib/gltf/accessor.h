/// Numbers out of buffers.
#pragma once

#include <string>
#include <vector>

#include "tandem/gltf/model.h"

namespace tandem::gltf {

/// What a reader accepts of an accessor.
struct AccessorNeed {
    std::string type;        ///< "SCALAR", "VEC3", "VEC4"
    bool normalised = true;  ///< whether normalised integers will do as well as floats
    std::string for_what;    ///< "the keys of an animation"
    std::string used_at;     ///< JSON path of the index that names the accessor
};

/// The elements of an accessor, one number after the other. Floats as they are, normalised integers as glTF 2.0, 3.11
/// turns them into floats; sparse replacements applied; zeros where there is no buffer view.
/// Throws InputError if the accessor is of another type, or holds a number that is not finite.
[[nodiscard]] std::vector<float> read_accessor(const Source& source, std::size_t index, const AccessorNeed& need);

}  // namespace tandem::gltf
