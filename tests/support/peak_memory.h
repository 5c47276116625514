/// The memory of a test.
#pragma once

#include <sys/resource.h>

namespace tandem::test {

/// The peak memory of the process, in MiB. Always 0 with AddressSanitizer, which keeps freed memory.
inline long peak_memory() {
#if defined(__SANITIZE_ADDRESS__)
    return 0;
#else
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
#endif
}

}  // namespace tandem::test
