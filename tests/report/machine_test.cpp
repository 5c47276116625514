#include "tandem/report/machine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

namespace tandem {
namespace {

TEST(Machine, ReadsTheFirstValueOfAKey) {
    std::istringstream text("processor\t: 0\nmodel name\t: AMD EPYC 9654 : Turbo\nmodel name\t: other\n");
    EXPECT_EQ(value_of(text, "model name"), "AMD EPYC 9654 : Turbo");
    std::istringstream release("NAME=\"Debian\"\nPRETTY_NAME=\"Debian GNU/Linux 13\"\n");
    EXPECT_EQ(value_of(release, "PRETTY_NAME"), "Debian GNU/Linux 13");
    std::istringstream nothing("no separator here\n");
    EXPECT_EQ(value_of(nothing, "model name"), "");
}

TEST(Machine, ReadsTheQuotaOfAContainer) {
    EXPECT_EQ(parse_core_quota("400000 100000\n"), 4);
    EXPECT_EQ(parse_core_quota("150000 100000"), 1.5);
    EXPECT_EQ(parse_core_quota("max 100000\n"), std::nullopt);
    EXPECT_EQ(parse_core_quota(""), std::nullopt);
}

TEST(Machine, DescribesTheOneItRunsOn) {
    const Machine machine = describe_machine();
    EXPECT_GE(machine.cores, 1);
    EXPECT_GT(machine.memory_bytes, std::uint64_t{1} << 27);
    EXPECT_FALSE(machine.compiler.empty());
    EXPECT_NE(machine.flags.find("-ffp-contract=off"), std::string::npos) << machine.flags;
    EXPECT_EQ(machine.flags.find('<'), std::string::npos) << "generator expressions are left in: " << machine.flags;
    EXPECT_FALSE(machine.commit.empty());
}

TEST(Machine, InstructionSetsComeInOrderWithoutGaps) {
    const std::vector<std::string> all = {"x86-64-v2", "x86-64-v3", "x86-64-v4"};
    const std::vector<std::string> here = supported_instruction_sets();
    ASSERT_LE(here.size(), all.size());
    EXPECT_TRUE(std::equal(here.begin(), here.end(), all.begin()));
    // the kernel's own list of what the processor has
    std::ifstream processors("/proc/cpuinfo");
    const std::string flags = value_of(processors, "flags");
    for (const auto& [level, flag] : {std::pair{1U, "sse4_2"}, {2U, "avx2"}, {2U, "fma"}, {3U, "avx512vl"}}) {
        EXPECT_TRUE(here.size() < level || flags.find(flag) != std::string::npos) << flag << " in " << flags;
    }
}

TEST(Machine, FactsHoldWhatTheCallerAdds) {
    Machine machine = describe_machine();
    machine.core_quota = 2.5;
    machine.more.emplace_back("cuda", "NVIDIA H200");
    const auto list = facts(machine);
    const auto has = [&](const std::string& name, const std::string& part) {
        return std::any_of(list.begin(), list.end(), [&](const auto& fact) {
            return fact.first == name && fact.second.find(part) != std::string::npos;
        });
    };
    EXPECT_TRUE(has("cuda", "NVIDIA H200"));
    EXPECT_TRUE(has("Cores", "limited to the time of 2.5"));
}

}  // namespace
}  // namespace tandem
