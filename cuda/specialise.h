/// A specialised kernel from the cache, or linked and stored there.
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
    std::string cache_problem;  ///< why the cache could not read or store it; empty if it could, or if it is off
};

/// SHA-256 of everything that the cubin depends on; `version` is jit_version().
[[nodiscard]] std::string cache_key(const JitInput& input, const std::string& version);

/// Throws as link() does; a failing cache is not an error.
[[nodiscard]] Specialised specialise(const JitInput& input, const KernelCache& cache);

}  // namespace tandem::cuda
