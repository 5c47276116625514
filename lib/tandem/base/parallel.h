/// Loops on several threads. Their results must not depend on the number of threads: the parts of a loop are the same
/// for any number, and a loop that sums something up keeps one sum for each part.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace tandem {

/// The most threads that a loop takes, in the whole process; 0 means one per core, as at the start.
void set_thread_limit(int threads);
[[nodiscard]] int thread_limit();

/// A part of a loop over numbers: those from `begin` up to, but not including, `end`.
struct Chunk {
    std::size_t number;
    std::size_t begin, end;
};

[[nodiscard]] constexpr std::size_t chunk_count(std::size_t count, std::size_t size) {
    return (count + size - 1) / size;
}

/// Calls work(i) for every i below `count`, on several threads, and returns when all are done. They have the
/// floating-point environment of the caller. If calls throw, the exception of the lowest i is passed on: that of a loop
/// on one thread. Numbers above it may be left out. A nested loop runs on the thread that calls it.
void run_parallel(std::size_t count, const std::function<void(std::size_t)>& work);

/// Calls body(chunk) for every part of the numbers below `count`; `size` is the length of all parts but the last. A
/// loop of one part runs on the caller's thread.
template <class Body>
void for_each_chunk(std::size_t count, std::size_t size, const Body& body) {
    run_parallel(chunk_count(count, size), [&](std::size_t number) {
        const std::size_t begin = number * size;
        body(Chunk{number, begin, std::min(begin + size, count)});
    });
}

}  // namespace tandem
