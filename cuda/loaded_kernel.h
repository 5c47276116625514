/// A kernel from a cubin or a fat binary, through the runtime's library interface: like all of the runtime it opens the
/// driver only when it is used, so that programs start without one. Besides launch.h, the only way to launch a kernel;
/// host code can use it.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <span>
#include <string>

#include "cuda/block_shape.h"

namespace tandem::cuda {

/// Code that is loaded, and its kernel. Its functions use the GPU that is current.
class LoadedCode {
  public:
    /// The bytes are copied. `most_registers`: of a thread, where the driver assembles PTX; 0 leaves it to the PTX.
    /// Throws as check() does, so EnvironmentError for a machine that cannot run the code.
    LoadedCode(std::span<const std::byte> code, const std::string& kernel, int most_registers = 0);
    ~LoadedCode();
    LoadedCode(const LoadedCode&) = delete;
    LoadedCode& operator=(const LoadedCode&) = delete;

    /// For the runtime's functions that take a kernel: cudaFuncGetAttributes(), cudaOccupancy...().
    [[nodiscard]] const void* function() const { return kernel_; }

    /// Launches the kernel, and throws on failure. `doing` completes "CUDA failed while ...". The parameters must have
    /// the types in the kernel's source: nothing checks this.
    template <class... Parameters>
    void launch(const char* doing, const RenderGrid& grid, cudaStream_t stream, Parameters... arguments) const {
        void* addresses[] = {&arguments...};
        start(doing, grid, stream, addresses);
    }

  private:
    void start(const char* doing, const RenderGrid& grid, cudaStream_t stream, void** arguments) const;

    cudaLibrary_t library_ = nullptr;
    cudaKernel_t kernel_ = nullptr;
};

}  // namespace tandem::cuda
