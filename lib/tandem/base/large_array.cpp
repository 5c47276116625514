#include "tandem/base/large_array.h"

#include <sys/mman.h>

#include <cstdint>

#include "tandem/base/parallel.h"

namespace tandem {

namespace {

constexpr std::uintptr_t large_page = std::uintptr_t{1} << 21, small_page = 4096;

}  // namespace

void prefer_large_pages(void* start, std::size_t bytes) {
    const auto address = reinterpret_cast<std::uintptr_t>(start);
    const std::uintptr_t first = (address + large_page - 1) / large_page * large_page;
    const std::uintptr_t end = (address + bytes) / large_page * large_page;
    if (first >= end) return;
    (void)::madvise(static_cast<std::byte*>(start) + (first - address), end - first, MADV_HUGEPAGE);
}

void touch_pages(void* start, std::size_t bytes) {
    auto* const memory = static_cast<volatile std::byte*>(start);
    for_each_chunk(bytes, 2 * large_page, [&](const Chunk& chunk) {
        for (std::size_t at = chunk.begin; at < chunk.end; at += small_page) memory[at] = std::byte{0};
    });
}

}  // namespace tandem
