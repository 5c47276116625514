/// The probabilities of LightReservoir, over all random numbers.
#pragma once

#include "support/sequence_start.h"
#include "tandem/kernel/light_reservoir.h"

namespace tandem::test {

template <class Real = float>
IncidentLight<Real> light_of(const Vec3<Real>& reflected, std::uint32_t primitive) {
    IncidentLight<Real> result = {reflected, {Real(0), Real(0), Real(1)}};
    result.primitive = primitive;
    return result;
}

/// The probability that the second of two lights is taken. Three 24-bit numbers decide, a later one only if the earlier
/// ones leave it open. Lower numbers take the light, so each number has one threshold.
template <class Real>
double chance_of_second(Real first, Real second) {
    constexpr std::uint32_t most = (1U << 24) - 1;
    const auto is_taken = [&](std::uint32_t high, std::uint32_t middle, std::uint32_t low) {
        LightReservoir<Real> choice(sequence_start(high << 8, middle << 8, low << 8, 12345));
        choice.offer(light_of<Real>({first, Real(0), Real(0)}, 0));
        choice.offer(light_of<Real>({second, Real(0), Real(0)}, 1));
        return choice.chosen().primitive == 1;
    };
    // how many of the numbers, from 0 on, take the light
    const auto count = [&](const auto& taken) {
        std::uint32_t begin = 0, end = most + 1;
        while (begin < end) {
            const std::uint32_t half = (begin + end) / 2;
            if (taken(half)) {
                begin = half + 1;
            } else {
                end = half;
            }
        }
        return begin;
    };
    const std::uint32_t high = count([&](std::uint32_t i) { return is_taken(i, most, most); });
    if (high > most) return 1;
    const std::uint32_t middle = count([&](std::uint32_t i) { return is_taken(high, i, most); });
    const std::uint32_t low = middle > most ? 0 : count([&](std::uint32_t i) { return is_taken(high, middle, i); });
    return (high + (middle + low * 0x1p-24) * 0x1p-24) * 0x1p-24;
}

}  // namespace tandem::test
