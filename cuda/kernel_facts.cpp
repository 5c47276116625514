#include <algorithm>

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

cudaFuncAttributes attributes_of(const void* kernel) {
    cudaFuncAttributes attributes{};
    check(cudaFuncGetAttributes(&attributes, kernel), "reading the properties of a kernel");
    return attributes;
}

}  // namespace

unsigned int multiprocessor_count() { return static_cast<unsigned int>(fact(cudaDevAttrMultiProcessorCount)); }

RenderGrid pixel_queue(const void* kernel, unsigned int blocks_per_multiprocessor) {
    constexpr unsigned int warp = 32;
    const unsigned int threads =
        std::min(most_queue_threads, static_cast<unsigned int>(attributes_of(kernel).maxThreadsPerBlock));
    return {dim3(multiprocessor_count() * blocks_per_multiprocessor),
            dim3(std::max(threads / blocks_per_multiprocessor / warp, 1U) * warp)};
}

RenderGrid staged_grid(const void* kernel, const StagedMemory& memory, std::uint64_t pixels) {
    RenderGrid grid = pixel_queue(kernel, 1);
    const std::size_t room =
        static_cast<std::size_t>(fact(cudaDevAttrMaxSharedMemoryPerBlockOptin)) - attributes_of(kernel).sharedSizeBytes;
    const std::size_t most = std::min<std::size_t>(room / memory.path_bytes, memory.most_paths);
    const std::uint32_t paths = staged_paths(pixels / grid.blocks.x, grid.threads.x, static_cast<std::uint32_t>(most));
    grid.shared_bytes = paths * memory.path_bytes;
    check(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                               static_cast<int>(most * memory.path_bytes)),
          "reserving shared memory");
    return grid;
}

KernelFacts kernel_facts(const void* kernel) {
    const cudaFuncAttributes attributes = attributes_of(kernel);
    // the threads at launch, from the launch bounds or limited by registers; several blocks of a queue share this
    // number
    const int threads = std::min(attributes.maxThreadsPerBlock, static_cast<int>(most_queue_threads));
    int blocks = 0;
    check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, threads, 0),
          "reading the occupancy of a kernel");
    return {attributes.numRegs, static_cast<int>(attributes.localSizeBytes),
            static_cast<double>(blocks) * threads / fact(cudaDevAttrMaxThreadsPerMultiProcessor)};
}

}  // namespace tandem::cuda
