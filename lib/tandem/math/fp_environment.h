/// The floating-point environment of a thread: round to nearest, keep subnormals. Host only.
#pragma once

#include <immintrin.h>

#include <cfenv>

namespace tandem {

/// Sets the default floating-point environment of the thread, and restores the previous one at the end of its lifetime.
/// Every public function that computes has one, since the caller may have set another rounding mode or flush-to-zero.
/// Every task has one too, because Embree's commit can leave flush-to-zero on in TBB's worker threads
/// (docs/numerics.md).
class DefaultFpEnvironment {
  public:
    DefaultFpEnvironment() : mxcsr_(_mm_getcsr()) {
        std::fegetenv(&environment_);  // for long double, which the oracle uses
        std::fesetenv(FE_DFL_ENV);
        _mm_setcsr(default_mxcsr);
    }
    ~DefaultFpEnvironment() {
        std::fesetenv(&environment_);
        _mm_setcsr(mxcsr_);
    }
    DefaultFpEnvironment(const DefaultFpEnvironment&) = delete;
    DefaultFpEnvironment& operator=(const DefaultFpEnvironment&) = delete;

  private:
    static constexpr unsigned int default_mxcsr = 0x1F80;  // all exceptions masked, round to nearest even
    unsigned int mxcsr_;
    std::fenv_t environment_{};
};

}  // namespace tandem
