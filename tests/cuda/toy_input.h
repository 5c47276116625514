/// The toy kernel as an input of the linker.
#pragma once

#include <cstddef>
#include <span>

#include "cuda/jit_link.h"
#include "cuda/toy_kernel.h"

namespace tandem::test {

/// The LTO-IR of toy_kernel.cu, embedded by tandem_add_lto_kernels().
std::span<const std::byte> toy_strict();
std::span<const std::byte> toy_fast();

/// For a GPU of compute capability 9.0, and the facts as they are given.
inline cuda::JitInput toy_input(const ToyFacts& facts, Tier tier = Tier::strict) {
    cuda::JitInput input;
    input.code = tier == Tier::fast ? toy_fast() : toy_strict();
    input.kernel = "toy_kernel";
    input.facts_name = "toy_facts";
    input.facts = cuda::words_of(facts);
    input.tier = tier;
    input.architecture = 90;
    return input;
}

}  // namespace tandem::test
