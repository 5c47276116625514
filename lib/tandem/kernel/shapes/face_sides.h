/// What the back of a face is.
#pragma once

#include <cstdint>

namespace tandem {

enum class FaceSides : std::uint32_t {
    single_sided,  ///< there, but unlit
    double_sided,  ///< as the front: the normal is turned to the side that a ray comes from
    culled,        ///< not there: rays go through it (glTF 2.0, 3.9.6)
};

}  // namespace tandem
