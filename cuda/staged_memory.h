/// How many paths in stages a block follows at most, and their memory (cuda/staged_paths.h). Tested by
/// tests/cuda/staged_memory_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "cuda/block_shape.h"
#include "cuda/stage_lists.h"
#include "cuda/stored_path.h"

namespace tandem::cuda {

/// The shared memory of a block, at most. A multiprocessor of compute capability 9.0 divides 256 KB between shared
/// memory, of which the driver takes 1 KB for each block, and a cache, which spilled registers need. Shared memory gets
/// 132, 164, 196 or 228 KB, or less. In precise, whose records are larger, more paths are worth more than the cache.
/// Measured on an H200 (docs/performance/paths.md).
template <class Real>
inline constexpr std::size_t staged_block_bytes = ((std::is_same_v<Real, double> ? 196 : 164) - 1) * std::size_t{1024};

namespace staged_memory_detail {

inline constexpr std::size_t list_bytes = (sizeof(StageLists<64>) - sizeof(StageLists<32>)) / 32;  ///< of a path
inline constexpr std::size_t other_bytes = sizeof(StageLists<32>) - 32 * list_bytes;

}  // namespace staged_memory_detail

/// How many paths fit into that: an even number, so that no list ends within a word.
template <class Real>
inline constexpr auto most_staged_paths =
    static_cast<std::uint32_t>((staged_block_bytes<Real> - staged_memory_detail::other_bytes) /
                               (PathRecords<Real>::bytes + staged_memory_detail::list_bytes) / 2 * 2);

/// Their lists.
template <class Real>
using StageListsOf = StageLists<most_staged_paths<Real>>;

/// Their memory, for the host.
template <class Real>
[[nodiscard]] constexpr StagedMemory staged_memory_of() {
    static_assert(sizeof(StageListsOf<Real>) + most_staged_paths<Real> * PathRecords<Real>::bytes <=
                  staged_block_bytes<Real>);
    return {most_staged_paths<Real>, PathRecords<Real>::bytes, sizeof(RarePathRecords<Real>)};
}

}  // namespace tandem::cuda
