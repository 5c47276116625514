/// Arrays of many megabytes.
#pragma once

#include <cstddef>
#include <vector>

namespace tandem {

/// Writes to every page of memory that holds nothing yet, on several threads: the system clears a page when it is first
/// written to, which takes longer than filling it.
void touch_pages(void* start, std::size_t bytes);

/// Makes `count` elements in an empty array, and reserves memory for `capacity`.
template <class T>
void make_large(std::vector<T>& array, std::size_t count, std::size_t capacity) {
    array.reserve(capacity);
    touch_pages(array.data(), count * sizeof(T));
    array.resize(count);
}

}  // namespace tandem
