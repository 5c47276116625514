/// The most threads of parallel loops, for the time of a test.
#pragma once

#include "tandem/base/parallel.h"

namespace tandem::test {

class ThreadLimit {
  public:
    explicit ThreadLimit(int threads) { set_thread_limit(threads); }
    ~ThreadLimit() { set_thread_limit(0); }
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;
};

}  // namespace tandem::test
