/// The treatment of the backs of faces.
#pragma once

#include <cstdint>

namespace tandem {

enum class FaceSides : std::uint32_t {
    single_sided,  ///< visible, but unlit
    double_sided,  ///< like the front: the normal is flipped to the side of the ray's origin
    culled,        ///< rays pass through the back (glTF 2.0, 3.9.6)
};

}  // namespace tandem
