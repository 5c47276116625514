/// Specialises a kernel by link-time constant folding: nvcc compiled it to LTO-IR, in which it reads facts of the scene
/// from an undefined constant; here a module that defines the constant is linked with it, and the optimiser removes the
/// code that the facts exclude. Needs no GPU and no driver.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "tandem/render/tier.h"

namespace tandem::cuda {

/// What the linker needs. Names are as the linker sees them: declare kernel and facts extern "C".
struct JitInput {
    std::span<const std::byte> code;   ///< a fat binary with the kernel's LTO-IR (cmake/lto_kernels.cmake)
    std::string kernel;                ///< the one to keep
    std::string facts_name;            ///< of the `extern "C" __device__ const` struct that the kernel reads
    std::vector<std::uint32_t> facts;  ///< what is in it: words_of()
    Tier tier = Tier::strict;          ///< whose arithmetic the link must keep
    int architecture = 0;              ///< of the GPU: 90 for compute capability 9.0; not below that of the LTO-IR
};

/// A struct of 32-bit integers as its words.
template <class Facts>
[[nodiscard]] std::vector<std::uint32_t> words_of(const Facts& facts) {
    static_assert(std::is_trivially_copyable_v<Facts> && alignof(Facts) == sizeof(std::uint32_t));
    std::vector<std::uint32_t> words(sizeof(Facts) / sizeof(std::uint32_t));
    std::memcpy(words.data(), &facts, sizeof(Facts));
    return words;
}

/// Empty if kernels can be linked here; else what is missing and what to do.
[[nodiscard]] const std::string& why_jit_unavailable();

/// "nvJitLink 13.0, NVRTC 13.0": what the machine code depends on besides the input. Throws as link() does.
[[nodiscard]] std::string jit_version();

/// The options of nvJitLink. With LTO the link decides about contraction and flushes, whatever nvcc's options were: so
/// for strict and precise it is told again that there are none.
[[nodiscard]] std::vector<std::string> link_options(const JitInput& input);

/// The specialised kernel as a cubin. Throws EnvironmentError with why_jit_unavailable() if the libraries are missing;
/// std::runtime_error with their log if they fail, if the code lacks the kernel, or if it reads a constant of another
/// name or size. Safe from several threads at once.
[[nodiscard]] std::vector<std::byte> link(const JitInput& input);

}  // namespace tandem::cuda
