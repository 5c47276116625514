/// Surfaces that glow, as lights to be sampled.
#pragma once

#include <cstdint>

#include "tandem/math/real.h"

namespace tandem {

/// A sphere, triangle or quad that glows.
struct AreaLight {
    std::uint32_t primitive;
    float chance;       ///< with which it is chosen among all, in proportion to its power
    float chance_upto;  ///< sum of the chances of the lights before it and its own; 1 for the last
};

/// The light that u of [0, 1) chooses: its place in `lights`, which are not none.
TANDEM_HD std::uint32_t choose_area_light(const AreaLight* lights, std::uint32_t count, float u) {
    std::uint32_t first = 0, last = count - 1;
    while (first < last) {
        const std::uint32_t middle = (first + last) / 2;
        if (u < lights[middle].chance_upto) {
            last = middle;
        } else {
            first = middle + 1;
        }
    }
    return first;
}

/// The chance of a primitive, 0 for one that is no light. `lights` are in the order of their primitives.
TANDEM_HD float chance_of(const AreaLight* lights, std::uint32_t count, std::uint32_t primitive) {
    std::uint32_t first = 0, end = count;
    while (first < end) {
        const std::uint32_t middle = (first + end) / 2;
        if (lights[middle].primitive < primitive) {
            first = middle + 1;
        } else {
            end = middle;
        }
    }
    return first < count && lights[first].primitive == primitive ? lights[first].chance : 0.0F;
}

}  // namespace tandem
