/// The memory of a test.
#pragma once

#include <sys/resource.h>

namespace tandem::test {

/// The peak memory of the process, in MiB.
inline long peak_memory() {
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}

}  // namespace tandem::test
