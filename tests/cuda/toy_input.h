/// The toy kernel as an input of the linker.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "cuda/jit_link.h"
#include "cuda/toy_kernel.h"

namespace tandem::test {

/// The LTO-IR of toy_kernel.cu, embedded by tandem_add_lto_kernels().
std::span<const std::byte> toy_strict();
std::span<const std::byte> toy_fast();

/// It linked for compiled_toy_facts and CMAKE_CUDA_ARCHITECTURES, embedded by tandem_add_compiled_kernels().
std::span<const std::byte> compiled_toy_strict();
std::span<const std::byte> compiled_toy_fast();

/// For compute capability 9.0, or the lowest that this build is for if that is higher.
inline cuda::JitInput toy_input(const ToyFacts& facts, Tier tier = Tier::strict) {
    cuda::JitInput input;
    input.code = tier == Tier::fast ? toy_fast() : toy_strict();
    input.kernel = "toy_kernel";
    input.facts_name = "toy_facts";
    input.facts = cuda::words_of(facts);
    input.tier = tier;
    input.architecture = std::max(90, TANDEM_LTO_ARCHITECTURE);
    return input;
}

}  // namespace tandem::test
