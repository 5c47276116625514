/// Emissive surfaces as area lights.
#pragma once

#include <cstdint>

#include "tandem/math/lookup_table.h"

namespace tandem {

/// An emissive sphere, triangle or quad. A uniform 64-bit number chooses one of them: each light has a range of
/// numbers, in the order of the lights, and its probability is exactly the length of its range over 2^64.
struct AreaLight {
    std::uint64_t range_last;  ///< inclusive; the range starts after that of the previous light
    double probability;        ///< with which the light is chosen
    std::uint32_t primitive;
    std::uint32_t halves_overlap = 0;  ///< 1: of a quad, one half may occlude the other from some points
};
static_assert(sizeof(AreaLight) == 24, "no byte of a light is undefined; scene_hash() reads all");

/// The light that a uniform number chooses: its index in `lights`, which must not be empty. Tested by the hard cases of
/// tests/hard/corpus/group_m_lights.cpp.
TANDEM_HD std::uint32_t choose_area_light(const AreaLight* lights, std::uint32_t count, std::uint64_t number) {
    return bisect<std::uint32_t>(count, [&](std::uint32_t light) { return lights[light].range_last < number; });
}

/// The probability of a primitive; 0 if it is no area light. `lights` are in the order of their primitives.
TANDEM_HD double probability_of(const AreaLight* lights, std::uint32_t count, std::uint32_t primitive) {
    std::uint32_t first = 0, end = count;
    while (first < end) {
        const std::uint32_t middle = (first + end) / 2;
        if (lights[middle].primitive < primitive) {
            first = middle + 1;
        } else {
            end = middle;
        }
    }
    return first < count && lights[first].primitive == primitive ? lights[first].probability : 0.0;
}

}  // namespace tandem
