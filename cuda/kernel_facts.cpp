#include "cuda/block_shape.h"
#include "cuda/cuda_error.h"
#include "cuda/kernels.h"

namespace tandem::cuda {

namespace {

int fact(cudaDeviceAttr attribute) {
    int device = 0;
    int value = 1;
    check(cudaGetDevice(&device), "finding the current GPU");
    check(cudaDeviceGetAttribute(&value, attribute, device), "reading the properties of the GPU");
    return value;
}

}  // namespace

RenderGrid pixel_queue() {
    return {dim3(static_cast<unsigned int>(fact(cudaDevAttrMultiProcessorCount))), queue_threads};
}

KernelFacts kernel_facts(const void* kernel) {
    cudaFuncAttributes attributes{};
    check(cudaFuncGetAttributes(&attributes, kernel), "reading the properties of a kernel");
    const int threads = attributes.maxThreadsPerBlock;  // from its launch bounds, with which it is launched
    int blocks = 0;
    check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, threads, 0),
          "reading the occupancy of a kernel");
    return {attributes.numRegs, static_cast<int>(attributes.localSizeBytes),
            static_cast<double>(blocks) * threads / fact(cudaDevAttrMaxThreadsPerMultiProcessor)};
}

}  // namespace tandem::cuda
