/// Objects in memory that a GPU loads as a whole.
#pragma once

#include "tandem/math/host_device.h"

namespace tandem {

/// An object in memory: on a GPU a copy, since the compiler loads an aligned object with few instructions. Of a
/// reference to a member it does not know the alignment, and loads word after word.
template <class Object>
#if TANDEM_ON_DEVICE
TANDEM_HD_INLINE Object whole(const Object& object) {
#else
TANDEM_HD_INLINE const Object& whole(const Object& object) {
#endif
    return object;
}

}  // namespace tandem
