/// Random numbers for tests: a splitmix64 stream per case, so that its number alone reproduces a case.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace tandem::test {

class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15U + 0x1234567U) {}

    std::uint64_t bits() {
        state_ += 0x9E3779B97F4A7C15U;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
        return z ^ (z >> 31);
    }
    /// Integer in [0, n).
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>((bits() >> 32) * n >> 32); }
    bool coin() { return (bits() >> 63) != 0; }
    double uniform(double lower, double upper) {
        return lower + (upper - lower) * (static_cast<double>(bits() >> 11) * 0x1p-53);
    }
    float uniform(float lower, float upper) {
        return static_cast<float>(uniform(static_cast<double>(lower), static_cast<double>(upper)));
    }
    /// Random sign, magnitude 2^u with u uniform in [lower, upper].
    float log_uniform(double lower, double upper) {
        const auto magnitude = static_cast<float>(std::exp2(uniform(lower, upper)));
        return coin() ? magnitude : -magnitude;
    }
    /// Any bit pattern, including NaN, infinity and subnormals.
    float any_float() {
        const auto pattern = static_cast<std::uint32_t>(bits() >> 32);
        float value;
        std::memcpy(&value, &pattern, sizeof value);
        return value;
    }

  private:
    std::uint64_t state_;
};

}  // namespace tandem::test
