/// A specialised kernel from the cache, or linked and put there.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cuda/jit_link.h"
#include "cuda/kernel_cache.h"

namespace tandem::cuda {

struct Specialised {
    std::vector<std::byte> cubin;
    bool from_cache = false;
    double seconds = 0;         ///< to fetch or to link it
    std::string cache_problem;  ///< why the cache did not serve or keep it; empty if it did, or if it is off
};

/// SHA-256 of all that the cubin depends on; `version` is jit_version().
[[nodiscard]] std::string cache_key(const JitInput& input, const std::string& version);

/// Throws as link() does; a cache that does not work is no error.
[[nodiscard]] Specialised specialise(const JitInput& input, const KernelCache& cache);

}  // namespace tandem::cuda
