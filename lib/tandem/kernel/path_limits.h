/// How far paths are followed.
#pragma once

#include <cstdint>

namespace tandem {

/// How often a path may go on, by kind; what it would see behind that is black. 0 to 255 each.
struct PathLimits {
    std::uint32_t reflection = 8;   ///< in mirrors and at borders of glass
    std::uint32_t refraction = 16;  ///< through borders of glass
    std::uint32_t diffuse = 4;      ///< from matt surfaces, with indirect light

    friend constexpr bool operator==(const PathLimits&, const PathLimits&) = default;
};

}  // namespace tandem
