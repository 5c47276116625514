/// Values that are not needed for a while.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "tandem/math/host_device.h"

namespace tandem {

/// Keeps a value in local memory on the GPU, so that it takes no registers until it is needed again. Otherwise the
/// compiler would keep it in registers, and spill values that a loop in between uses.
template <class T>
class Parked {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);

  public:
    TANDEM_HD_INLINE explicit Parked(const T& value) {
#if TANDEM_ON_DEVICE
        std::uint32_t words[sizeof(T) / 4];
        std::memcpy(words, &value, sizeof(T));
        for (unsigned i = 0; i < sizeof(T) / 4; ++i) kept_[i] = words[i];
#else
        kept_ = value;
#endif
    }
    TANDEM_HD_INLINE T get() const {
#if TANDEM_ON_DEVICE
        std::uint32_t words[sizeof(T) / 4];
        for (unsigned i = 0; i < sizeof(T) / 4; ++i) words[i] = kept_[i];
        T value;
        std::memcpy(&value, words, sizeof(T));
        return value;
#else
        return kept_;
#endif
    }

  private:
#if TANDEM_ON_DEVICE
    volatile std::uint32_t kept_[sizeof(T) / 4];
#else
    T kept_;
#endif
};

}  // namespace tandem
