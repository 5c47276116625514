/// Keys and cubins for tests of the kernel cache.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "support/random.h"
#include "tandem/base/sha256.h"

namespace tandem::test {

inline std::string cache_key_of(int number) {
    Sha256 hash;
    hash.update_value(number);
    return hash.hex();
}

/// Bytes that stand for a cubin.
inline std::vector<std::byte> some_cubin(std::uint64_t seed, std::size_t size = 5000) {
    Random random(seed);
    std::vector<std::byte> bytes(size);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.below(256));
    return bytes;
}

}  // namespace tandem::test
