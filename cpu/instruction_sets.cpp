#include "cpu/instruction_sets.h"

#include <fmt/format.h>

#include <array>

#include "tandem/error/error.h"
#include "tandem/report/processor_level.h"

namespace tandem {

namespace {

bool has_v2() { return x86_64_level() >= 2; }
bool has_v3() { return x86_64_level() >= 3; }
#if defined(TANDEM_ONE_INSTRUCTION_SET)
// without kernels in such a build
bool has_v4() { return false; }
constexpr auto exact_kernels_v4 = exact_kernels_v3;
constexpr auto fast_kernels_v4 = fast_kernels_v3;
#else
bool has_v4() { return x86_64_level() >= 4; }
#endif

constexpr std::array sets = {
    InstructionSet{"x86-64-v2", has_v2, exact_kernels_v2, fast_kernels_v2},
    InstructionSet{"x86-64-v3", has_v3, exact_kernels_v3, fast_kernels_v3},
    InstructionSet{"x86-64-v4", has_v4, exact_kernels_v4, fast_kernels_v4},
};

}  // namespace

std::span<const InstructionSet> instruction_sets() { return sets; }

const InstructionSet& choose_instruction_set(const std::string& name) {
    const InstructionSet* best = nullptr;
    for (const InstructionSet& set : sets) {
        if (name == set.name && !set.is_supported()) {
            throw EnvironmentError(fmt::format("this processor does not have the instruction set {}", name));
        }
        if (set.is_supported() && (name.empty() || name == set.name)) best = &set;
    }
    if (best != nullptr) return *best;
    if (name.empty()) {
        throw EnvironmentError(
            "this processor lacks SSE4.2; the CPU backend needs x86-64-v2, which all have since 2009");
    }
    throw InputError(fmt::format("no instruction set is named '{}'; there are x86-64-v2, x86-64-v3, x86-64-v4", name));
}

}  // namespace tandem
