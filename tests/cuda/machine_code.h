/// Looks into the machine code of a kernel. An instruction of compute capability 7.0 to 12.x has 16 bytes, and its
/// lowest nine bits say what it does. That is not documented; the tests look for instructions where they must be as
/// well as where they must not, and cubin_facts_test.cpp compares with cuobjdump where there is one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace tandem::test {

enum class Operation : std::uint32_t { ffma = 0x023, mufu = 0x108, dfma = 0x02B };

inline constexpr std::size_t instruction_bytes = 16;

inline std::uint32_t word_at(std::span<const std::byte> code, std::size_t offset) {
    std::uint32_t word;
    std::memcpy(&word, code.data() + offset, sizeof word);
    return word;
}

inline int count(std::span<const std::byte> code, Operation operation) {
    int found = 0;
    for (std::size_t at = 0; at + instruction_bytes <= code.size(); at += instruction_bytes) {
        if ((word_at(code, at) & 0x1FFU) == static_cast<std::uint32_t>(operation)) ++found;
    }
    return found;
}

/// How many instructions hold the number as an immediate operand.
inline int count_immediate(std::span<const std::byte> code, float value) {
    std::uint32_t pattern;
    std::memcpy(&pattern, &value, sizeof pattern);
    int found = 0;
    for (std::size_t at = 0; at + instruction_bytes <= code.size(); at += instruction_bytes) {
        if (word_at(code, at + 4) == pattern) ++found;
    }
    return found;
}

}  // namespace tandem::test
