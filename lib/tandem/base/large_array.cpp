#include "tandem/base/large_array.h"

#include "tandem/base/parallel.h"

namespace tandem {

void touch_pages(void* start, std::size_t bytes) {
    constexpr std::size_t page = 4096, bytes_at_once = std::size_t{1} << 22;
    auto* const memory = static_cast<volatile std::byte*>(start);
    for_each_chunk(bytes, bytes_at_once, [&](const Chunk& chunk) {
        for (std::size_t at = chunk.begin; at < chunk.end; at += page) memory[at] = std::byte{0};
    });
}

}  // namespace tandem
