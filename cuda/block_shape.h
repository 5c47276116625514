/// How threads of a render kernel lie over the film.
#pragma once

#include <cstddef>

namespace tandem::cuda {

// A block covers 16 x 8 pixels as four warps of 8 x 4: neighbours in a warp see the same things.
inline constexpr unsigned int warp_width = 8;
inline constexpr unsigned int warp_height = 4;
inline constexpr unsigned int block_width = 16;
inline constexpr unsigned int block_height = 8;
inline constexpr unsigned int block_threads = block_width * block_height;

inline unsigned int blocks_for(std::size_t items, std::size_t per_block) {
    return static_cast<unsigned int>((items + per_block - 1) / per_block);
}

}  // namespace tandem::cuda
