/// The length of paths.
#pragma once

#include <cstdint>

namespace tandem {

/// How often a path may continue, by kind; beyond that it contributes nothing. 0 to 255 each.
struct PathLimits {
    std::uint32_t reflection = 8;   ///< in mirrors and at dielectric interfaces
    std::uint32_t refraction = 16;  ///< through dielectric interfaces
    std::uint32_t diffuse = 4;      ///< from diffuse surfaces, with indirect light

    friend constexpr bool operator==(const PathLimits&, const PathLimits&) = default;
};

}  // namespace tandem
