/// A small kernel with effects that are switched on by facts, to try specialisation on: one text for the GPU and for
/// the host, which checks it.
#pragma once

#include <cstdint>

#include "tandem/math/real.h"

namespace tandem::test {

/// Each leaves a mark in the machine code.
enum ToyEffect : std::uint32_t {
    toy_root = 1,      ///< an approximation (MUFU), from which a square root starts
    toy_quotient = 2,  ///< operations in double (DFMA, DMUL)
    toy_lights = 4,    ///< the constant toy_marker; a loop of as many turns as there are lights
    toy_table = 8,     ///< many registers
    toy_fused = 16,    ///< one fused multiply-add (FFMA); on the host it may be two operations
    toy_all = 31,
};

/// What the kernel is specialised for. A plain struct of 32-bit integers.
struct ToyFacts {
    std::uint32_t effects = toy_all;
    std::uint32_t lights = 3;
};

/// Those of the kernel that is linked when the tests are built.
inline constexpr ToyFacts compiled_toy_facts = {toy_lights | toy_table | toy_fused, 3};

inline constexpr float toy_marker = 1.2345678F;

TANDEM_HD float toy_value(const ToyFacts& facts, float x) {
    float sum = x * 2.5F + 1.0F;  // contracted where nobody forbids it
    if ((facts.effects & toy_root) != 0) sum = sum + square_root(x);
    if ((facts.effects & toy_quotient) != 0) sum = sum + narrow(widen(sum) / (widen(x) * widen(x) + 7.0));
    if ((facts.effects & toy_lights) != 0) {
        for (std::uint32_t light = 0; light < facts.lights; ++light) sum = sum * toy_marker + x;
    }
    if ((facts.effects & toy_table) != 0) {
        constexpr int size = 32;
        float table[size];
        for (int k = 0; k < size; ++k) table[k] = x + static_cast<float>(k);
        for (int round = 0; round < 2; ++round) {
            for (int k = 0; k < size; ++k) table[k] = table[k] * table[(k + 1) % size] + sum;
        }
        for (int k = 0; k < size; ++k) sum = sum + table[k];
    }
    if ((facts.effects & toy_fused) != 0) sum = loose_multiply_add(sum, x, 0.75F);
    return sum;
}

}  // namespace tandem::test
