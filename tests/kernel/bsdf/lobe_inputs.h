/// Random inputs for lobes.
#pragma once

#include <cmath>

#include "kernel/bsdf/lobe_checks.h"
#include "kernel/bsdf/lobe_lanes.h"
#include "support/random.h"

namespace tandem::test {

/// Everywhere above and, for one in eight, below the horizon; ends of the ranges as often as what lies between.
inline LobeInput lobe_input(std::uint64_t number) {
    Random random(number);
    const auto share = [&] { return random.coin() ? random.uniform(0.0, 1.0) : random.below(5) / 4.0; };
    const auto any_direction = [&] {
        const double height = random.coin() ? random.uniform(0.0, 1.0) : std::exp2(-random.uniform(0.0, 60.0));
        return direction(random.below(8) == 0 ? -height : height, share());
    };
    const Vec3d wo = any_direction();
    const Vec3d wi = random.coin() ? any_direction() : normalize(Vec3d{-wo.x, -wo.y, wo.z} + any_direction() * 0.01);
    const Vec3d u = random_numbers(random);
    return {{wo.x, wo.y, wo.z},          {wi.x, wi.y, wi.z}, {u.x, u.y, u.z},
            {share(), share(), share()}, {share(), share()}, random.uniform(0.4, 2.5)};
}

}  // namespace tandem::test
