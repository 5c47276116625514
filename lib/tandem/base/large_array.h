/// Arrays of many megabytes.
#pragma once

#include <cstddef>
#include <vector>

namespace tandem {

/// Asks the system for large pages for what lies within these bytes, which nothing has written to yet: memory in pages
/// of 2 MiB is there several times as fast. Without them it takes longer, and that is all.
void prefer_large_pages(void* start, std::size_t bytes);

/// Writes to every page of memory that holds nothing yet, on several threads: the system clears a page when it is first
/// written to, which takes longer than filling it.
void touch_pages(void* start, std::size_t bytes);

/// Reserves memory for so many elements, in large pages if it is much.
template <class T>
void reserve_large(std::vector<T>& array, std::size_t count) {
    if (count <= array.capacity()) return;
    const bool is_new = array.empty();
    array.reserve(count);
    if (is_new) prefer_large_pages(array.data(), count * sizeof(T));
}

/// Makes `count` elements in an empty array, and reserves memory for `capacity`.
template <class T>
void make_large(std::vector<T>& array, std::size_t count, std::size_t capacity) {
    reserve_large(array, capacity);
    touch_pages(array.data(), count * sizeof(T));
    array.resize(count);
}

}  // namespace tandem
