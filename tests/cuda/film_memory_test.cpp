#include "cuda/film_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

#include "cuda/cuda_backend.h"
#include "cuda/memory.h"

namespace tandem::cuda {
namespace {

TEST(FilmMemory, IsLockedAndHoldsWhatTheGpuWrites) {
    if (!why_cuda_unavailable().empty()) GTEST_SKIP() << why_cuda_unavailable();
    constexpr std::size_t page = std::size_t{1} << 21;
    Buffer<FilmMemory> film;  // grows from one size to the next
    for (const std::size_t bytes : {std::size_t{24}, page, page + 1, 5 * page - 1}) {
        film.reserve(bytes);
        ASSERT_EQ(film.capacity(), bytes);
        cudaPointerAttributes attributes{};
        check(cudaPointerGetAttributes(&attributes, film.data()), "asking about memory");
        EXPECT_EQ(attributes.type, cudaMemoryTypeHost) << bytes;
        Buffer<DeviceMemory> on_device;
        on_device.reserve(bytes);
        check(cudaMemset(on_device.data(), 0x5A, bytes), "filling memory");
        check(cudaMemcpy(film.data(), on_device.data(), bytes, cudaMemcpyDeviceToHost), "downloading");
        const auto is_filled = [](std::byte value) { return value == std::byte{0x5A}; };
        EXPECT_TRUE(std::ranges::all_of(std::span(film.data(), bytes), is_filled)) << bytes;
    }
}

}  // namespace
}  // namespace tandem::cuda
