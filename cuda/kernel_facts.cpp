#include "cuda/block_shape.h"
#include "cuda/cuda_error.h"
#include "cuda/kernels.h"

namespace tandem::cuda {

KernelFacts kernel_facts(const void* kernel) {
    cudaFuncAttributes attributes{};
    check(cudaFuncGetAttributes(&attributes, kernel), "reading the facts of a kernel");
    int blocks = 0;
    check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, block_threads, 0),
          "reading the occupancy of a kernel");
    int device = 0;
    int threads = 1;
    check(cudaGetDevice(&device), "finding the current GPU");
    check(cudaDeviceGetAttribute(&threads, cudaDevAttrMaxThreadsPerMultiProcessor, device), "reading GPU facts");
    return {attributes.numRegs, static_cast<int>(attributes.localSizeBytes),
            static_cast<double>(blocks) * block_threads / threads};
}

}  // namespace tandem::cuda
