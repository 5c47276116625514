#include "tandem/images/fast_deflate.h"

#include <cpuid.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace tandem {
namespace {

/// Whether the processor says which registers are in use (XGETBV with ECX = 1; Intel's manual, volume 1, 13.6).
bool knows_registers_in_use() {
    std::uint32_t a = 0, b = 0, c = 0, d = 0;
    return __get_cpuid_count(0xD, 1, &a, &b, &c, &d) != 0 && (a & 4) != 0;
}

/// Whether the upper halves of AVX registers are in use.
bool are_upper_halves_in_use() {
    std::uint32_t low = 0, high = 0;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(1));
    return (low & 4) != 0;
}

// Code for SSE is many times slower on a thread whose upper halves are in use (docs/performance/program.md).
TEST(FastDeflate, LeavesTheUpperHalvesOfRegistersClear) {
    if (!FastDeflate::is_available()) GTEST_SKIP() << "this build has no ISA-L";
    if (!__builtin_cpu_supports("avx") || !knows_registers_in_use()) GTEST_SKIP() << "this processor does not tell";
    __asm__ volatile("vzeroupper");
    if (are_upper_halves_in_use()) GTEST_SKIP() << "this processor does not tell when they are clear";
    std::vector<std::uint8_t> bytes(1 << 20);
    std::uint32_t state = 1;
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>((state = state * 1664525U + 1013904223U) >> 28);
    (void)FastDeflate::adler32(1, bytes);
    EXPECT_FALSE(are_upper_halves_in_use()) << "after adler32()";
    FastDeflate deflate;
    (void)deflate.compress(bytes, FastDeflate::Then::end);
    EXPECT_FALSE(are_upper_halves_in_use()) << "after compress()";
}

}  // namespace
}  // namespace tandem
