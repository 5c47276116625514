/// Specialises a kernel by link-time constant folding. nvcc compiles the kernel to LTO-IR that reads facts of the scene
/// from an undefined constant. Here it is linked with a module that defines the constant, and the optimiser removes the
/// code that the facts exclude. Needs neither a GPU nor a driver.
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

/// The input of the linker. Names are linker names: declare kernel and facts extern "C".
struct JitInput {
    std::span<const std::byte> code;   ///< a fat binary with the kernel's LTO-IR (cmake/lto_kernels.cmake)
    std::string kernel;                ///< the one to keep
    std::string facts_name;            ///< of the `extern "C" __device__ const` struct that the kernel reads
    std::vector<std::uint32_t> facts;  ///< its contents: words_of()
    Tier tier = Tier::strict;          ///< the tier whose arithmetic the link must preserve
    int architecture = 0;              ///< of the GPU: 90 for compute capability 9.0; at least that of the LTO-IR
    int registers = 0;                 ///< the most that a thread may have; 0: as the kernel's launch bounds say
};

/// A struct of 32-bit integers as its words.
template <class Facts>
[[nodiscard]] std::vector<std::uint32_t> words_of(const Facts& facts) {
    static_assert(std::is_trivially_copyable_v<Facts> && alignof(Facts) == sizeof(std::uint32_t));
    std::vector<std::uint32_t> words(sizeof(Facts) / sizeof(std::uint32_t));
    std::memcpy(words.data(), &facts, sizeof(Facts));
    return words;
}

/// What is missing to link kernels here, and what to do; empty if nothing is.
[[nodiscard]] const std::string& why_jit_unavailable();

/// "nvJitLink 13.0, NVRTC 13.0": what the machine code depends on besides the input. Throws as link() does.
[[nodiscard]] std::string jit_version();

/// The options of nvJitLink. With LTO the linker decides about contraction and flush-to-zero, whatever nvcc's options
/// were, so they are turned off again for strict and precise.
[[nodiscard]] std::vector<std::string> link_options(const JitInput& input);

/// The specialised kernel as a cubin. Throws EnvironmentError with why_jit_unavailable() if the libraries are missing;
/// throws std::runtime_error with their log if they fail, if the code lacks the kernel, or if it reads a constant of
/// another name or size. Safe from several threads at once.
[[nodiscard]] std::vector<std::byte> link(const JitInput& input);

}  // namespace tandem::cuda
