/// A kernel from a cubin, through the library interface of the CUDA runtime, which opens the driver only when it is
/// used, so that programs start without one. Besides launch.h the only way to launch a kernel; host code can use it.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <span>
#include <string>

namespace tandem::cuda {

/// A cubin, loaded for the current device, and its kernel.
class LoadedCode {
  public:
    /// The bytes are copied. Throws as check() does: EnvironmentError for a machine that cannot run the cubin.
    LoadedCode(std::span<const std::byte> cubin, const std::string& kernel);
    ~LoadedCode();
    LoadedCode(const LoadedCode&) = delete;
    LoadedCode& operator=(const LoadedCode&) = delete;

    /// For the runtime's functions that take a kernel: cudaFuncGetAttributes(), cudaOccupancy...().
    [[nodiscard]] const void* function() const { return kernel_; }

    /// Launches the kernel, and throws on failure. `doing` completes "CUDA failed while ...". The parameters must have
    /// the types in the kernel's source: nothing checks this.
    template <class... Parameters>
    void launch(const char* doing, dim3 grid, unsigned int block_threads, cudaStream_t stream,
                Parameters... arguments) const {
        void* addresses[] = {&arguments...};
        start(doing, grid, block_threads, stream, addresses);
    }

  private:
    void start(const char* doing, dim3 grid, unsigned int block_threads, cudaStream_t stream, void** arguments) const;

    cudaLibrary_t library_ = nullptr;
    cudaKernel_t kernel_ = nullptr;
};

}  // namespace tandem::cuda
