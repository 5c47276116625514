/// How the back of a face is treated.
#pragma once

#include <cstdint>

namespace tandem {

enum class FaceSides : std::uint32_t {
    single_sided,  ///< visible, but unlit
    double_sided,  ///< like the front: the normal is turned to the side that a ray comes from
    culled,        ///< culled: rays pass through it (glTF 2.0, 3.9.6)
};

}  // namespace tandem
