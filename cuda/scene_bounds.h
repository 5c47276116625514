/// The bounds of a scene in GPU memory. Included by .cu files.
#pragma once

#include <cstring>

#include "cuda/build_tree.h"
#include "cuda/launch.h"
#include "cuda/memory.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem::cuda {

inline constexpr unsigned int build_block = 256;  ///< threads

// Floats as integers of the same order, for atomic minima and maxima.
__host__ __device__ inline std::uint32_t ordered_bits(float a) {
    const std::uint32_t bits = bits_of(a);
    return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}
__host__ __device__ inline float from_ordered_bits(std::uint32_t bits) {
    return float_of((bits & 0x80000000U) != 0 ? bits & 0x7FFFFFFFU : ~bits);
}

/// The bounds of all primitives, as ordered bits.
struct OrderedBounds {
    std::uint32_t lower[3], upper[3];
};

static __global__ void bounds_kernel(SceneView scene, std::uint32_t count, OrderedBounds* bounds) {
    Aabb box;
    for (std::uint32_t id = thread_number(); id < count; id += gridDim.x * blockDim.x) {
        box = merge(box, primitive_bounds(scene, id));
    }
    const float lower[] = {box.lower.x, box.lower.y, box.lower.z}, upper[] = {box.upper.x, box.upper.y, box.upper.z};
    for (int axis = 0; axis < 3; ++axis) {
        std::uint32_t least = ordered_bits(lower[axis]), most = ordered_bits(upper[axis]);
        for (int distance = 16; distance > 0; distance /= 2) {
            least = min(least, __shfl_xor_sync(~0U, least, distance));
            most = max(most, __shfl_xor_sync(~0U, most, distance));
        }
        if (threadIdx.x % 32 == 0) {
            atomicMin(&bounds->lower[axis], least);
            atomicMax(&bounds->upper[axis], most);
        }
    }
}

/// Copies `bytes` from GPU memory to `to`, and waits for that. `word`: of at least as many bytes.
inline void fetch_bytes(void* to, const void* from, std::size_t bytes, const Buffer<PinnedMemory>& word,
                        const char* doing, cudaStream_t stream) {
    check(cudaMemcpyAsync(word.data(), from, bytes, cudaMemcpyDeviceToHost, stream), doing);
    check(cudaStreamSynchronize(stream), doing);
    std::memcpy(to, word.data(), bytes);
}

/// Not padded. `at`: working memory on the GPU. Minima and maxima do not depend on the order. Waits for the stream.
inline Aabb scene_bounds(const SceneView& scene, OrderedBounds* at, const Buffer<PinnedMemory>& word, const char* doing,
                         cudaStream_t stream) {
    constexpr std::uint32_t most_threads = 1U << 18;
    const std::uint32_t count = primitive_count(scene);
    const std::uint32_t threads = count < most_threads ? count : most_threads;
    check(cudaMemsetAsync(at->lower, 0xFF, sizeof(at->lower), stream), doing);
    check(cudaMemsetAsync(at->upper, 0, sizeof(at->upper), stream), doing);
    launch(doing, bounds_kernel, (threads + build_block - 1) / build_block, build_block, stream, scene, count, at);
    OrderedBounds ordered;
    fetch_bytes(&ordered, at, sizeof(ordered), word, doing, stream);
    const auto vector = [](const std::uint32_t* bits) {
        return Vec3f{from_ordered_bits(bits[0]), from_ordered_bits(bits[1]), from_ordered_bits(bits[2])};
    };
    return {vector(ordered.lower), vector(ordered.upper)};
}

}  // namespace tandem::cuda
