/// Numbers out of buffers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tandem/gltf/buffers.h"

namespace tandem::gltf {

/// Components that a reader accepts.
enum class Components {
    floats,
    normalised,  ///< floats, or normalised bytes and shorts
    quantised,   ///< floats, or bytes and shorts, normalised or not (KHR_mesh_quantization)
    indices,     ///< unsigned integers
};

/// What a reader accepts of an accessor.
struct AccessorNeed {
    std::string type;  ///< "SCALAR", "VEC2", "VEC3", "VEC4"
    Components components = Components::normalised;
    std::string for_what;   ///< "the keys of an animation"
    std::string used_at;    ///< JSON path of the index that names the accessor
    bool is_finite = true;  ///< whether a number that is not finite is a flaw
    /// The elements to read; null for all of them. Each is below element_count().
    const std::vector<std::uint32_t>* elements = nullptr;
};

/// How many elements an accessor says that it has, without a look at them.
[[nodiscard]] std::size_t element_count(const Source& source, std::size_t index);

/// Are its components of that kind?
[[nodiscard]] bool has_components(const Source& source, std::size_t index, Components components);

/// The largest number that indices of its type can be.
[[nodiscard]] std::uint32_t largest_index(const Source& source, std::size_t index);

/// The elements of an accessor, one number after the other. Floats as they are, normalised integers as glTF 2.0, 3.11
/// turns them into floats; sparse replacements applied; zeros where there is no buffer view.
/// Throws a Flaw if the accessor is of another type, or holds a number that is not finite.
[[nodiscard]] std::vector<float> read_accessor(const Source& source, std::size_t index, const AccessorNeed& need);

/// The same for the indices of a mesh primitive.
[[nodiscard]] std::vector<std::uint32_t> read_indices(const Source& source, std::size_t index,
                                                      const std::string& used_at);

}  // namespace tandem::gltf
