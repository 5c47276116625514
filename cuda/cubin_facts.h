/// Reads the properties of a kernel from a cubin, without a tool, a driver or a GPU. A cubin is a 64-bit ELF file.
/// NVIDIA's sections are documented in "CUDA Binary Utilities" only as far as cuobjdump prints them; tests compare with
/// cuobjdump.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace tandem::cuda {

struct CubinFacts {
    int registers = 0;                ///< per thread
    int stack_bytes = 0;              ///< per thread: local arrays, spills and calls
    std::span<const std::byte> code;  ///< its instructions, with padding and its own subroutines
};

/// Empty if the bytes are not a complete cubin, or if it has no such kernel. `code` points into `cubin`.
[[nodiscard]] std::optional<CubinFacts> cubin_facts(std::span<const std::byte> cubin, std::string_view kernel);

/// The name of a zero-initialised variable in `cubin`; empty if there is none. The linker turns a declared but
/// undefined variable into such a one.
[[nodiscard]] std::string_view variable_of_zeros(std::span<const std::byte> cubin);

}  // namespace tandem::cuda
