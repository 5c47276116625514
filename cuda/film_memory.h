/// Page-locked host memory for films, which a GPU writes at full speed.
#pragma once

#include <cstddef>

namespace tandem::cuda {

/// A kind of memory for Buffer, as PinnedMemory, but quick to allocate. cudaHostAlloc() took 8 to 14 ms for a film of
/// 21.6 MB on machines with an H200, and held up calls to the driver from other threads. Most of that time is the first
/// access to each page. So here the pages have 2 MiB where the system offers that, several threads touch them, and only
/// then does the driver lock them: 3 to 5 ms.
struct FilmMemory {
    /// Throws EnvironmentError or std::bad_alloc if memory is short or cannot be locked.
    static void* allocate(std::size_t bytes);
    static void release(void* address);
};

}  // namespace tandem::cuda
