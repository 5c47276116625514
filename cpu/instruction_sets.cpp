#include "cpu/instruction_sets.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/base/processor_level.h"
#include "tandem/math/lane_registers.h"

namespace tandem {

namespace {

template <class Isa, Tier tier>
constexpr TierKernels tier_kernels() {
    using Kernels = CpuKernels<Isa, tier>;
    TierKernels kernels = {{}, Kernels::trace, Kernels::intersect, Kernels::occluded, nullptr, nullptr};
    [&]<std::size_t... variant>(std::index_sequence<variant...>) {
        ((kernels.render_tile[variant] = Kernels::template render_tile<variant>), ...);
    }
    (std::make_index_sequence<variant_count>());
    if constexpr (tier == Tier::fast) {
        kernels.filter_nearest = Kernels::filter_nearest;
        kernels.filter_any = Kernels::filter_any;
    }
    return kernels;
}

template <class Isa>
constexpr std::array all_tiers = {
#define TANDEM_TIER(name, promise) tier_kernels<Isa, Tier::name>(),
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
};

template <class Isa>
constexpr std::array<FirstHitKernel*, all_tiers<Isa>.size()> all_first_hits = {
#define TANDEM_TIER(name, promise) write_first_hits<Isa, Tier::name>,
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
};

bool has_v2() { return x86_64_level() >= 2; }
bool has_v3() { return x86_64_level() >= 3; }
#if defined(TANDEM_ONE_INSTRUCTION_SET)
bool has_v4() { return false; }  // such a build has no kernels for it
using SetV4 = Avx2;
#else
bool has_v4() { return x86_64_level() >= 4; }
using SetV4 = Avx512;
#endif

constexpr std::array sets = {
    InstructionSet{"x86-64-v2", has_v2, all_tiers<Sse4>.data(), all_first_hits<Sse4>.data()},
    InstructionSet{"x86-64-v3", has_v3, all_tiers<Avx2>.data(), all_first_hits<Avx2>.data()},
    InstructionSet{"x86-64-v4", has_v4, all_tiers<SetV4>.data(), all_first_hits<SetV4>.data()},
};

}  // namespace

std::span<const InstructionSet> instruction_sets() { return sets; }

const InstructionSet& choose_instruction_set(const std::string& name) {
    const InstructionSet* best = nullptr;
    for (const InstructionSet& set : sets) {
        if (name == set.name && !set.is_supported()) {
            throw EnvironmentError(fmt::format("this processor lacks the instruction set {}", name));
        }
        if (set.is_supported() && (name.empty() || name == set.name)) best = &set;
    }
    if (best != nullptr) return *best;
    if (name.empty()) {
        throw EnvironmentError(
            "this processor lacks SSE4.2; the CPU backend needs x86-64-v2 (processors since about 2009)");
    }
    throw InputError(fmt::format(
        "there is no instruction set '{}'; the instruction sets are x86-64-v2, x86-64-v3, x86-64-v4", name));
}

}  // namespace tandem
