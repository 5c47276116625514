#include "cpu/instruction_sets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "tandem/base/error.h"
#include "tandem/base/processor_level.h"
#include "tandem/math/lane_registers.h"

namespace tandem {

namespace {

template <class Isa, Tier tier>
constexpr TierKernels tier_kernels() {
    using Kernels = CpuKernels<Isa, tier>;
    TierKernels kernels = {{},
                           Kernels::trace,
                           Kernels::intersect,
                           Kernels::occluded,
                           nullptr,
                           nullptr,
                           Isa::bytes / static_cast<int>(sizeof(float))};
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

template <class Isa, int level>
constexpr InstructionSet instruction_set = {Isa::name, [] { return x86_64_level() >= level; }, all_tiers<Isa>.data(),
                                            all_first_hits<Isa>.data()};

constexpr std::array sets = {
#if defined(TANDEM_HAS_ISA_2)
    instruction_set<Sse4, 2>,
#endif
#if defined(TANDEM_HAS_ISA_3)
    instruction_set<Avx2, 3>,
#endif
#if defined(TANDEM_HAS_ISA_4)
    instruction_set<Avx512, 4>,
#endif
};

}  // namespace

std::span<const InstructionSet> instruction_sets() { return sets; }

namespace {

std::vector<std::string> compiled_instruction_sets() {
    std::vector<std::string> names;
    names.reserve(sets.size());
    for (const InstructionSet& set : sets) names.emplace_back(set.name);
    return names;
}

}  // namespace

const InstructionSet& choose_instruction_set(const std::string& name) {
    const InstructionSet* best = nullptr;
    bool is_compiled = name.empty();
    for (const InstructionSet& set : sets) {
        if (!name.empty() && name != set.name) continue;
        is_compiled = true;
        if (set.is_supported()) best = &set;
    }
    if (best != nullptr) return *best;
    if (!is_compiled) {
        throw InputError(fmt::format("this build has no kernels for the instruction set '{}', but for {}", name,
                                     fmt::join(compiled_instruction_sets(), ", ")));
    }
    throw EnvironmentError(name.empty() ? why_no_instruction_set()
                                        : fmt::format("this processor lacks the instruction set {}", name));
}

std::string why_no_instruction_set() {
    if (sets.front().is_supported()) return "";
    if (sets.front().name == std::string_view(Sse4::name)) {
        return "this processor lacks SSE4.2; the CPU backend needs x86-64-v2 (processors since about 2009)";
    }
    return fmt::format(
        "this build has kernels for {} and newer processors; build with -DTANDEM_INSTRUCTION_SETS=native",
        sets.front().name);
}

}  // namespace tandem
