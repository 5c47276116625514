/// The properties of a kernel in a cubin, read from the file itself: no tool, no driver and no GPU is needed. A cubin
/// is an ELF file of 64 bits; the parts that are NVIDIA's own are described in "CUDA Binary Utilities" only as far as
/// cuobjdump prints them, and were compared with it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace tandem::cuda {

struct CubinFacts {
    int registers = 0;                ///< per thread
    int stack_bytes = 0;              ///< per thread: local arrays, spills and calls
    std::span<const std::byte> code;  ///< its instructions, with padding and the subroutines that are its own
};

/// Empty if the bytes are not a complete cubin, or contain no such kernel. `code` points into `cubin`.
[[nodiscard]] std::optional<CubinFacts> cubin_facts(std::span<const std::byte> cubin, std::string_view kernel);

/// The name of a variable that is zero at first, in `cubin`; empty if there is none. The linker makes one of a variable
/// that is declared, and that nothing defines.
[[nodiscard]] std::string_view variable_of_zeros(std::span<const std::byte> cubin);

}  // namespace tandem::cuda
