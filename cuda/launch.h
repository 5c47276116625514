/// The one place where kernels are launched. For .cu files.
#pragma once

#include "cuda/cuda_error.h"

namespace tandem::cuda {

/// Starts `kernel` and throws if that failed. `doing` completes "CUDA failed while ...".
template <class... Parameters, class... Arguments>
void launch(const char* doing, void (*kernel)(Parameters...), dim3 grid, unsigned int block_threads,
            cudaStream_t stream, Arguments&&... arguments) {
    kernel<<<grid, block_threads, 0, stream>>>(arguments...);
    check(cudaGetLastError(), doing);
}

}  // namespace tandem::cuda
