/// How the threads of a block work together: a policy, so that code for blocks also runs in tests without a GPU, with
/// threads of the host (tests/cuda/host_lane.h).
#pragma once

#include <cstdint>

#include "tandem/math/host_device.h"

namespace tandem::cuda {

#if TANDEM_COMPILING_CUDA
/// The threads of a GPU. Groups of lanes are masks with a bit for each lane of a warp.
struct DeviceLanes {
    static constexpr std::uint32_t count = 32;  ///< of a warp

    __device__ __forceinline__ static std::uint32_t thread() { return threadIdx.x; }
    __device__ __forceinline__ static std::uint32_t threads() { return blockDim.x; }
    __device__ __forceinline__ static std::uint32_t lane() { return threadIdx.x % count; }
    /// Waits for all threads of the block.
    __device__ __forceinline__ static void wait_for_block() { __syncthreads(); }

    /// The compiler reads memory again after this, so that values need no registers until then.
    __device__ __forceinline__ static void reread() { asm volatile("" ::: "memory"); }

    /// The lanes that call this together.
    __device__ __forceinline__ static std::uint32_t together() { return __activemask(); }
    /// Waits for the lanes of `group`.
    __device__ __forceinline__ static void wait_for(std::uint32_t group) { __syncwarp(group); }
    /// Those of `group` where `is` holds; all of them call it.
    __device__ __forceinline__ static std::uint32_t lanes_where(std::uint32_t group, bool is) {
        return __ballot_sync(group, is);
    }
    /// Those of `group` with the same value as this lane.
    __device__ __forceinline__ static std::uint32_t lanes_with(std::uint32_t group, std::uint32_t value) {
        return __match_any_sync(group, value);
    }
    /// The value of `lane`, one of `group`.
    __device__ __forceinline__ static std::uint32_t of_lane(std::uint32_t group, std::uint32_t value,
                                                            std::uint32_t lane) {
        return __shfl_sync(group, value, static_cast<int>(lane));
    }
    __device__ __forceinline__ static std::uint32_t first(std::uint32_t group) {
        return static_cast<std::uint32_t>(__ffs(static_cast<int>(group)) - 1);
    }
    __device__ __forceinline__ static std::uint32_t size(std::uint32_t group) {
        return static_cast<std::uint32_t>(__popc(group));
    }
    /// How many lanes of `group` are before this one.
    __device__ __forceinline__ static std::uint32_t place_in(std::uint32_t group) {
        return size(group & ((1U << lane()) - 1U));
    }
    /// The sum of the values of all lanes up to this one. The whole warp calls it.
    __device__ __forceinline__ static std::uint32_t sum_up_to(std::uint32_t value) {
        for (std::uint32_t step = 1; step < count; step *= 2) {
            const std::uint32_t other = __shfl_up_sync(0xFFFFFFFFU, value, step);
            if (lane() >= step) value += other;
        }
        return value;
    }

    /// Adds, and returns what was there.
    template <class Number>
    __device__ __forceinline__ static Number add(Number& to, Number value) {
        return atomicAdd(&to, value);
    }
    /// The number of the multiprocessor.
    __device__ __forceinline__ static std::uint32_t multiprocessor() {
        std::uint32_t number = 0;
        asm volatile("mov.u32 %0, %smid;" : "=r"(number));
        return number;
    }
    // A word that other blocks read and write.
    __device__ __forceinline__ static std::uint32_t read(std::uint32_t& from) {
        const volatile std::uint32_t& now = from;
        return now;
    }
    __device__ __forceinline__ static void write(std::uint32_t& to, std::uint32_t value) {
        volatile std::uint32_t& now = to;
        now = value;
    }

    /// Leaves the multiprocessor to other threads for a moment.
    __device__ __forceinline__ static void pause() {
        constexpr unsigned int nanoseconds = 32;
        __nanosleep(nanoseconds);
    }
};
#endif

}  // namespace tandem::cuda
