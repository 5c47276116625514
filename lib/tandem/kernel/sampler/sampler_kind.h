/// Which sampler a job has (samplers.def), and what it needs of the job.
#pragma once

#include "tandem/kernel/sampler/hash.h"

namespace tandem {

enum class Sampler : std::uint32_t {
#define TANDEM_SAMPLER(name, help) name,
#include "tandem/kernel/sampler/samplers.def"
#undef TANDEM_SAMPLER
};

/// The sampler of a job, for kernels.
struct JobSampler {
    Sampler kind = Sampler::random;
    std::uint32_t key = 0;  ///< a hash of seed and frame; random does not need it
};

[[nodiscard]] TANDEM_HD_INLINE JobSampler make_job_sampler(Sampler kind, std::uint64_t seed, std::uint32_t frame) {
    std::uint32_t key = hashed(hash_step + static_cast<std::uint32_t>(seed));
    key = hashed(key + static_cast<std::uint32_t>(seed >> 32));
    return {kind, hashed(key + frame)};
}

/// The value of LinkedFacts::sampler in a kernel for every sampler.
inline constexpr std::uint32_t any_sampler = ~0U;

/// Whether the sampler is a constant in this kernel (cuda/linked_facts.h).
TANDEM_HD_INLINE bool is_sampler_linked() {
#if defined(TANDEM_LINKED_SAMPLER) && TANDEM_ON_DEVICE
    return TANDEM_LINKED_SAMPLER != any_sampler;
#else
    return false;
#endif
}

/// The sampler of a job: the constant, if there is one.
TANDEM_HD_INLINE Sampler sampler_of(const JobSampler& job) {
#if defined(TANDEM_LINKED_SAMPLER) && TANDEM_ON_DEVICE
    if (TANDEM_LINKED_SAMPLER != any_sampler) return static_cast<Sampler>(TANDEM_LINKED_SAMPLER);
#endif
    return job.kind;
}

}  // namespace tandem
