#include "cuda/loaded_kernel.h"

#include <cstdint>
#include <utility>

#include "cuda/cuda_error.h"

namespace tandem::cuda {

LoadedCode::LoadedCode(std::span<const std::byte> code, const std::string& kernel, int most_registers) {
    cudaJitOption option = cudaJitMaxRegisters;
    void* value = reinterpret_cast<void*>(static_cast<std::uintptr_t>(most_registers));  // the number itself
    const unsigned int options = most_registers > 0 ? 1 : 0;
    check(cudaLibraryLoadData(&library_, code.data(), &option, &value, options, nullptr, nullptr, 0),
          "loading a kernel");
    const cudaError_t found = cudaLibraryGetKernel(&kernel_, library_, kernel.c_str());
    if (found != cudaSuccess) (void)cudaLibraryUnload(std::exchange(library_, nullptr));
    check(found, "finding a kernel");
}

// a failure to unload cannot be handled
LoadedCode::~LoadedCode() { (void)cudaLibraryUnload(library_); }

void LoadedCode::start(const char* doing, const RenderGrid& grid, cudaStream_t stream, void** arguments) const {
    check(cudaLaunchKernel(function(), grid.blocks, grid.threads, arguments, grid.shared_bytes, stream), doing);
}

}  // namespace tandem::cuda
