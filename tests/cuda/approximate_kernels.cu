// Compiled like the tier strict.
#include "cuda/approximate_kernels.h"

#include "cuda/launch.h"
#include "cuda/memory.h"
#include "tandem/math/over_root.h"

namespace tandem::test {

namespace {

constexpr std::uint32_t block = 256;
constexpr std::uint32_t mantissas_of_two_octaves = std::uint32_t{1} << 24;

/// A random number per argument (the finaliser of SplitMix64: Steele, Lea and Flood, OOPSLA 2014).
__device__ std::uint64_t random_bits(std::uint64_t seed, std::uint64_t i, std::uint64_t j) {
    std::uint64_t z = seed * 0xD1342543DE82EF95U + i * 0x9E3779B97F4A7C15U + j * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}

/// Number i of the floats of [1, 4).
__device__ float float_of_two_octaves(std::uint32_t i) { return __uint_as_float(0x3F800000U + i); }

__global__ void __launch_bounds__(block)
    try_over_root(WrongQuotients* __restrict__ wrong, std::uint32_t seed, std::uint32_t tries) {
    const std::uint32_t i = blockIdx.x * block + threadIdx.x;
    const int fourfold = static_cast<int>(random_bits(seed, i, 0) % 40) - 20;
    const float d = ldexpf(float_of_two_octaves(i), 2 * fourfold);
    const float root = __fsqrt_rn(d);
    for (std::uint32_t j = 0; j < tries; ++j) {
        const std::uint64_t bits = random_bits(seed, i, j + 1);
        // up to 40 octaves below the root, the first of them more often
        const int octave = (bits & 1U) != 0 ? 0 : static_cast<int>(bits >> 1U) & 31;
        const float part = __uint_as_float(0x3F000000U + (static_cast<std::uint32_t>(bits >> 32U) & 0x7FFFFFU));
        const float y = j == 0 ? root : copysignf(ldexpf(root * part, -octave), (bits & 64U) != 0 ? 1.0F : -1.0F);
        if (__float_as_uint(over_root(y, d)) != __float_as_uint(__fdiv_rn(y, root))) {
            atomicAdd(&wrong->count, 1ULL);
            wrong->y = y;
            wrong->d = d;
        }
    }
}

/// Positive doubles are in the order of their bits.
__device__ void raise(double* most, double value) {
    atomicMax(reinterpret_cast<unsigned long long*>(most),
              static_cast<unsigned long long>(__double_as_longlong(fabs(value))));
}

/// 1 - a g^2, within 2^-100. That is twice the relative error of g for 1 / sqrt(a).
__device__ double residual_of_root(double a, double g) {
    const double square = g * g;
    return fma(-a, square, 1.0) - a * fma(g, g, -square);
}

__global__ void __launch_bounds__(block) try_rough(RelativeErrors* __restrict__ most, std::uint32_t seed) {
    const std::uint32_t i = blockIdx.x * block + threadIdx.x;
    const std::uint64_t bits = random_bits(seed, i, 0);
    const int octave = static_cast<int>(bits % 124) & ~1;
    const float a = ldexpf(float_of_two_octaves(i), octave - 62);
    raise(&most->rough_reciprocal, 1.0 - static_cast<double>(a) * rough_reciprocal(a));
    raise(&most->rough_inverse_square_root, 0.5 * residual_of_root(a, rough_inverse_square_root(a)));
    const double mantissa = 1.0 + static_cast<double>(random_bits(seed, i, 1) >> 12U) * 0x1p-52;
    const double wide = ldexp(mantissa, static_cast<int>((bits >> 32U) % 1000) - 500);
    raise(&most->close_reciprocal, fma(-wide, close_reciprocal(wide), 1.0));
    raise(&most->close_inverse_square_root, 0.5 * residual_of_root(wide, close_inverse_square_root(wide)));
}

/// What a kernel leaves in a Result after all its threads.
template <class Result, class... Arguments>
Result result_of(void (*kernel)(Result*, Arguments...), Arguments... arguments) {
    Result result;
    cuda::Buffer<cuda::DeviceMemory> memory;
    memory.reserve(sizeof(Result));
    auto* const there = reinterpret_cast<Result*>(memory.data());
    cuda::check(cudaMemcpy(there, &result, sizeof(Result), cudaMemcpyHostToDevice), "uploading");
    cuda::launch("trying functions", kernel, dim3(mantissas_of_two_octaves / block), block, nullptr, there,
                 arguments...);
    cuda::check(cudaMemcpy(&result, there, sizeof(Result), cudaMemcpyDeviceToHost), "downloading");
    return result;
}

}  // namespace

WrongQuotients wrong_quotients(std::uint32_t seed, std::uint32_t tries) {
    return result_of(try_over_root, seed, tries);
}

RelativeErrors relative_errors(std::uint32_t seed) { return result_of(try_rough, seed); }

}  // namespace tandem::test
