/// Reads accessors: numbers from buffers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tandem/gltf/buffers.h"

namespace tandem::gltf {

/// The component types that a reader accepts.
enum class Components {
    floats,
    normalised,  ///< floats, or normalised bytes and shorts
    quantised,   ///< floats, or bytes and shorts, normalised or not (KHR_mesh_quantization)
    indices,     ///< unsigned integers
};

/// What a reader needs of an accessor.
struct AccessorNeed {
    std::string type;  ///< "SCALAR", "VEC2", "VEC3", "VEC4"
    Components components = Components::normalised;
    std::string for_what;   ///< "the keys of an animation"
    std::string used_at;    ///< JSON path of the index that names the accessor
    bool is_finite = true;  ///< treat a number that is not finite as a flaw
    /// The elements to read; null for all of them. Each is below element_count().
    const std::vector<std::uint32_t>* elements = nullptr;
};

/// The number of elements that an accessor claims, without reading them.
[[nodiscard]] std::size_t element_count(const Source& source, std::size_t index);

/// Whether its components are of that kind.
[[nodiscard]] bool has_components(const Source& source, std::size_t index, Components components);

/// The largest value of its index type.
[[nodiscard]] std::uint32_t largest_index(const Source& source, std::size_t index);

/// The elements of an accessor as a flat list of numbers. Floats stay as they are, normalised integers are converted as
/// in glTF 2.0, 3.11; sparse replacements are applied; without a buffer view all are zero. Throws a Flaw if the
/// accessor is of another type, or has a number that is not finite.
[[nodiscard]] std::vector<float> read_accessor(const Source& source, std::size_t index, const AccessorNeed& need);

/// The same for the indices of a mesh primitive.
[[nodiscard]] std::vector<std::uint32_t> read_indices(const Source& source, std::size_t index,
                                                      const std::string& used_at);

}  // namespace tandem::gltf
