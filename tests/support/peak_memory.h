/// How much memory a test took.
#pragma once

#include <sys/resource.h>

namespace tandem::test {

/// The most memory that the process has had, in MiB.
inline long peak_memory() {
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}

}  // namespace tandem::test
