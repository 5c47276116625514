#include "cuda/film_memory.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <new>
#include <thread>
#include <vector>

#include "cuda/cuda_error.h"

namespace tandem::cuda {

namespace {

constexpr std::size_t large_page = std::size_t{1} << 21, small_page = 4096;

/// More threads were not faster: the system's own locks limit them.
constexpr std::size_t most_threads = 4;

struct Free {
    void operator()(std::byte* address) const { std::free(address); }
};

/// Writes to every page, large or small. `bytes` is a multiple of a large page.
void touch_pages(std::byte* start, std::size_t bytes) {
    const std::size_t pages = bytes / large_page, threads = std::min(pages, most_threads);
    const auto touch = [=](std::size_t thread) {
        const std::size_t end = pages * (thread + 1) / threads * large_page;
        for (std::size_t at = pages * thread / threads * large_page; at < end; at += small_page) {
            start[at] = std::byte{0};
        }
    };
    std::vector<std::jthread> others;
    for (std::size_t thread = 1; thread < threads; ++thread) others.emplace_back(touch, thread);
    touch(0);
}

}  // namespace

void* FilmMemory::allocate(std::size_t bytes) {
    const std::size_t rounded = (bytes + large_page - 1) / large_page * large_page;
    std::unique_ptr<std::byte, Free> memory(static_cast<std::byte*>(std::aligned_alloc(large_page, rounded)));
    if (!memory) throw std::bad_alloc();
    (void)::madvise(memory.get(), rounded, MADV_HUGEPAGE);  // may fail: without large pages it only takes longer
    touch_pages(memory.get(), rounded);
    // portable: for all GPUs, which may fill parts of one film
    check(cudaHostRegister(memory.get(), rounded, cudaHostRegisterPortable), "locking the memory of a film");
    return memory.release();
}

void FilmMemory::release(void* address) {
    (void)cudaHostUnregister(address);
    std::free(address);
}

}  // namespace tandem::cuda
