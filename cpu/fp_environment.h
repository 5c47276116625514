/// Floating-point control of a thread: round to nearest, subnormals kept.
#pragma once

#include <immintrin.h>

namespace tandem {

/// Puts the thread into the default floating-point state for its lifetime. Embree's commit can leave flush-to-zero
/// on in TBB's worker threads while the main thread still reads "off" (docs/numerics.md), so every task body has one.
class DefaultFpEnvironment {
  public:
    DefaultFpEnvironment() : saved_(_mm_getcsr()) { _mm_setcsr(default_mxcsr); }
    ~DefaultFpEnvironment() { _mm_setcsr(saved_); }
    DefaultFpEnvironment(const DefaultFpEnvironment&) = delete;
    DefaultFpEnvironment& operator=(const DefaultFpEnvironment&) = delete;

  private:
    static constexpr unsigned int default_mxcsr = 0x1F80;  // all exceptions masked, round to nearest even
    unsigned int saved_;
};

}  // namespace tandem
