/// The 8-bit levels of a film, computed on the GPU.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>

#include "tandem/math/tone_levels.h"
#include "tandem/math/vec.h"

namespace tandem::cuda {

/// How sums become levels. `entries`, in device memory, are those of srgb_level_entries(), or null for linear levels.
struct LevelRule {
    double samples;  ///< of every pixel
    double factor;   ///< exposure_factor()
    const std::uint32_t* entries;
};

/// The output of find_levels(): three levels for each pixel and, after them at a multiple of 8 bytes, the number of
/// means that were NaN.
struct LevelLayout {
    std::size_t values;
    [[nodiscard]] std::size_t nan_values() const { return (values + 7) / 8 * 8; }
    [[nodiscard]] std::size_t bytes() const { return nan_values() + sizeof(unsigned long long); }
};

/// Starts the conversion of the sums of a film to the levels of tone_map(), all in device memory. Both are aligned to
/// 16 bytes.
void find_levels(const Vec3d* sums, std::size_t pixels, const LevelRule& rule, std::byte* to, cudaStream_t stream);

}  // namespace tandem::cuda
