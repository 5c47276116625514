// One kernel for all tiers, compiled like strict: the levels have the bits of the host's.
#include "cuda/block_shape.h"
#include "cuda/launch.h"
#include "cuda/level_kernels.h"

namespace tandem::cuda {

namespace {

/// Values that a thread converts.
constexpr std::size_t at_once = 4;

template <class Levels>
__global__ void __launch_bounds__(block_threads)
    levels_kernel(const double* __restrict__ sums, std::size_t values, double samples, double factor, Levels levels,
                  std::uint8_t* __restrict__ to, unsigned long long* __restrict__ nan_values) {
    const std::size_t first = (static_cast<std::size_t>(blockIdx.x) * block_threads + threadIdx.x) * at_once;
    if (first >= values) return;
    const auto level = [&](double sum) -> std::uint32_t {
        const float mean = mean_of_sum(sum, samples);
        if (mean != mean) [[unlikely]]
            atomicAdd(nan_values, 1ULL);
        return levels.at(Levels::place(exposed(mean, factor)));
    };
    if (values - first < at_once) {
        for (std::size_t i = first; i < values; ++i) to[i] = static_cast<std::uint8_t>(level(sums[i]));
        return;
    }
    const auto* pairs = reinterpret_cast<const double2*>(sums + first);
    const double2 a = __ldg(pairs), b = __ldg(pairs + 1);
    *reinterpret_cast<std::uint32_t*>(to + first) = level(a.x) | level(a.y) << 8 | level(b.x) << 16 | level(b.y) << 24;
}

}  // namespace

void find_levels(const Vec3d* sums, std::size_t pixels, const LevelRule& rule, std::byte* to, cudaStream_t stream) {
    const LevelLayout layout{3 * pixels};
    auto* nan_values = reinterpret_cast<unsigned long long*>(to + layout.nan_values());
    check(cudaMemsetAsync(nan_values, 0, sizeof(*nan_values), stream), "clearing a counter");
    const auto start = [&]<class Levels>(const Levels& levels) {
        launch("finding levels", levels_kernel<Levels>, blocks_for(layout.values, block_threads * at_once),
               block_threads, stream, reinterpret_cast<const double*>(sums), layout.values, rule.samples, rule.factor,
               levels, reinterpret_cast<std::uint8_t*>(to), nan_values);
    };
    if (rule.entries == nullptr) return start(LinearLevels{});
    start(SrgbLevels{rule.entries});
}

}  // namespace tandem::cuda
