/// Pairs of floats on which to try pow: random bits, results over the whole range, bases next to 1, and powers that
/// are exactly floats or midpoints of floats.
#pragma once

#include <cmath>
#include <utility>

#include "support/random.h"

namespace tandem::test {

inline std::pair<float, float> pow_pair(std::uint64_t index) {
    Random random(index);
    const float any = random.any_float();
    switch (index % 8) {
        case 0:
            return {any, random.any_float()};
        case 1: {  // an odd integer or its square, cube, ... root: exact results
            const auto power = static_cast<float>(random.below(15) + 1);
            const auto base = static_cast<float>(random.below(1U << (25U / static_cast<unsigned>(power))) + 1);
            const float scale = std::ldexp(1.0F, static_cast<int>(random.below(9)) - 4);
            return {base * scale, power};
        }
        case 2: {
            const auto root = static_cast<float>(random.below(4096) + 1);
            return {root * root, static_cast<float>(random.below(7)) * 0.5F - 1.5F};
        }
        case 3:  // powers of two, also subnormal
            return {std::ldexp(1.0F, static_cast<int>(random.below(277)) - 149),
                    static_cast<float>(random.below(64)) * 0.125F - 4.0F};
        case 4: {  // next to 1
            const auto steps = static_cast<float>(random.below(4096)) - 2048.0F;
            const float base = 1.0F + steps * 0x1p-23F;
            return {base, std::ldexp(random.uniform(-1.0F, 1.0F), static_cast<int>(random.below(40)) - 10)};
        }
        default: {  // result with a logarithm between -104 and 89, over all exponents
            const float base = std::fabs(any);
            const float log_base = std::log(base);
            const float log_result = random.uniform(-104.0F, 89.0F);
            return {base, log_base == 0 ? log_result : log_result / log_base};
        }
    }
}

}  // namespace tandem::test
